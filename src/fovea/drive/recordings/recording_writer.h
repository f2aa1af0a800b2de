// The second pass over recordings: their scans and images become files.
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "fovea/drive/recordings/conversion_plan.h"
#include "fovea/drive/recordings/convert_bags.h"
#include "fovea/drive/recordings/scan_message.h"
#include "fovea/drive/scans/dropped_points.h"
#include "fovea/drive/scans/intensity_scale.h"
#include "fovea/drive/scans/scan_format.h"
#include "fovea/drive/writers/generic_drive_writer.h"

namespace fovea {

/// Writes scans and images as they come, numbered by their stamps.
class RecordingWriter : public BagSink {
 public:
  /// @param allow_dropped  whether many points may be left out
  /// @param progress  called with messages done and in all
  RecordingWriter(const BagIndex& index, const ConversionPlan& plan, GenericDriveWriter& writer,
                  bool allow_dropped, const std::function<void(int, int)>& progress);

  bool is_requested(const BagTopic& topic) override;
  void add(const BagTopic& topic, std::string_view bytes) override;

  /// Counts what was written and left out; sets the scales of the intensities. InputError if
  /// nothing could be used of a sensor, or, unless allowed, if too many points were left out.
  void finish(RecordedDrive& drive, ConvertFigures& figures) const;

 private:
  /// A sensor's messages.
  struct Numbered {
    Numbered(const std::string& topic_name, const SensorTopic& sensor);

    /// Number of a message; empty for what the index has found unusable.
    std::optional<int> take(const ros::Header& header);

    std::string topic, name, frame;
    std::vector<TimeNs> stamps;
    std::vector<bool> taken;
    std::size_t written = 0;
    UnusableMessages unusable;
  };

  struct LidarMessages {
    Numbered messages;  ///< without a name if it is the only one
    ScanFormat format;
    std::size_t kept = 0;  ///< points
    DroppedPoints dropped = {};
    IntensityScale scale = {};
  };

  template <class Write>
  static void use(Numbered& sensor, const ros::Header& header, Write&& write);
  void write_scan(const ScanMessage& message, LidarMessages& lidar);
  void write_plain(const ros::ImageMessage& image, Numbered& camera);
  void write_compressed(const ros::CompressedImage& image, Numbered& camera);
  static void account_for(const Numbered& sensor, ConvertFigures& figures);

  std::map<std::string, LidarMessages> lidars_;  // by topic
  bool allow_dropped_;
  std::map<std::string, Numbered> cameras_;  // by topic
  GenericDriveWriter& writer_;
  const std::function<void(int, int)>& progress_;
  std::size_t done_ = 0, total_ = 0;
};

}  // namespace fovea
