#include "fovea/rosbag/survey.h"

#include <algorithm>

#include "fovea/base/errors.h"
#include "fovea/rosbag/bag.h"
#include "fovea/rosbag/point_cloud_rows.h"

namespace fovea {
namespace {

class Surveyor : public BagSink {
 public:
  bool wants(const BagTopic& topic) override {
    survey_.topics.insert_or_assign(topic.name, topic);
    return readers().contains(topic.type);
  }

  bool add(const BagTopic& topic, std::string_view bytes) override {
    try {
      CdrReader message(bytes, topic.name);
      (this->*readers().at(topic.type))(topic.name, message);
    } catch (const InputError& error) {
      survey_.unusable[topic.name].add(error.problem());
    }
    return true;
  }

  BagSurvey finish() {
    sort(survey_.fixes);
    sort(survey_.imus);
    sort(survey_.odometries);
    for (auto* topics : {&survey_.clouds, &survey_.images}) {
      for (auto& [name, topic] : *topics) keep_each_once(name, topic.stamps);
    }
    return std::move(survey_);
  }

 private:
  using Reader = void (Surveyor::*)(const std::string&, CdrReader&);

  static const std::map<std::string_view, Reader>& readers() {
    static const std::map<std::string_view, Reader> kReaders = {
        {ros::kPointCloud, &Surveyor::add_cloud},
        {ros::kImage, &Surveyor::add_image},
        {ros::kCompressedImage, &Surveyor::add_compressed},
        {ros::kCameraInfo, &Surveyor::add_camera_info},
        {ros::kNavSatFix, &Surveyor::add_fix},
        {ros::kImu, &Surveyor::add_imu},
        {ros::kOdometry, &Surveyor::add_odometry},
        {ros::kTransforms, &Surveyor::add_transforms}};
    return kReaders;
  }

  /// @return whether the message is the topic's first
  bool add_stamp(const std::string& name, const ros::Header& header, SensorTopic& topic) {
    if (header.stamp <= 0) {
      survey_.unusable[name].add("a message has no stamp");
      return false;
    }
    topic.stamps.push_back(header.stamp);
    if (topic.stamps.size() > 1) return false;
    topic.frame = header.frame;
    return true;
  }

  void add_cloud(const std::string& name, CdrReader& message) {
    const ros::PointCloud2 cloud = ros::read_point_cloud(message);
    SensorTopic& topic = survey_.clouds[name];
    if (add_stamp(name, cloud.header, topic)) topic.scan_format = time_format_of(cloud, name);
  }
  void add_image(const std::string& name, CdrReader& message) {
    const ros::ImageMessage image = ros::read_image(message);
    SensorTopic& topic = survey_.images[name];
    if (add_stamp(name, image.header, topic)) topic.encoding = image.encoding;
  }
  void add_compressed(const std::string& name, CdrReader& message) {
    add_stamp(name, ros::read_header(message), survey_.images[name]);
  }
  void add_camera_info(const std::string& name, CdrReader& message) {
    if (!survey_.camera_infos.contains(name)) {
      survey_.camera_infos.emplace(name, ros::read_camera_info(message));
    }
  }
  void add_fix(const std::string& name, CdrReader& message) {
    survey_.fixes[name].push_back(ros::read_nav_sat_fix(message));
  }
  void add_imu(const std::string& name, CdrReader& message) {
    survey_.imus[name].push_back(ros::read_imu(message));
  }
  void add_odometry(const std::string& name, CdrReader& message) {
    survey_.odometries[name].push_back(ros::read_odometry(message));
  }
  void add_transforms(const std::string& name, CdrReader& message) {
    const bool fixed = name.ends_with("tf_static");
    for (const ros::Transform& transform : ros::read_transforms(message)) {
      survey_.transforms.add(transform.header.frame, transform.child_frame, transform.header.stamp,
                             transform.T_header_child, fixed);
    }
  }

  template <class Message>
  static void sort(std::map<std::string, std::vector<Message>>& topics) {
    for (auto& [name, messages] : topics) {
      std::stable_sort(messages.begin(), messages.end(), [](const Message& a, const Message& b) {
        return a.header.stamp < b.header.stamp;
      });
    }
  }

  void keep_each_once(const std::string& name, std::vector<TimeNs>& stamps) {
    std::sort(stamps.begin(), stamps.end());
    const auto end = std::unique(stamps.begin(), stamps.end());
    for (auto again = end; again != stamps.end(); ++again) {
      survey_.unusable[name].add("two messages have the same stamp");
    }
    stamps.erase(end, stamps.end());
  }

  BagSurvey survey_;
};

}  // namespace

BagSurvey survey_bags(const std::vector<std::filesystem::path>& files) {
  Surveyor surveyor;
  for (const std::filesystem::path& file : files) read_bag_file(file, surveyor);
  return surveyor.finish();
}

}  // namespace fovea
