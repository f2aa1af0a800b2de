#include "fovea/drive/kitti/tracklets.h"

#include <fmt/format.h>

#include <cmath>
#include <pugixml.hpp>

#include "fovea/core/read_file.h"
#include "fovea/drive/calibrated_drive.h"
#include "fovea/errors.h"

namespace fovea {
namespace {

constexpr const char* kFileName = "tracklet_labels.xml";

[[noreturn]] void reject(std::string_view what, const std::filesystem::path& file,
                         std::ptrdiff_t offset) {
  throw InputError(what, fmt::format("{}: offset {}", file.string(), offset),
                   "restore the file from the KITTI archive");
}

/// A finite number in the child `name`.
double number_in(const pugi::xml_node& node, const char* name, const std::filesystem::path& file) {
  const auto numbers = parse_numbers(node.child_value(name));
  if (!numbers || numbers->size() != 1 || !std::isfinite(numbers->front())) {
    reject(fmt::format("a tracklet's <{}> is no number", name), file, node.offset_debug());
  }
  return numbers->front();
}

RigidMotion pose_of(const pugi::xml_node& node, const std::filesystem::path& file) {
  const auto value = [&](const char* name) { return number_in(node, name, file); };
  // rz turns about the LiDAR's z axis; rx and ry are 0 in KITTI's files.
  return Eigen::Translation3d(value("tx"), value("ty"), value("tz")) *
         Eigen::AngleAxisd(value("rz"), Eigen::Vector3d::UnitZ()) *
         Eigen::AngleAxisd(value("ry"), Eigen::Vector3d::UnitY()) *
         RigidMotion(Eigen::AngleAxisd(value("rx"), Eigen::Vector3d::UnitX()));
}

Tracklet tracklet_of(const pugi::xml_node& node, const std::filesystem::path& file) {
  Tracklet tracklet;
  tracklet.type = node.child_value("objectType");
  tracklet.size = {number_in(node, "l", file), number_in(node, "w", file),
                   number_in(node, "h", file)};
  const double first = number_in(node, "first_frame", file);
  if (!(tracklet.size.minCoeff() > 0)) {
    reject("a tracklet's box has no size", file, node.offset_debug());
  }
  if (first < 0 || first > 1e6 || first != std::floor(first)) {
    reject("a tracklet's first_frame is no frame number", file, node.offset_debug());
  }
  tracklet.first_frame = static_cast<int>(first);
  for (const pugi::xml_node& pose : node.child("poses").children("item")) {
    tracklet.T_lidar_box.push_back(pose_of(pose, file));
  }
  return tracklet;
}

}  // namespace

const RigidMotion* Tracklet::at(int frame) const {
  const std::ptrdiff_t place = std::ptrdiff_t{frame} - first_frame;
  if (place < 0 || place >= std::ssize(T_lidar_box)) return nullptr;
  return &T_lidar_box[static_cast<std::size_t>(place)];
}

bool Tracklet::contains(int frame, const Eigen::Vector3d& p_lidar, double margin) const {
  const RigidMotion* pose = at(frame);
  if (pose == nullptr) return false;
  const Eigen::Vector3d p = pose->inverse() * p_lidar;
  return std::abs(p.x()) <= size.x() / 2 + margin && std::abs(p.y()) <= size.y() / 2 + margin &&
         p.z() >= -margin && p.z() <= size.z() + margin;
}

std::optional<std::filesystem::path> find_tracklets(const std::filesystem::path& drive) {
  if (drive.empty()) return std::nullopt;
  const std::filesystem::path recorded = recorded_folder(drive);
  const std::filesystem::path inside = recorded / kFileName;
  std::error_code ignored;
  if (std::filesystem::exists(inside, ignored)) return inside;
  std::filesystem::path folder = std::filesystem::absolute(recorded, ignored).lexically_normal();
  if (folder.filename().empty()) folder = folder.parent_path();
  std::string name = folder.filename().string();
  constexpr std::string_view kSync = "_sync";
  if (!name.ends_with(kSync)) return std::nullopt;
  name.replace(name.size() - kSync.size(), kSync.size(), "_tracklets");
  const std::filesystem::path beside = folder.parent_path() / name / kFileName;
  if (std::filesystem::exists(beside, ignored)) return beside;
  return std::nullopt;
}

std::vector<Tracklet> read_tracklets(const std::filesystem::path& file) {
  const std::vector<std::uint8_t> bytes = read_bytes(file, kDescriptionFile);
  pugi::xml_document document;
  const pugi::xml_parse_result parsed = document.load_buffer(bytes.data(), bytes.size());
  if (!parsed) reject(parsed.description(), file, parsed.offset);
  const pugi::xml_node root = document.child("boost_serialization").child("tracklets");
  if (!root) reject("the file has no <tracklets>", file, 0);
  std::vector<Tracklet> tracklets;
  for (const pugi::xml_node& node : root.children("item")) {
    tracklets.push_back(tracklet_of(node, file));
  }
  if (static_cast<double>(tracklets.size()) != number_in(root, "count", file)) {
    reject("the file has another number of tracklets than it says", file, root.offset_debug());
  }
  return tracklets;
}

}  // namespace fovea
