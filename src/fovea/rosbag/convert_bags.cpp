#include "fovea/rosbag/convert_bags.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "fovea/base/errors.h"
#include "fovea/recording/generic_drive_writer.h"
#include "fovea/rosbag/bag.h"
#include "fovea/rosbag/camera_topics.h"
#include "fovea/rosbag/navigation_topics.h"
#include "fovea/rosbag/pixels.h"
#include "fovea/rosbag/point_cloud_rows.h"
#include "fovea/rosbag/survey.h"

namespace fovea {
namespace {

constexpr std::size_t kMaxNumber = 999'999;  // that files of a drive have

struct ConversionPlan {
  std::string lidar;  // topic
  std::vector<PlannedCamera> cameras;
  RecordedDrive drive;
  std::vector<std::string> notes;
};

std::string lidar_topic(const BagSurvey& survey, const std::string& wanted) {
  std::vector<std::string> topics;
  for (const auto& [name, cloud] : survey.clouds) {
    if (!cloud.stamps.empty()) topics.push_back(name);
  }
  if (!wanted.empty()) {
    if (std::find(topics.begin(), topics.end(), wanted) != topics.end()) return wanted;
    throw InputError("there are no point clouds of this topic", wanted, "see 'ros2 bag info'");
  }
  if (topics.size() == 1) return topics.front();
  if (topics.size() > 1) {
    throw InputError(fmt::format("there are {} topics of point clouds", topics.size()),
                     fmt::format("{}", fmt::join(topics, ", ")), "choose by --lidar TOPIC");
  }
  for (const auto& [name, unusable] : survey.unusable) {
    const auto topic = survey.topics.find(name);
    if (topic == survey.topics.end() || topic->second.type != ros::kPointCloud) continue;
    throw InputError(fmt::format("no point cloud can be used ({})", unusable.first_problem), name,
                     "restore it from a copy, or see docs/drives.md for what is read");
  }
  for (const auto& [name, topic] : survey.topics) {
    if (topic.encoding == kCdrEncoding) continue;
    throw InputError(fmt::format("messages are of encoding '{:.40}'", topic.encoding), name,
                     "give a recording of ROS 2 (encoding 'cdr')");
  }
  throw InputError("the recording has no point clouds", std::string(ros::kPointCloud),
                   "record the LiDAR's topic, not its packets");
}

ConversionPlan plan_conversion(const BagSurvey& survey, const ConvertOptions& options) {
  ConversionPlan plan;
  plan.lidar = lidar_topic(survey, options.lidar);
  const SensorTopic& lidar = survey.clouds.at(plan.lidar);
  plan.drive.sweep_compensated = options.sweep_compensated;
  plan.notes.push_back(
      fmt::format("scans: {} of {}, {}", lidar.stamps.size(), plan.lidar,
                  lidar.scan_format.time_unit ? "points have times" : "points have no times"));
  plan.cameras = plan_cameras(survey, options, lidar.frame, plan.notes);
  for (const PlannedCamera& planned : plan.cameras) {
    plan.notes.push_back(fmt::format("camera {}: '{}', {} images of {}", planned.camera.index,
                                     planned.camera.name,
                                     survey.images.at(planned.topic).stamps.size(), planned.topic));
    plan.drive.cameras.push_back(planned.camera);
  }
  plan_navigation(survey, options, lidar.frame, plan.drive, plan.notes);
  return plan;
}

/// Writes scans and images as they come.
class Recorder : public BagSink {
 public:
  Recorder(const BagSurvey& survey, const ConversionPlan& plan, GenericDriveWriter& writer,
           const std::function<bool(int, int)>& progress)
      : lidar_(plan.lidar, survey.clouds.at(plan.lidar)), writer_(writer), progress_(progress) {
    total_ = lidar_.size();
    for (const PlannedCamera& planned : plan.cameras) {
      Numbered& camera =
          cameras_.try_emplace(planned.topic, planned.topic, survey.images.at(planned.topic))
              .first->second;
      camera.name = planned.camera.name;
      total_ += camera.size();
    }
  }

  bool wants(const BagTopic& topic) override {
    return (topic.name == lidar_.topic && topic.type == ros::kPointCloud) ||
           (cameras_.contains(topic.name) &&
            (topic.type == ros::kImage || topic.type == ros::kCompressedImage));
  }

  bool add(const BagTopic& topic, std::string_view bytes) override {
    Numbered& sensor = topic.name == lidar_.topic ? lidar_ : cameras_.at(topic.name);
    try {
      CdrReader message(bytes, topic.name);
      if (topic.type == ros::kPointCloud) {
        write_scan(ros::read_point_cloud(message));
      } else if (topic.type == ros::kImage) {
        const ros::ImageMessage image = ros::read_image(message);
        if (const auto number = sensor.take(image.header.stamp)) {
          writer_.write_image(sensor.name, *number, image.header.stamp,
                              image_of(image, topic.name));
          ++sensor.written;
        }
      } else {
        write_compressed(ros::read_compressed_image(message), sensor);
      }
    } catch (const InputError& error) {
      sensor.unusable.add(error.problem());
    }
    done_ = std::min(done_ + 1, total_);
    stopped_ = !progress_(int(done_), int(total_));
    return !stopped_;
  }

  bool stopped() const { return stopped_; }

  /// InputError if nothing could be used of a sensor.
  ConvertFigures finish(RecordedDrive& drive) {
    ConvertFigures figures;
    figures.scans = lidar_.written;
    figures.cameras = cameras_.size();
    account_for(lidar_, figures);
    for (const auto& [topic, camera] : cameras_) {
      figures.images += camera.written;
      account_for(camera, figures);
    }
    if (dropped_ > 0) {
      figures.notes.push_back(fmt::format(
          "{} points are left out: not finite, at the origin, beyond 1 km or 1 s off the stamp",
          dropped_));
    }
    drive.intensity_max = intensity_ <= 1 ? 1 : intensity_ <= 255 ? 255 : 65535;
    return figures;
  }

 private:
  /// A sensor's messages, numbered by their stamps.
  struct Numbered {
    Numbered(const std::string& topic_name, const SensorTopic& sensor)
        : topic(topic_name),
          stamps(sensor.stamps),
          taken(stamps.size()),
          format(sensor.scan_format) {}

    std::size_t size() const { return stamps.size(); }
    /// Empty for a stamp that was there before, or has come since.
    std::optional<int> take(TimeNs stamp) {
      const auto found = std::lower_bound(stamps.begin(), stamps.end(), stamp);
      const auto number = std::size_t(found - stamps.begin());
      if (found == stamps.end() || *found != stamp || taken[number]) return std::nullopt;
      taken[number] = true;
      return int(number);
    }

    std::string topic, name;
    std::vector<TimeNs> stamps;
    std::vector<bool> taken;
    ScanFormat format;
    std::size_t written = 0;
    UnusableMessages unusable;
  };

  void write_scan(const ros::PointCloud2& cloud) {
    const TimeNs stamp = cloud.header.stamp;
    const auto number = lidar_.take(stamp);
    if (!number) return;
    ScanRows rows(lidar_.format, stamp);
    read_cloud_rows(cloud, lidar_.topic, rows);
    const LidarScan scan = rows.take(lidar_.topic);
    dropped_ += scan.dropped;
    for (const float intensity : scan.points.intensity) {
      intensity_ = std::max(intensity_, intensity);
    }
    writer_.write_scan(*number, stamp, scan.points);
    ++lidar_.written;
  }

  void write_compressed(const ros::CompressedImage& image, Numbered& camera) {
    const bool png = image.data.starts_with("\x89PNG\r\n\x1a\n");
    if (!png && !image.data.starts_with("\xff\xd8\xff")) {
      throw InputError(fmt::format("images of format '{:.40}' are not read", image.format),
                       camera.topic, "record PNG or JPEG");
    }
    const TimeNs stamp = image.header.stamp;
    const auto number = camera.take(stamp);
    if (!number) return;
    writer_.write_encoded_image(camera.name, *number, stamp, image.data, png ? ".png" : ".jpg");
    ++camera.written;
  }

  static void account_for(const Numbered& sensor, ConvertFigures& figures) {
    const UnusableMessages& unusable = sensor.unusable;
    if (sensor.written == 0) {
      throw InputError(fmt::format("none of the messages can be used ({})", unusable.first_problem),
                       sensor.topic,
                       "restore it from a copy, or see docs/drives.md for what is read");
    }
    if (unusable.count > 0) {
      figures.notes.push_back(fmt::format("{} messages of {} cannot be used (the first: {})",
                                          unusable.count, sensor.topic, unusable.first_problem));
    }
  }

  Numbered lidar_;
  std::map<std::string, Numbered> cameras_;  // by topic
  GenericDriveWriter& writer_;
  const std::function<bool(int, int)>& progress_;
  std::size_t done_ = 0, total_ = 0, dropped_ = 0;
  float intensity_ = 0;
  bool stopped_ = false;
};

/// Calls what knows of topics only: its errors say which recording they are in.
template <class Step>
auto naming(const std::vector<std::filesystem::path>& bags, Step&& step) {
  try {
    return step();
  } catch (const InputError& error) {
    throw InputError(error.problem(),
                     fmt::format("{} in {}{}", error.where(), bags.front().string(),
                                 bags.size() > 1 ? " and others" : ""),
                     error.remedy());
  }
}

}  // namespace

ConvertFigures convert_bags(const std::vector<std::filesystem::path>& bags,
                            const std::filesystem::path& output, bool force,
                            const ConvertOptions& options,
                            const std::function<bool(int, int)>& progress) {
  std::vector<std::filesystem::path> files;
  for (const std::filesystem::path& bag : bags) {
    const auto parts = bag_files(bag);
    files.insert(files.end(), parts.begin(), parts.end());
  }
  GenericDriveWriter writer(output, force);
  const BagSurvey survey = survey_bags(files);
  ConversionPlan plan = naming(bags, [&] { return plan_conversion(survey, options); });
  Recorder recorder(survey, plan, writer, progress);
  for (const std::filesystem::path& file : files) {
    if (!recorder.stopped()) read_bag_file(file, recorder);
  }
  ConvertFigures figures;
  if (recorder.stopped()) {
    figures.stopped = true;
    return figures;
  }
  figures = naming(bags, [&] { return recorder.finish(plan.drive); });
  figures.notes.insert(figures.notes.begin(), plan.notes.begin(), plan.notes.end());
  for (const auto& [topic, unusable] : survey.unusable) {
    figures.notes.push_back(fmt::format("{} messages of {} cannot be used (the first: {})",
                                        unusable.count, topic, unusable.first_problem));
  }
  writer.finish(plan.drive);
  return figures;
}

}  // namespace fovea
