#include "fovea/drive/recordings/live_messages.h"

#include <cmath>
#include <utility>

#include "fovea/drive/recordings/pixels.h"
#include "fovea/errors.h"

namespace fovea {
namespace {

/// What belongs to the last scan, as of a part of a recording.
constexpr TimeNs kMargin = kNsPerSecond / 10;

bool is_moving_tf(const BagTopic& topic) {
  return topic.type == ros::kTransforms && !topic.name.ends_with("tf_static");
}

}  // namespace

LiveMessages::LiveMessages(const BagIndex& index, const ConversionPlan& plan, double duration,
                           LiveSource& source)
    : source_(source), navigation_(plan.navigation) {
  for (const PlannedLidar& planned : plan.lidars) {
    const bool is_first = lidars_.empty();
    lidars_[planned.topic] = {planned.lidar.name, index.lidars.at(planned.topic).frame,
                              planned.format, is_first};
  }
  for (const PlannedCamera& planned : plan.cameras) {
    cameras_[planned.topic] = {planned.camera.name, index.images.at(planned.topic).frame, {}};
  }
  if (!navigation_.world.empty()) {
    course_.emplace(index.transforms, navigation_.world, navigation_.body);
  }
  if (std::isfinite(duration)) {
    end_ = index.lidars.at(plan.lidars.front().topic).stamps.front() + from_seconds(duration);
  }
}

bool LiveMessages::is_requested(const BagTopic& topic) { return use_of(topic) != nullptr; }

void LiveMessages::add(const BagTopic& topic, std::string_view bytes) {
  const Use use = use_of(topic);
  if (use == nullptr) return;
  try {
    MessageReader message(bytes, topic.encoding, topic.name);
    (this->*use)(topic, message);
  } catch (const InputError& error) {
    unusable_[topic.name].add(error.problem(), error.remedy());
  }
}

LiveMessages::Use LiveMessages::use_of(const BagTopic& topic) const {
  if (is_scan_type(topic.type)) {
    return lidars_.contains(topic.name) ? &LiveMessages::add_scan : nullptr;
  }
  if (cameras_.contains(topic.name)) {
    if (topic.type == ros::kImage) return &LiveMessages::add_image;
    if (topic.type == ros::kCompressedImage) return &LiveMessages::add_compressed;
    return nullptr;
  }
  if (topic.type == ros::kNavSatFix && topic.name == navigation_.fix) return &LiveMessages::add_fix;
  if (topic.type == ros::kImu && topic.name == navigation_.imu) return &LiveMessages::add_imu;
  if (topic.type == ros::kOdometry && topic.name == navigation_.odometry) {
    return &LiveMessages::add_odometry;
  }
  return course_ && is_moving_tf(topic) ? &LiveMessages::add_transforms : nullptr;
}

void LiveMessages::add_scan(const BagTopic& topic, MessageReader& message) {
  const Sensor& lidar = lidars_.at(topic.name);
  const ScanMessage scan(topic.type, message);
  check_header(scan.header(), lidar.frame);
  const TimeNs stamp = scan.header().stamp;
  if (lidar.is_first_lidar && stamp >= end_ + kMargin) is_over_ = true;
  if (stamp >= (lidar.is_first_lidar ? end_ : end_ + kMargin)) return;
  LidarScan read = scan_of(scan, lidar.format, topic.name);
  source_.add_scan({lidar.name, stamp, std::move(read.points), read.dropped});
}

void LiveMessages::add_image(const BagTopic& topic, MessageReader& message) {
  const Sensor& camera = cameras_.at(topic.name);
  const ros::ImageMessage image = ros::read_image(message);
  check_header(image.header, camera.frame);
  if (image.header.stamp >= end_ + kMargin) return;
  source_.add_image({camera.name, image.header.stamp, image_of(image, topic.name)});
}

void LiveMessages::add_compressed(const BagTopic& topic, MessageReader& message) {
  const Sensor& camera = cameras_.at(topic.name);
  const ros::CompressedImage image = ros::read_compressed_image(message);
  check_header(image.header, camera.frame);
  extension_of(image, topic.name);  // an error for other formats
  if (image.header.stamp >= end_ + kMargin) return;
  source_.add_image({camera.name, image.header.stamp, std::string(image.data)});
}

void LiveMessages::add_fix(const BagTopic& /*topic*/, MessageReader& message) {
  const ros::NavSatFix fix = ros::read_nav_sat_fix(message);
  check_stamp(fix.header);
  if (const auto position = position_of(fix)) source_.add_position(*position);
}

void LiveMessages::add_imu(const BagTopic& /*topic*/, MessageReader& message) {
  const ros::Imu imu = ros::read_imu(message);
  check_stamp(imu.header);
  if (const auto inertia = inertia_of(imu, navigation_.imu_use)) source_.add_inertia(*inertia);
}

void LiveMessages::add_odometry(const BagTopic& /*topic*/, MessageReader& message) {
  const ros::Odometry odometry = ros::read_odometry(message);
  check_stamp(odometry.header);
  source_.add_pose(pose_of(odometry));
}

void LiveMessages::add_transforms(const BagTopic& /*topic*/, MessageReader& message) {
  for (const RecordedPose& pose : course_->add(ros::read_transforms(message))) {
    source_.add_pose(pose);
  }
}

}  // namespace fovea
