#include "fovea/drive/recordings/navigation_topics.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "fovea/drive/recordings/only_topic.h"
#include "fovea/errors.h"

namespace fovea {
namespace {

constexpr const char* kNoImu = "none";  // of the option --imu

class NavigationPlanner {
 public:
  NavigationPlanner(const BagIndex& index, const ConvertOptions& options,
                    const std::string& lidar_frame, RecordedDrive& drive,
                    std::vector<std::string>& notes)
      : index_(index), options_(options), lidar_frame_(lidar_frame), drive_(drive), notes_(notes) {}

  NavigationPlan plan() {
    take_poses();
    take_imu();
    return std::move(plan_);
  }

 private:
  void take_poses() {
    for (const std::string& frame : index_.transforms.ambiguous()) {
      notes_.push_back(
          fmt::format("tf has frame '{}' in several parents: the most frequent counts", frame));
    }
    switch (source()) {
      case NavigationSource::kAuto:
        if (!take_positions() && !take_odometry() && !take_transforms()) take_nothing();
        return;
      case NavigationSource::kGnss:
        return require(take_positions(), "positions (sensor_msgs/msg/NavSatFix)");
      case NavigationSource::kOdometry:
        return require(take_odometry(), "poses (nav_msgs/msg/Odometry)");
      case NavigationSource::kTf:
        return require(take_transforms(), "frame of tf above the body that it moves in");
      case NavigationSource::kNone:
        return take_nothing();
    }
  }

  /// What the options name says where poses come from.
  NavigationSource source() const {
    NavigationSource source = options_.poses;
    const auto imply = [&](const std::string& name, NavigationSource implied, const char* option) {
      if (name.empty()) return;
      if (source != NavigationSource::kAuto && source != implied) {
        throw ConfigError("poses are to come from elsewhere", fmt::format("{} {}", option, name),
                          "leave it out, or choose its source by --poses");
      }
      source = implied;
    };
    imply(options_.fix, NavigationSource::kGnss, "--fix");
    imply(options_.odometry, NavigationSource::kOdometry, "--odometry");
    imply(options_.world, NavigationSource::kTf, "--world");
    return source;
  }

  void require(bool found, const char* what) const {
    if (!found) {
      throw InputError(fmt::format("the recording has no {}", what), "--poses",
                       "choose another source, or none");
    }
  }

  std::string usual_body() const {
    if (!options_.body.empty()) return options_.body;
    std::string usual = "base_link";  // REP 105
    if (!index_.transforms.fixed(usual, lidar_frame_)) usual = lidar_frame_;
    return usual;
  }

  void take_nothing() {
    drive_.T_body_lidar = T_body_lidar(usual_body());
    notes_.emplace_back("no poses: the motion will be that of the scans alone");
  }

  /// T_a_b; empty if tf does not tell, or they move.
  std::optional<QuaternionMotion> still(const std::string& a, const std::string& b) const {
    if (index_.transforms.moving(a, b)) return std::nullopt;
    return index_.transforms.fixed(a, b);
  }

  /// InputError if tf does not tell, or they move.
  QuaternionMotion T_body_lidar(const std::string& body) const {
    const auto T = index_.transforms.fixed(body, lidar_frame_);
    if (!T) {
      throw InputError(
          fmt::format("tf does not say where the LiDAR ('{}') is on '{}'", lidar_frame_, body),
          "/tf_static", "record it, too, or name another frame by --body");
    }
    if (const auto moving = index_.transforms.moving(body, lidar_frame_)) {
      throw InputError(
          fmt::format("frame '{}' moves between '{}' and '{}'", *moving, body, lidar_frame_), "/tf",
          "name the frame of the vehicle by --body");
    }
    return *T;
  }

  bool take_positions() {
    const std::string topic = only_topic(index_.fixes, options_.fix, "NavSatFix", "--fix");
    if (topic.empty()) return false;
    std::size_t without = 0;
    for (const ros::NavSatFix& fix : index_.fixes.at(topic)) {
      if (const auto position = position_of(fix)) {
        drive_.positions.push_back(*position);
      } else {
        ++without;
      }
    }
    if (drive_.positions.empty()) return false;
    plan_.fix = topic;
    notes_.push_back(fmt::format("positions: {} of {}, {} without a fix left out",
                                 drive_.positions.size(), topic, without));
    const std::string body = usual_body();
    drive_.T_body_lidar = T_body_lidar(body);
    const std::string& antenna = index_.fixes.at(topic).front().header.frame;
    if (const auto T = still(body, antenna)) {
      drive_.antenna_body = T->translation;
    } else {
      notes_.push_back(fmt::format(
          "tf does not say where the antenna ('{}') is on '{}': taken to be there", antenna, body));
    }
    return true;
  }

  /// Empty: there is none, or nothing says which.
  std::string imu_topic() {
    const bool may_choose = !options_.imu.empty() || !drive_.positions.empty();
    if (may_choose || index_.imus.size() <= 1) {
      return only_topic(index_.imus, options_.imu, "Imu", "--imu");
    }
    notes_.push_back(fmt::format("there are {} IMUs: none is used, choose one by --imu TOPIC",
                                 index_.imus.size()));
    return "";
  }

  /// Orientations for positions, and rates and accelerations for the motion.
  void take_imu() {
    if (options_.imu == kNoImu) return;
    const std::string topic = imu_topic();
    if (topic.empty()) return;
    const std::vector<ros::Imu>& imus = index_.imus.at(topic);
    const std::string& frame = imus.front().header.frame;
    plan_.imu_use.orientations = take_orientations(topic, imus, frame);
    plan_.imu_use.rates = take_rates(topic, imus, frame);
    for (const ros::Imu& imu : imus) {
      if (const auto inertia = inertia_of(imu, plan_.imu_use)) drive_.inertia.push_back(*inertia);
    }
    if (!drive_.inertia.empty()) plan_.imu = topic;
  }

  bool take_orientations(const std::string& topic, const std::vector<ros::Imu>& imus,
                         const std::string& frame) {
    if (drive_.positions.empty()) return false;
    const auto T = still(usual_body(), frame);
    if (!T) {
      notes_.push_back(
          fmt::format("orientations of {} are not used: tf does not say where '{}' is on '{}'",
                      topic, frame, usual_body()));
      return false;
    }
    drive_.T_body_imu = *T;
    // What an IMU that knows none leaves in its messages, though it should say so in another way.
    bool ever_turned = false;
    std::size_t count = 0;
    for (const ros::Imu& imu : imus) {
      if (!imu.orientation) continue;
      ever_turned |= !imu.orientation->vec().isZero(0);
      ++count;
    }
    notes_.push_back(fmt::format("orientations: {} of {} messages of {} have one",
                                 ever_turned ? count : 0, imus.size(), topic));
    return ever_turned;
  }

  bool take_rates(const std::string& topic, const std::vector<ros::Imu>& imus,
                  const std::string& frame) {
    const bool measures = std::any_of(imus.begin(), imus.end(), [](const ros::Imu& imu) {
      return !imu.acceleration.isZero(0) && !imu.angular_velocity.isZero(0);
    });
    if (!measures) return false;
    if (const auto T = still(lidar_frame_, frame)) {
      drive_.T_lidar_imu = *T;
      notes_.push_back(fmt::format("IMU: {} rates and accelerations of {}", imus.size(), topic));
    } else {
      notes_.push_back(fmt::format(
          "{} does not tell the motion: tf does not say where '{}' is on the LiDAR; state "
          "imu.T_lidar_imu in drive.toml",
          topic, frame));
    }
    return true;
  }

  bool take_odometry() {
    const std::string topic =
        only_topic(index_.odometries, options_.odometry, "Odometry", "--odometry");
    if (topic.empty()) return false;
    const std::vector<ros::Odometry>& odometries = index_.odometries.at(topic);
    for (const ros::Odometry& odometry : odometries) drive_.poses.push_back(pose_of(odometry));
    const std::string& child = odometries.front().child_frame;
    const bool from_child = options_.body.empty() && !child.empty();
    drive_.T_body_lidar = T_body_lidar(from_child ? child : usual_body());
    plan_.odometry = topic;
    notes_.push_back(fmt::format("poses: {} of {}", drive_.poses.size(), topic));
    return true;
  }

  bool take_transforms() {
    const std::string body = usual_body();
    const auto world =
        options_.world.empty() ? index_.transforms.world_of(body) : std::optional(options_.world);
    if (!world) return false;
    for (const auto& [time, T_world_body] : index_.transforms.course(*world, body)) {
      drive_.poses.push_back({time, T_world_body});
    }
    if (drive_.poses.empty()) return false;
    drive_.T_body_lidar = T_body_lidar(body);
    plan_.world = *world, plan_.body = body;
    notes_.push_back(
        fmt::format("poses: {} of '{}' in '{}', by tf", drive_.poses.size(), body, *world));
    return true;
  }

  const BagIndex& index_;
  const ConvertOptions& options_;
  const std::string& lidar_frame_;
  RecordedDrive& drive_;
  std::vector<std::string>& notes_;
  NavigationPlan plan_;
};

}  // namespace

NavigationPlan plan_navigation(const BagIndex& index, const ConvertOptions& options,
                               const std::string& lidar_frame, RecordedDrive& drive,
                               std::vector<std::string>& notes) {
  return NavigationPlanner(index, options, lidar_frame, drive, notes).plan();
}

}  // namespace fovea
