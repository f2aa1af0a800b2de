#include "fovea/drive/drive_description.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "fovea/core/errors.h"
#include "fovea/core/settings.h"
#include "fovea/drive/calibration_file.h"
#include "fovea/drive/images/image_decode.h"
#include "fovea/drive/motion_keys.h"
#include "fovea/drive/plausible_lens.h"
#include "fovea/geometry/sweep_direction_names.h"

namespace fovea {

enum class TimeUnit { kAuto, kSecond, kMillisecond, kMicrosecond, kNanosecond };
enum class LengthUnit { kAuto, kMeter, kCentimeter, kMillimeter };
enum class ReferenceKey { kAuto, kStamp, kAbsolute, kFirstPoint, kNone };

constexpr auto names_of(TimeUnit) {
  return std::array{EnumName<TimeUnit>{TimeUnit::kAuto, "auto"},
                    EnumName<TimeUnit>{TimeUnit::kSecond, "s"},
                    EnumName<TimeUnit>{TimeUnit::kMillisecond, "ms"},
                    EnumName<TimeUnit>{TimeUnit::kMicrosecond, "us"},
                    EnumName<TimeUnit>{TimeUnit::kNanosecond, "ns"}};
}

constexpr auto names_of(LengthUnit) {
  return std::array{EnumName<LengthUnit>{LengthUnit::kAuto, "auto"},
                    EnumName<LengthUnit>{LengthUnit::kMeter, "m"},
                    EnumName<LengthUnit>{LengthUnit::kCentimeter, "cm"},
                    EnumName<LengthUnit>{LengthUnit::kMillimeter, "mm"}};
}

constexpr auto names_of(ReferenceKey) {
  return std::array{EnumName<ReferenceKey>{ReferenceKey::kAuto, "auto"},
                    EnumName<ReferenceKey>{ReferenceKey::kStamp, "stamp"},
                    EnumName<ReferenceKey>{ReferenceKey::kAbsolute, "absolute"},
                    EnumName<ReferenceKey>{ReferenceKey::kFirstPoint, "first_point"},
                    EnumName<ReferenceKey>{ReferenceKey::kNone, "none"}};
}

inline auto names_of(LensModel) {
  const auto entry = [](LensModel model) { return EnumName<LensModel>{model, to_string(model)}; };
  return std::array{entry(LensModel::kNone), entry(LensModel::kPlumbBob),
                    entry(LensModel::kRationalPolynomial), entry(LensModel::kEquidistant)};
}

namespace {

constexpr int kVersion = 1;
constexpr int kMaxCamera = 9;  // config_keys.h knows slices of as many

void check(const std::string& key, double value, double low, double high) {
  if (value >= low && value <= high) return;  // NaN is outside of everything
  reject_key(fmt::format("{:.6g} is out of range", value), key,
             fmt::format("give {:g} to {:g}", low, high));
}

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
    visit(key("mask"), mask_);
    T_cam_lidar_.visit(visit);
  }

  /// ConfigError whose place is the key. InputError for a calibration file that is not read.
  /// @param drive_folder  holds that file
  CameraDescription camera(const std::filesystem::path& drive_folder) {
    camera_.index = required(index_, "index", "give a number of 0 to 9");
    check(key("index"), camera_.index, 0, kMaxCamera);
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
    check(key("width"), camera_.optics.width, 8, kMaxImageSide);
    check(key("height"), camera_.optics.height, 8, kMaxImageSide);
    if (const auto problem = lens_problem(camera_.optics)) {
      reject_key(problem->what, key(problem->key), problem->remedy);
    }
    constexpr double kNarrowest = 10 * kDegree, kWidest = 170 * kDegree;
    if (!(camera_.max_field_of_view >= kNarrowest && camera_.max_field_of_view <= kWidest)) {
      reject_key("the field of view is out of range", key("field_of_view"),
                 "give 10 to 170 degrees");
    }
    check(key("delay"), camera_.delay, -1, 1);
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
  DriveKeys(const std::vector<std::string>& camera_names, std::filesystem::path drive_folder)
      : drive_folder_(std::move(drive_folder)),
        cameras_(camera_names.begin(), camera_names.end()) {}

  void visit(SettingVisitor& visit) {
    visit("version", version_);
    visit("lidar.folder", scans_);
    visit("lidar.compensated", drive_.sweep_compensated);
    visit("lidar.sweep_period_s", drive_.sweep.period);
    visit("lidar.rotation", drive_.sweep.direction);
    visit("lidar.sweep_start_deg", sweep_start_deg_);
    visit("lidar.stamp_phase", drive_.sweep.stamp_phase);
    visit("lidar.intensity_max", drive_.scan_format.intensity_max);
    visit("lidar.length_unit", length_unit_);
    visit("lidar.time_unit", time_unit_);
    visit("lidar.time_reference", time_reference_);
    visit("images.tolerance", drive_.image_tolerance);
    T_body_lidar_.visit(visit);
    T_body_imu_.visit(visit);
    visit("body.antenna", antenna_);
    for (CameraKeys& camera : cameras_) camera.visit(visit);
  }

  /// ConfigError whose place is the key.
  void finish() {
    if (!version_) reject_key("a key is missing", "version", "write version = 1 above all tables");
    if (*version_ != kVersion) {
      reject_key(
          fmt::format("the drive has version {}, this program reads {}", *version_, kVersion),
          "version", "use a newer Fovea");
    }
    drive_.scans = scans_;
    finish_scan_format();
    finish_sweep();
    check("images.tolerance", drive_.image_tolerance, 0, 1);
    drive_.T_body_lidar = T_body_lidar_.motion().value_or(drive_.T_body_lidar);
    drive_.T_body_imu = T_body_imu_.motion().value_or(drive_.T_body_imu);
    if (antenna_.size() != 3) {
      reject_key(fmt::format("there are {} numbers, not 3", antenna_.size()), "body.antenna",
                 "give x, y, z in meters");
    }
    drive_.antenna_body = Eigen::Map<const Eigen::Vector3d>(antenna_.data());
    check_lever("body.antenna", drive_.antenna_body);
    read_cameras();
  }

  DriveDescription take() { return std::move(drive_); }

 private:
  void finish_scan_format() {
    StatedScanFormat& format = drive_.scan_format;
    check("lidar.intensity_max", format.intensity_max.value_or(1), 1e-6, 1e9);
    constexpr std::array<double, 5> kTimeUnits = {0, 1, 1e-3, 1e-6, 1e-9};
    constexpr std::array<double, 4> kLengthUnits = {0, 1, 1e-2, 1e-3};
    constexpr std::array<TimeReference, 5> kReferences = {
        TimeReference::kStamp, TimeReference::kStamp, TimeReference::kAbsolute,
        TimeReference::kFirstPoint, TimeReference::kNone};
    const auto stated = [](const auto& values, auto choice, auto& value) {
      if (choice != decltype(choice){}) value = values.at(static_cast<std::size_t>(choice));
    };
    stated(kTimeUnits, time_unit_, format.time_unit);
    stated(kLengthUnits, length_unit_, format.length_unit);
    stated(kReferences, time_reference_, format.time_reference);
  }

  void finish_sweep() {
    SweepDescription& sweep = drive_.sweep;
    check("lidar.sweep_period_s", sweep.period.value_or(0.1), 0.01, 1);
    check("lidar.sweep_start_deg", sweep_start_deg_.value_or(0), -360, 360);
    check("lidar.stamp_phase", sweep.stamp_phase.value_or(0), 0, 1);
    if (sweep_start_deg_) sweep.start_azimuth = *sweep_start_deg_ * kDegree;
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
  std::string scans_ = "lidar";
  std::optional<double> sweep_start_deg_;
  TimeUnit time_unit_ = TimeUnit::kAuto;
  LengthUnit length_unit_ = LengthUnit::kAuto;
  ReferenceKey time_reference_ = ReferenceKey::kAuto;
  MotionKeys T_body_lidar_{"body", "body", "lidar"}, T_body_imu_{"body", "body", "imu"};
  std::vector<double> antenna_{0, 0, 0};
  std::vector<CameraKeys> cameras_;
};

DriveDescription read(const SettingsDocument& document, const std::filesystem::path& drive_folder) {
  DriveKeys keys(document.tables("camera"), drive_folder);
  document.apply([&](SettingVisitor& visit) { keys.visit(visit); }, [&] { keys.finish(); },
                 "see docs/drives.md for the keys");
  return keys.take();
}

}  // namespace

DriveDescription read_drive_description(const std::filesystem::path& file) {
  return read(SettingsDocument::from_file(file), file.parent_path());
}

DriveDescription parse_drive_description(std::string_view text, std::string_view name) {
  return read(SettingsDocument::from_text(text, name), {});
}

}  // namespace fovea
