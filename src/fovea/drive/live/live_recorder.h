// Writes the frames of a live drive as a drive (docs/drives.md).
#pragma once

#include <filesystem>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "fovea/core/bounded_queue.h"
#include "fovea/drive/drive_description.h"
#include "fovea/drive/live/raw_frame.h"
#include "fovea/drive/writers/generic_drive_writer.h"

namespace fovea {

/// Motion as it came. Bounded: a full list takes no further record.
struct RawMotion {
  std::vector<RecordedPose> poses;
  std::vector<RecordedPosition> positions;
  std::vector<RecordedInertia> inertia;
  std::vector<WheelSpeed> wheels;

  void add(const RecordedPose& pose) { add_to(poses, pose); }
  void add(const RecordedPosition& position) { add_to(positions, position); }
  void add(const RecordedInertia& record) { add_to(inertia, record); }
  void add(const WheelSpeed& speed) { add_to(wheels, speed); }

 private:
  template <class Record>
  static void add_to(std::vector<Record>& records, const Record& record) {
    constexpr std::size_t kMost = 1 << 16;
    if (records.size() < kMost) records.push_back(record);
  }
};

/// One thread calls it, another one writes. The first OutputError ends the recording; the frames
/// before it stay.
class LiveRecorder {
 public:
  /// @param drive_toml  is written as it is: its folders must be the default ones
  /// @throws OutputError  as GenericDriveWriter
  /// @throws ConfigError  for other folders, and for files that drive.toml names and that cannot be
  ///                      part of the recording
  LiveRecorder(const std::filesystem::path& root, std::string drive_toml,
               const DriveDescription& description);
  ~LiveRecorder();
  LiveRecorder(const LiveRecorder&) = delete;
  LiveRecorder& operator=(const LiveRecorder&) = delete;

  /// Waits if the writer is behind.
  void add(RawFrame frame, RawMotion motion);
  /// States the delay of a camera in drive.toml, since a median of the recording may differ.
  void set_stamp_delay(const std::string& camera, double delay);
  /// Writes what has come, and gives the drive its name. OutputError if that could not be written,
  /// or if the drive ends early since a frame could not.
  void finish(RawMotion motion);

 private:
  struct Item {
    std::optional<RawFrame> frame;
    RawMotion motion;
  };
  void copy_masks() const;
  void run();
  void write(const Item& item);
  void write_scan(int number, const std::string& lidar, const LiveScan& scan);
  void write_image(int number, const LiveImage& image);
  void write_motion(const RawMotion& motion);

  std::string drive_toml_;
  DriveDescription description_;
  GenericDriveWriter writer_;
  std::size_t frames_ = 0;  // that were written
  BoundedQueue<Item> queue_;
  std::promise<void> written_;  // by the writer thread
  std::future<void> result_ = written_.get_future();
  std::jthread thread_;
};

}  // namespace fovea
