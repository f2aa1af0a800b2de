// Scans and images of a live drive, from their arrival to the frames.
#pragma once

#include <deque>
#include <optional>
#include <vector>

#include "fovea/drive/live/match_queue.h"
#include "fovea/drive/live/raw_frame.h"

namespace fovea {

/// Where the data of a sensor lie that belong to a scan.
struct ExpectedPlace {
  TimeNs delay = 0;      ///< from the stamp of the scan
  TimeNs tolerance = 0;  ///< from there
};

/// Bounds of the memory.
struct FrameQueueLimits {
  std::size_t scans = 8;               ///< of a LiDAR
  TimeNs images = 4 * kNsPerSecond;    ///< later than the last scan
  std::size_t image_count = 1024;      ///< of a camera
  std::size_t image_bytes = 64 << 20;  ///< of a camera
};

/// Not for several threads.
class FrameQueue {
 public:
  using ScanPointer = std::shared_ptr<const LiveScan>;
  using ImagePointer = std::shared_ptr<const LiveImage>;
  struct PendingScan {
    ScanPointer scan;
    WallClock::time_point arrival;
  };

  /// Sensors by their place in drive.toml.
  FrameQueue(std::size_t further_lidars, std::size_t cameras, FrameQueueLimits limits);

  /// What came of it.
  enum class Added {
    kTaken,
    kOutOfOrder,  ///< not later than the one before: dropped
    kLate,        ///< its scan is a frame already: dropped
  };
  /// A full queue drops the oldest.
  Added add_scan(ScanPointer scan, WallClock::time_point now);
  Added add_further_scan(std::size_t lidar, ScanPointer scan);
  Added add_image(std::size_t camera, ImagePointer image);

  bool has_room_for_scan() const { return scans_.size() < limits_.scans; }
  bool has_room_for_further_scan(std::size_t lidar) const;
  bool has_room_for_image(std::size_t camera) const;

  /// From the beginning on, only these sensors count: places in drive.toml.
  struct Sensors {
    std::vector<std::size_t> further_lidars, cameras;
    std::vector<ExpectedPlace> further_places, image_places;
    TimeNs period = 0;  ///< of the scans
  };
  void use(Sensors sensors, std::size_t scan_limit);

  /// Whether the sensors in use have sent what belongs to the oldest scan.
  bool is_complete() const;
  /// Removes the oldest scan, with the images and further scans that belong to it.
  RawFrame take();

  const std::deque<PendingScan>& scans() const { return scans_; }
  const MatchQueue<LiveScan>& further_scans(std::size_t lidar) const { return further_[lidar]; }
  const MatchQueue<LiveImage>& images(std::size_t camera) const { return images_[camera]; }
  const SensorStamps& scan_stamps() const { return scan_stamps_; }
  std::size_t scans_dropped() const { return scans_dropped_; }

 private:
  /// Stamp that the scan after the oldest one has, or likely has.
  TimeNs next_stamp() const;
  template <class Item>
  Added add(MatchQueue<Item>& queue, std::shared_ptr<const Item> item,
            const std::optional<ExpectedPlace>& place);
  void trim_images(std::size_t camera);
  /// Drops an image that no scan that waits can take; false if there is none.
  bool drop_unneeded(std::size_t camera);

  FrameQueueLimits limits_;
  std::deque<PendingScan> scans_;
  SensorStamps scan_stamps_;
  std::vector<MatchQueue<LiveScan>> further_;
  std::vector<MatchQueue<LiveImage>> images_;
  std::optional<Sensors> sensors_;
  // By place in drive.toml; absent: not in use.
  std::vector<std::optional<ExpectedPlace>> further_places_, image_places_;
  std::optional<TimeNs> last_taken_;  // stamp of a scan
  std::size_t scans_dropped_ = 0;
};

}  // namespace fovea
