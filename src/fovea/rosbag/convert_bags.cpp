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

constexpr std::size_t kMaxNumber = 1'000'000;  // of files: they have six digits

struct ConversionPlan {
  std::string lidar;  // topic
  std::vector<PlannedCamera> cameras;
  RecordedDrive drive;
  std::vector<std::string> notes;
};

[[noreturn]] void throw_no_clouds(const BagSurvey& survey) {
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

std::string lidar_topic(const BagSurvey& survey, const std::string& wanted) {
  if (survey.clouds.empty()) throw_no_clouds(survey);
  if (!wanted.empty()) {
    if (survey.clouds.contains(wanted)) return wanted;
    throw InputError("there are no point clouds of this topic that can be read", wanted,
                     "see 'ros2 bag info'");
  }
  if (survey.clouds.size() == 1) return survey.clouds.begin()->first;
  std::vector<std::string> topics;
  for (const auto& [name, cloud] : survey.clouds) topics.push_back(name);
  throw InputError(fmt::format("there are {} topics of point clouds", topics.size()),
                   fmt::format("{}", fmt::join(topics, ", ")), "choose by --lidar TOPIC");
}

/// InputError if the two have no time in common: they were stamped by different clocks.
void check_clocks(const std::string& lidar, const std::vector<TimeNs>& scans,
                  const std::string& other, TimeNs first, TimeNs last) {
  if (first <= scans.back() + kNsPerSecond && last >= scans.front() - kNsPerSecond) return;
  throw InputError(fmt::format("stamps have no time in common with those of {}", lidar), other,
                   "have all sensors use one clock");
}

void check_times(const BagSurvey& survey, const ConversionPlan& plan) {
  const std::vector<TimeNs>& scans = survey.clouds.at(plan.lidar).stamps;
  const auto check = [&](const std::string& other, TimeNs first, TimeNs last) {
    check_clocks(plan.lidar, scans, other, first, last);
  };
  for (const PlannedCamera& camera : plan.cameras) {
    const std::vector<TimeNs>& stamps = survey.images.at(camera.topic).stamps;
    check(camera.topic, stamps.front(), stamps.back());
    if (stamps.size() > kMaxNumber) {
      throw InputError(fmt::format("there are {} images", stamps.size()), camera.topic,
                       "split the recording: a drive has a million at most");
    }
  }
  const RecordedDrive& drive = plan.drive;
  if (!drive.poses.empty()) check("the poses", drive.poses.front().time, drive.poses.back().time);
  if (!drive.positions.empty()) {
    check("the positions", drive.positions.front().time, drive.positions.back().time);
  }
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
  check_times(survey, plan);
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
        write_plain(ros::read_image(message), sensor);
      } else {
        write_compressed(ros::read_compressed_image(message), sensor);
      }
    } catch (const InputError&) {
      // The survey has counted it.
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
    // One in a thousand may be a mistake.
    drive.intensity_max = above_255_ * 1000 > points_ ? 65535 : above_1_ * 1000 > points_ ? 255 : 1;
    return figures;
  }

 private:
  /// A sensor's messages, numbered by their stamps.
  struct Numbered {
    Numbered(const std::string& topic_name, const SensorTopic& sensor)
        : topic(topic_name),
          frame(sensor.frame),
          stamps(sensor.stamps),
          taken(stamps.size()),
          format(sensor.scan_format) {}

    std::size_t size() const { return stamps.size(); }
    /// Empty for what the survey has found unusable.
    std::optional<int> take(const ros::Header& header) {
      const auto found = std::lower_bound(stamps.begin(), stamps.end(), header.stamp);
      const auto number = std::size_t(found - stamps.begin());
      if (found == stamps.end() || *found != header.stamp || header.frame != frame ||
          taken[number]) {
        return std::nullopt;
      }
      taken[number] = true;
      return int(number);
    }

    std::string topic, name, frame;
    std::vector<TimeNs> stamps;
    std::vector<bool> taken;
    ScanFormat format;
    std::size_t written = 0;
    UnusableMessages unusable;
  };

  /// Calls `write(number)` for a message that has not been there yet.
  template <class Write>
  static void use(Numbered& sensor, const ros::Header& header, Write&& write) {
    const auto number = sensor.take(header);
    if (!number) return;
    try {
      write(*number);
      ++sensor.written;
    } catch (const InputError& error) {
      sensor.unusable.add(error.problem());
    }
  }

  void write_scan(const ros::PointCloud2& cloud) {
    const TimeNs stamp = cloud.header.stamp;
    use(lidar_, cloud.header, [&](int number) {
      ScanRows rows(lidar_.format, stamp);
      read_cloud_rows(cloud, lidar_.topic, rows);
      const LidarScan scan = rows.take(lidar_.topic);
      dropped_ += scan.dropped;
      points_ += scan.points.size();
      for (const float intensity : scan.points.intensity) {
        above_1_ += intensity > 1, above_255_ += intensity > 255;
      }
      writer_.write_scan(number, stamp, scan.points);
    });
  }

  void write_plain(const ros::ImageMessage& image, Numbered& camera) {
    use(camera, image.header, [&](int number) {
      writer_.write_image(camera.name, number, image.header.stamp, image_of(image, camera.topic));
    });
  }

  void write_compressed(const ros::CompressedImage& image, Numbered& camera) {
    use(camera, image.header, [&](int number) {
      const bool png = is_png(image.data);
      if (!png && !is_jpeg(image.data)) {
        throw InputError(fmt::format("images of format '{:.40}' are not read", image.format),
                         camera.topic, "record PNG or JPEG");
      }
      writer_.write_encoded_image(camera.name, number, image.header.stamp, image.data,
                                  png ? ".png" : ".jpg");
    });
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
  std::size_t done_ = 0, total_ = 0;
  std::size_t points_ = 0, above_1_ = 0, above_255_ = 0, dropped_ = 0;
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
  ConvertFigures figures;
  GenericDriveWriter writer(output, force);
  const std::filesystem::path scratch = writer.folder();
  bool stopped = false;
  const BagSurvey survey =
      survey_bags(files, scratch, [&] { return !(stopped = !progress(0, 0)); });
  if (stopped) {
    figures.stopped = true;
    return figures;
  }
  ConversionPlan plan = naming(bags, [&] { return plan_conversion(survey, options); });
  Recorder recorder(survey, plan, writer, progress);
  for (const std::filesystem::path& file : files) {
    if (!recorder.stopped()) read_bag_file(file, scratch, recorder);
  }
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
