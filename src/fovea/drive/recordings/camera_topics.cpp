#include "fovea/drive/recordings/camera_topics.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <tuple>

#include "fovea/drive/images/image_decode.h"
#include "fovea/drive/recordings/pixels.h"
#include "fovea/drive/recordings/place_on_vehicle.h"
#include "fovea/drive/recordings/sensor_name.h"
#include "fovea/errors.h"

namespace fovea {
namespace {

constexpr std::size_t kMaxCameras = 10;

/// What a topic's name says: "/front/image_rect_color/compressed".
struct ImagePath {
  std::string parent;  // "/front"
  std::string kind;    // "image_rect_color"
  bool compressed = false;

  std::string info_topic() const { return parent + "/camera_info"; }
  /// "image_rect", "image_rect_color", "rectified", but not "image_unrectified".
  bool rectified() const { return ("_" + kind).find("_rect") != std::string::npos; }
  /// Compressed depth may call itself PNG and nothing else: "/camera/depth/image_raw/compressed".
  bool may_be_depth() const {
    const std::string last = parent.substr(parent.rfind('/') + 1) + kind;
    return compressed && last.find("epth") != std::string::npos;
  }
};

ImagePath path_of(std::string topic) {
  ImagePath path;
  constexpr std::string_view kCompressed = "/compressed";
  if (topic.ends_with(kCompressed)) {
    topic.resize(topic.size() - kCompressed.size());
    path.compressed = true;
  }
  const std::size_t slash = topic.rfind('/');
  path.parent = slash == std::string::npos ? "" : topic.substr(0, slash);
  path.kind = slash == std::string::npos ? topic : topic.substr(slash + 1);
  return path;
}

LensModel lens_model(const std::string& name, const std::string& topic) {
  if (name.empty() || name == "none") return LensModel::kNone;
  if (name == "fisheye") return LensModel::kEquidistant;
  for (const LensModel model :
       {LensModel::kPlumbBob, LensModel::kRationalPolynomial, LensModel::kEquidistant}) {
    if (to_string(model) == name) return model;
  }
  throw InputError(fmt::format("the distortion model '{:.40}' is not read", name), topic,
                   "see docs/drives.md for those that are");
}

Lens lens_of(const ros::CameraInfo& info, const std::string& topic) {
  const LensModel model = lens_model(info.distortion_model, topic);
  const bool all_zero = std::all_of(info.d.begin(), info.d.end(), [](double d) { return d == 0; });
  if (all_zero) {
    // A pinhole, whose images need no rectification; a fisheye bends without coefficients, too.
    return Lens(model == LensModel::kEquidistant ? model : LensModel::kNone, {});
  }
  const auto coefficients = lens_coefficients(model, info.d);
  if (!coefficients) {
    throw InputError(fmt::format("the {} coefficients of distortion are not those of '{}'",
                                 info.d.size(), to_string(model)),
                     topic, "calibrate the camera with one of the models of docs/drives.md");
  }
  return Lens(model, *coefficients);
}

/// T_lidar_cam, of the first of the frames that tf knows.
QuaternionMotion place_of(const BagIndex& index, const std::string& lidar_frame,
                          const std::array<std::string, 2>& frames, const std::string& topic) {
  // No camera looks along the LiDAR's z: such a frame was never thought of.
  const auto is_known = [&](const std::string& frame) {
    return frame != lidar_frame && index.transforms.fixed(lidar_frame, frame);
  };
  const auto known = std::find_if(frames.begin(), frames.end(), is_known);
  if (known != frames.end()) return place_on_vehicle(index, lidar_frame, *known, topic);
  throw InputError(fmt::format("tf does not say where frame '{}' is in '{}'",
                               frames[0].empty() ? frames[1] : frames[0], lidar_frame),
                   topic, "record /tf_static, too");
}

/// T_rect_cam, a rotation.
QuaternionMotion rectification(const ros::CameraInfo& info, const std::string& topic) {
  const Eigen::Matrix3d R =
      Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(info.r.data());
  if (R.isZero(0) || R.isIdentity(0)) return {};
  constexpr double kTolerance = 1e-3;  // files are rounded
  if (!is_rotation(R, kTolerance)) {
    throw InputError("R is no rotation", topic, "calibrate the camera anew");
  }
  return {Eigen::Vector3d::Zero(), Eigen::Quaterniond(nearest_rotation(R))};
}

PlannedCamera plan_camera(const BagIndex& index, const std::string& topic, const std::string& name,
                          const std::string& lidar_frame) {
  const ImagePath path = path_of(topic);
  const auto info = index.camera_infos.find(path.info_topic());
  if (info == index.camera_infos.end()) {
    throw InputError(
        fmt::format("the images have no calibration: there is no CameraInfo {}", path.info_topic()),
        topic, "record it, too");
  }
  const SensorTopic& images = index.images.at(topic);
  if (!images.unread.empty()) {
    throw InputError(images.unread, topic, "see docs/drives.md for those that are");
  }
  PlannedCamera planned;
  planned.topic = topic;
  planned.camera.name = name;
  planned.camera.optics = optics_of(info->second, path.rectified(), path.info_topic());
  if (images.width != 0 &&
      (images.width != info->second.width || images.height != info->second.height)) {
    throw InputError(
        fmt::format("images have {} x {} pixels, their CameraInfo {} x {}", images.width,
                    images.height, info->second.width, info->second.height),
        topic, "calibrate the camera at the resolution of its images");
  }
  planned.camera.T_lidar_cam =
      place_of(index, lidar_frame, {info->second.header.frame, images.frame}, topic);
  if (path.rectified()) {
    planned.camera.T_lidar_cam =
        planned.camera.T_lidar_cam * rectification(info->second, path.info_topic()).inverse();
  }
  return planned;
}

/// The topics that may be cameras, by name, the best first.
std::map<std::string, std::vector<std::string>> likely_cameras(const BagIndex& index) {
  std::map<std::string, std::vector<std::string>> cameras;
  for (const auto& [topic, images] : index.images) {
    const ImagePath path = path_of(topic);
    if (!path.may_be_depth()) cameras[sensor_name(path.parent, "camera")].push_back(topic);
  }
  const auto rank = [](const std::string& topic) {
    const ImagePath path = path_of(topic);
    return std::tuple(path.rectified(), path.compressed, topic);
  };
  for (auto& [name, topics] : cameras) {
    std::sort(topics.begin(), topics.end(),
              [&](const std::string& a, const std::string& b) { return rank(a) < rank(b); });
  }
  return cameras;
}

std::vector<PlannedCamera> plan_named(const BagIndex& index, const ConvertOptions& options,
                                      const std::string& lidar_frame) {
  std::vector<PlannedCamera> cameras;
  for (const auto& [name, topic] : options.cameras) {
    if (!index.images.contains(topic)) {
      throw InputError("there are no images of this topic that can be read", topic,
                       "choose one that 'fovea convert --list' prints");
    }
    cameras.push_back(plan_camera(index, topic, name, lidar_frame));
  }
  return cameras;
}

std::vector<PlannedCamera> plan_all(const BagIndex& index, const std::string& lidar_frame,
                                    std::vector<std::string>& notes) {
  std::vector<PlannedCamera> cameras;
  std::optional<InputError> first_problem;
  for (const auto& [name, topics] : likely_cameras(index)) {
    for (const std::string& topic : topics) {
      try {
        cameras.push_back(plan_camera(index, topic, name, lidar_frame));
        break;
      } catch (const InputError& error) {
        if (!first_problem) first_problem = error;
        notes.push_back(fmt::format("{} is left out: {}", topic, error.problem()));
      }
    }
  }
  if (cameras.empty() && first_problem) throw InputError(*first_problem);
  return cameras;
}

}  // namespace

LensCamera optics_of(const ros::CameraInfo& info, bool rectified, const std::string& topic) {
  const auto refuse = [&](const std::string& what) {
    throw InputError(what, topic, "calibrate the camera at the resolution of its images");
  };
  const bool whole = info.roi_x == 0 && info.roi_y == 0 &&
                     (info.roi_width == 0 || info.roi_width == info.width) &&
                     (info.roi_height == 0 || info.roi_height == info.height);
  if (info.binning_x > 1 || info.binning_y > 1 || !whole) {
    refuse("images with binning or of a region of interest are not read");
  }
  if (info.width < 8 || info.height < 8 || info.width > kMaxImageSide ||
      info.height > kMaxImageSide) {
    refuse(fmt::format("images of {} x {} pixels are not read", info.width, info.height));
  }
  LensCamera optics;
  optics.width = int(info.width), optics.height = int(info.height);
  if (rectified) {
    if (info.p[3] != 0 || info.p[7] != 0) refuse("the second camera of a stereo pair is not read");
    optics.fx = info.p[0], optics.cx = info.p[2], optics.fy = info.p[5], optics.cy = info.p[6];
  } else {
    optics.fx = info.k[0], optics.cx = info.k[2], optics.fy = info.k[4], optics.cy = info.k[5];
    optics.lens = lens_of(info, topic);
  }
  if (!optics.has_pinhole()) {
    refuse("the camera is not calibrated (its focal length is no number of pixels)");
  }
  return optics;
}

std::vector<PlannedCamera> plan_cameras(const BagIndex& index, const ConvertOptions& options,
                                        const std::string& lidar_frame,
                                        std::vector<std::string>& notes) {
  std::vector<PlannedCamera> cameras = options.cameras.empty()
                                           ? plan_all(index, lidar_frame, notes)
                                           : plan_named(index, options, lidar_frame);
  if (cameras.empty()) {
    notes.push_back("the recording has no images: the drive has no camera, and maps no colors");
  }
  if (cameras.size() > kMaxCameras) {
    throw InputError(fmt::format("there are {} cameras, and a drive has at most {}", cameras.size(),
                                 kMaxCameras),
                     cameras.front().topic + " and others", "choose by --camera NAME=TOPIC");
  }
  for (std::size_t k = 0; k < cameras.size(); ++k) cameras[k].camera.index = int(k);
  return cameras;
}

}  // namespace fovea
