#include "fovea/drive/drive_description.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <set>

#include "fovea/core/settings.h"
#include "fovea/drive/calibration_file.h"
#include "fovea/drive/images/image_decode.h"
#include "fovea/drive/imu_keys.h"
#include "fovea/drive/lidar_keys.h"
#include "fovea/drive/motion_keys.h"
#include "fovea/drive/plausible_lens.h"
#include "fovea/errors.h"

namespace fovea {

inline auto names_of(LensModel) {
  const auto entry = [](LensModel model) { return EnumName<LensModel>{model, to_string(model)}; };
  return std::array{entry(LensModel::kNone), entry(LensModel::kPlumbBob),
                    entry(LensModel::kRationalPolynomial), entry(LensModel::kEquidistant)};
}

constexpr auto names_of(HeightType) {
  return std::array{EnumName<HeightType>{HeightType::kEllipsoidal, "ellipsoidal"},
                    EnumName<HeightType>{HeightType::kOrthometric, "orthometric"}};
}

namespace {

constexpr int kVersion = 1;

/// One camera's keys.
class CameraKeys {
 public:
  explicit CameraKeys(const std::string& name)
      : table_("camera." + name), T_cam_lidar_(table_, "cam", "lidar") {
    camera_.name = name;
    folder_ = "images/" + name;
  }

  void visit(SettingVisitor& visit) {
    visit(key("index"), index_);
    visit(key("folder"), folder_);
    visit(key("calibration"), calibration_);
    visit(key("width"), width_);
    visit(key("height"), height_);
    visit(key("K"), K_);
    visit(key("distortion_model"), model_);
    visit(key("D"), D_);
    visit(key("field_of_view"), Degrees{camera_.max_field_of_view});
    visit(key("delay"), camera_.delay);
    visit(key("stamp_delay"), camera_.stamp_delay);
    visit(key("mask"), mask_);
    T_cam_lidar_.visit(visit);
  }

  /// ConfigError whose place is the key. InputError for a calibration file that is not read.
  /// @param drive_folder  holds that file
  CameraDescription camera(const std::filesystem::path& drive_folder) {
    camera_.index = required(index_, "index", "give a number of 0 to 9");
    check_key(key("index"), camera_.index, 0, kMaxCameraIndex);
    camera_.folder = folder_;
    camera_.mask = mask_;
    if (calibration_.empty()) {
      camera_.optics.width = required(width_, "width", "give the images' width in pixels");
      camera_.optics.height = required(height_, "height", "give the images' height in pixels");
      read_intrinsics();
      read_distortion();
    } else {
      read_calibration(drive_folder);
    }
    check_key(key("width"), camera_.optics.width, 8, kMaxImageSide);
    check_key(key("height"), camera_.optics.height, 8, kMaxImageSide);
    if (const auto problem = lens_problem(camera_.optics)) {
      reject_key(problem->what, key(problem->key), problem->remedy);
    }
    constexpr double kNarrowest = 10 * kDegree, kWidest = 170 * kDegree;
    if (!(camera_.max_field_of_view >= kNarrowest && camera_.max_field_of_view <= kWidest)) {
      reject_key("the field of view is out of range", key("field_of_view"),
                 "give 10 to 170 degrees");
    }
    check_key(key("delay"), camera_.delay, -1, 1);
    if (camera_.stamp_delay) check_key(key("stamp_delay"), *camera_.stamp_delay, -1, 1);
    const auto T = T_cam_lidar_.motion();
    if (!T) reject_key("a key is missing", T_cam_lidar_.forward.key, "say where the camera sits");
    camera_.T_cam_lidar = *T;
    return camera_;
  }

 private:
  std::string key(std::string_view name) const { return fmt::format("{}.{}", table_, name); }

  template <class T>
  const T& required(const std::optional<T>& value, std::string_view name,
                    std::string_view remedy) const {
    if (!value) reject_key("a key is missing", key(name), remedy);
    return *value;
  }

  /// "FILE" or "FILE:CAMERA".
  void read_calibration(const std::filesystem::path& drive_folder) {
    if (width_ || height_ || K_ || !D_.empty()) {
      reject_key("the file and this table both state the camera", key("calibration"),
                 "state the file, or width, height, K and D");
    }
    const std::size_t colon = calibration_.rfind(':');
    const std::string name = colon == std::string::npos ? "" : calibration_.substr(colon + 1);
    camera_.optics = read_calibration_file(drive_folder / calibration_.substr(0, colon), name);
    if (!camera_.optics.has_pinhole()) {
      reject_key("the file has no camera's matrix", key("calibration"), "state K and D instead");
    }
  }

  void read_intrinsics() {
    const std::vector<double>& K = required(K_, "K", "give fx 0 cx, 0 fy cy, 0 0 1");
    if (K.size() != 9) {
      reject_key(fmt::format("there are {} numbers, not 9", K.size()), key("K"),
                 "give fx 0 cx, 0 fy cy, 0 0 1");
    }
    LensCamera& c = camera_.optics;
    c.fx = K[0], c.cx = K[2], c.fy = K[4], c.cy = K[5];
    const bool pinhole =
        c.has_pinhole() && K[1] == 0 && K[3] == 0 && K[6] == 0 && K[7] == 0 && K[8] == 1;
    if (!pinhole)
      reject_key("this is no camera's matrix", key("K"), "give fx 0 cx, 0 fy cy, 0 0 1");
  }

  void read_distortion() {
    const auto coefficients = lens_coefficients(model_, D_);
    if (!coefficients) {
      reject_key(
          fmt::format("the {} coefficients are not those of '{}'", D_.size(), to_string(model_)),
          key("D"), fmt::format("give its {}", coefficient_count(model_)));
    }
    camera_.optics.lens = Lens(model_, *coefficients);
  }

  std::string table_;
  CameraDescription camera_;
  std::optional<int> index_, width_, height_;
  std::string folder_, mask_, calibration_;
  std::optional<std::vector<double>> K_;
  LensModel model_ = LensModel::kNone;
  std::vector<double> D_;
  MotionKeys T_cam_lidar_;
};

/// All keys of a drive.
class DriveKeys {
 public:
  /// @param lidar_names  empty: the drive has one LiDAR, [lidar]
  DriveKeys(const std::vector<std::string>& lidar_names,
            const std::vector<std::string>& camera_names, std::filesystem::path drive_folder)
      : drive_folder_(std::move(drive_folder)),
        lidars_(lidar_names.begin(), lidar_names.end()),
        cameras_(camera_names.begin(), camera_names.end()) {
    if (lidars_.empty()) lidars_.emplace_back("");
  }

  void visit(SettingVisitor& visit) {
    visit("version", version_);
    for (LidarKeys& lidar : lidars_) lidar.visit(visit);
    visit("images.tolerance", drive_.image_tolerance);
    T_body_lidar_.visit(visit);
    T_body_imu_.visit(visit);
    visit("body.antenna", antenna_);
    visit("georeference.datum", drive_.coordinates.datum);
    visit("georeference.epoch_year", drive_.coordinates.epoch_year);
    visit("georeference.heights", drive_.coordinates.heights);
    imu_.visit(visit);
    visit("wheels.sigma", drive_.wheels.sigma);
    for (CameraKeys& camera : cameras_) camera.visit(visit);
  }

  /// ConfigError whose place is the key.
  void finish() {
    check_drive_version(version_);
    read_lidars();
    check_key("images.tolerance", drive_.image_tolerance, 0, 1);
    drive_.T_body_lidar = T_body_lidar_.motion().value_or(drive_.T_body_lidar);
    drive_.T_body_imu = T_body_imu_.motion().value_or(drive_.T_body_imu);
    if (antenna_.size() != 3) {
      reject_key(fmt::format("there are {} numbers, not 3", antenna_.size()), "body.antenna",
                 "give x, y, z in meters");
    }
    drive_.antenna_body = Eigen::Map<const Eigen::Vector3d>(antenna_.data());
    check_lever("body.antenna", drive_.antenna_body);
    read_coordinates();
    drive_.imu = imu_.imu();
    check_key("wheels.sigma", drive_.wheels.sigma, 1e-3, 100);
    drive_.wheels.T_lidar_body = drive_.T_body_lidar.inverse();
    read_cameras();
  }

  DriveDescription take() { return std::move(drive_); }

 private:
  /// The LiDAR whose table has no pose comes first.
  void read_lidars() {
    if (lidars_.size() > kMaxLidars) {
      reject_key(fmt::format("there are {} LiDARs", lidars_.size()), "lidar",
                 fmt::format("describe at most {}", kMaxLidars));
    }
    std::optional<LidarDescription> first;
    std::set<std::filesystem::path> folders;
    for (LidarKeys& keys : lidars_) {
      LidarDescription lidar = keys.lidar();
      if (!folders.insert(lidar.folder.lexically_normal()).second) {
        reject_key("two LiDARs have the same folder", lidar.table() + ".folder",
                   "give each LiDAR its own scans");
      }
      if (keys.has_pose()) {
        drive_.further_lidars.push_back(std::move(lidar));
        continue;
      }
      if (first) {
        reject_key(fmt::format("LiDARs {} and {} have no pose", first->name, lidar.name),
                   keys.pose_key(),
                   "give one of them T_lidar_sensor: the frame of the other is that of the drive");
      }
      first = std::move(lidar);
    }
    if (!first) {
      reject_key("every LiDAR has a pose", "lidar",
                 "leave out T_lidar_sensor of the one whose frame the other poses name");
    }
    drive_.lidar = std::move(*first);
  }

  void read_coordinates() const {
    const CoordinateReference& stated = drive_.coordinates;
    if (stated.datum && stated.datum->empty()) {
      reject_key("the datum has no name", "georeference.datum", "give one, such as ITRF2014");
    }
    if (stated.epoch_year) check_key("georeference.epoch_year", *stated.epoch_year, 1900, 2200);
  }

  void read_cameras() {
    for (CameraKeys& keys : cameras_) {
      CameraDescription camera = keys.camera(drive_folder_);
      for (const CameraDescription& other : drive_.cameras) {
        if (other.index != camera.index) continue;
        reject_key(fmt::format("cameras {} and {} have the same index", other.name, camera.name),
                   "camera." + camera.name + ".index", "number them differently");
      }
      drive_.cameras.push_back(std::move(camera));
    }
    std::sort(drive_.cameras.begin(), drive_.cameras.end(),
              [](const auto& a, const auto& b) { return a.index < b.index; });
  }

  std::filesystem::path drive_folder_;
  DriveDescription drive_;
  std::optional<int> version_;
  MotionKeys T_body_lidar_{"body", "body", "lidar"}, T_body_imu_{"body", "body", "imu"};
  std::vector<double> antenna_{0, 0, 0};
  ImuKeys imu_;
  std::vector<LidarKeys> lidars_;
  std::vector<CameraKeys> cameras_;
};

DriveDescription read(const SettingsDocument& document, const std::filesystem::path& drive_folder) {
  DriveKeys keys(document.tables("lidar", /*among_keys=*/true), document.tables("camera"),
                 drive_folder);
  document.apply([&](SettingVisitor& visit) { keys.visit(visit); }, [&] { keys.finish(); },
                 "see docs/drives.md for the keys");
  return keys.take();
}

}  // namespace

void check_drive_version(const std::optional<int>& version) {
  if (!version) reject_key("a key is missing", "version", "write version = 1 above all tables");
  if (*version == kVersion) return;
  reject_key(fmt::format("the drive has version {}, this program reads {}", *version, kVersion),
             "version", "use a newer Fovea");
}

DriveDescription read_drive_description(const std::filesystem::path& file) {
  return read(SettingsDocument::from_file(file), file.parent_path());
}

DriveDescription parse_drive_description(std::string_view text, std::string_view name) {
  return read(SettingsDocument::from_text(text, name), {});
}

}  // namespace fovea
