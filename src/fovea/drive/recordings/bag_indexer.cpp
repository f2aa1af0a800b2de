#include "fovea/drive/recordings/bag_indexer.h"

#include <fmt/format.h>

#include <algorithm>

#include "fovea/core/stable_order.h"
#include "fovea/drive/recordings/pixels.h"
#include "fovea/drive/recordings/scan_message.h"
#include "fovea/errors.h"

namespace fovea {
namespace {

/// Why a compressed image is not read; empty if it is. The format tells, in words of
/// compressed_image_transport, what was compressed and to what: "bayer_rggb8; png compressed ".
std::string why_unread(const ros::CompressedImage& image) {
  const std::string_view format = image.format;
  if (!is_png(image.data) && !is_jpeg(image.data)) {
    return fmt::format("compressed images of format '{:.40}' are not read", format);
  }
  const std::size_t end = format.find(';');
  if (end == std::string_view::npos) return "";
  const std::string_view source = format.substr(0, end);
  if (!is_known_encoding(source)) {
    return fmt::format("images of encoding '{:.40}' are not read", source);
  }
  constexpr std::string_view kCompressed = "compressed ";
  const std::size_t at = format.find(kCompressed, end);
  const std::string_view stored =
      at == std::string_view::npos ? "" : format.substr(at + kCompressed.size());
  if (source.starts_with("bayer") && (stored.empty() || stored.starts_with("bayer"))) {
    return "compressed images of one colour a pixel (Bayer) are not read";
  }
  return "";
}

/// @return whether the message is the topic's first
bool add_stamp(const ros::Header& header, SensorTopic& topic) {
  check_stamp(header);
  const bool first = topic.stamps.empty();
  if (first) topic.frame = header.frame;
  check_header(header, topic.frame);
  topic.stamps.push_back(header.stamp);
  return first;
}

/// Keeps the first scans, and the first ones with times that differ.
void keep_first(ScanNumbers numbers, std::vector<ScanNumbers>& scans) {
  constexpr std::size_t kKept = 5;
  const auto has_times = [](const ScanNumbers& scan) { return scan.times && scan.times->span > 0; };
  if (scans.size() < kKept) {
    scans.push_back(std::move(numbers));
  } else if (has_times(numbers)) {
    const auto without = std::find_if_not(scans.begin(), scans.end(), has_times);
    if (without != scans.end()) *without = std::move(numbers);
  }
}

template <class Message>
void keep(Message message, std::vector<Message>& messages) {
  check_stamp(message.header);
  messages.push_back(std::move(message));
}

/// In order of stamps, without the topics of which nothing could be read.
template <class Message>
void sort(std::map<std::string, std::vector<Message>>& topics) {
  std::erase_if(topics, [](const auto& topic) { return topic.second.empty(); });
  for (auto& [name, messages] : topics) {
    sort_stably(messages,
                [](const Message& a, const Message& b) { return a.header.stamp < b.header.stamp; });
  }
}

void keep_each_once(const std::string& name, std::vector<TimeNs>& stamps,
                    std::map<std::string, UnusableMessages>& unusable) {
  std::sort(stamps.begin(), stamps.end());
  const auto end = std::unique(stamps.begin(), stamps.end());
  for (auto again = end; again != stamps.end(); ++again) {
    unusable[name].add("two messages have the same stamp");
  }
  stamps.erase(end, stamps.end());
}

}  // namespace

bool BagIndexer::is_requested(const BagTopic& topic) {
  index_.topics.insert_or_assign(topic.name, topic);
  return readers().contains(topic.type);
}

void BagIndexer::add(const BagTopic& topic, std::string_view bytes) {
  ++index_.messages[topic.name];
  try {
    MessageReader message(bytes, topic.encoding, topic.name);
    (this->*readers().at(topic.type))(topic, message);
  } catch (const InputError& error) {
    index_.unusable[topic.name].add(error.problem(), error.remedy());
  }
}

void BagIndexer::forget_past() {
  BagIndex index;
  index.topics = std::move(index_.topics);
  index.camera_infos = std::move(index_.camera_infos);
  index.transforms = std::move(index_.transforms);
  index.transforms.forget_past();
  index_ = std::move(index);
}

BagIndex BagIndexer::finish() {
  sort(index_.fixes);
  sort(index_.imus);
  sort(index_.odometries);
  for (auto* topics : {&index_.lidars, &index_.images}) {
    std::erase_if(*topics, [](const auto& topic) { return topic.second.stamps.empty(); });
    for (auto& [name, topic] : *topics) keep_each_once(name, topic.stamps, index_.unusable);
  }
  return std::move(index_);
}

const std::map<std::string_view, BagIndexer::Reader>& BagIndexer::readers() {
  static const std::map<std::string_view, Reader> kReaders = {
      {ros::kPointCloud, &BagIndexer::add_scan},
      {ros::kLivox, &BagIndexer::add_scan},
      {ros::kLivox2, &BagIndexer::add_scan},
      {ros::kVelodyneScan, &BagIndexer::add_scan},
      {ros::kImage, &BagIndexer::add_image},
      {ros::kCompressedImage, &BagIndexer::add_compressed},
      {ros::kCameraInfo, &BagIndexer::add_camera_info},
      {ros::kNavSatFix, &BagIndexer::add_fix},
      {ros::kImu, &BagIndexer::add_imu},
      {ros::kOdometry, &BagIndexer::add_odometry},
      {ros::kTransforms, &BagIndexer::add_transforms}};
  return kReaders;
}

void BagIndexer::add_scan(const BagTopic& topic, MessageReader& message) {
  const ScanMessage scan(topic.type, message);
  ScanNumberRows rows(scan.header().stamp);
  scan.read(topic.name, rows);
  SensorTopic& lidar = index_.lidars[topic.name];
  add_stamp(scan.header(), lidar);
  keep_first(rows.take(), lidar.first_scans);
}

void BagIndexer::add_image(const BagTopic& topic, MessageReader& message) {
  const ros::ImageMessage image = ros::read_image(message);
  SensorTopic& camera = index_.images[topic.name];
  if (!add_stamp(image.header, camera)) return;
  camera.width = image.width, camera.height = image.height;
  if (!is_known_encoding(image.encoding)) {
    camera.unread = fmt::format("images of encoding '{:.40}' are not read", image.encoding);
  }
}

void BagIndexer::add_compressed(const BagTopic& topic, MessageReader& message) {
  const ros::CompressedImage image = ros::read_compressed_image(message);
  SensorTopic& camera = index_.images[topic.name];
  if (add_stamp(image.header, camera)) camera.unread = why_unread(image);
}

void BagIndexer::add_camera_info(const BagTopic& topic, MessageReader& message) {
  ros::CameraInfo info = ros::read_camera_info(message);
  const auto [known, fresh] = index_.camera_infos.try_emplace(topic.name, info);
  if (!fresh && known->second.k[0] == 0) known->second = std::move(info);
}

void BagIndexer::add_fix(const BagTopic& topic, MessageReader& message) {
  keep(ros::read_nav_sat_fix(message), index_.fixes[topic.name]);
}

void BagIndexer::add_imu(const BagTopic& topic, MessageReader& message) {
  keep(ros::read_imu(message), index_.imus[topic.name]);
}

void BagIndexer::add_odometry(const BagTopic& topic, MessageReader& message) {
  keep(ros::read_odometry(message), index_.odometries[topic.name]);
}

void BagIndexer::add_transforms(const BagTopic& topic, MessageReader& message) {
  const bool fixed = topic.name.ends_with("tf_static");
  for (const ros::Transform& transform : ros::read_transforms(message)) {
    index_.transforms.add(transform.header.frame, transform.child_frame, transform.header.stamp,
                          transform.T_header_child, fixed);
  }
}

}  // namespace fovea
