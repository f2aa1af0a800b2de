#include "fovea/drive/drive_correction.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <utility>

#include "fovea/drive/drive_description.h"
#include "fovea/drive/motion_keys.h"
#include "fovea/errors.h"

namespace fovea {
namespace {

constexpr const char* kTable = "calibrated";
constexpr double kMaxAddedDelay = 1;  // s

/// The keys of a sensor: its place and what is added to its delay.
class SensorKeys {
 public:
  /// @param a, b  the place is T_a_b
  SensorKeys(std::string table, const std::string& a, const std::string& b)
      : table_(std::move(table)), T_a_b_(table_, a, b), delay_key_(table_ + ".added_delay") {}

  void visit(SettingVisitor& visit) {
    T_a_b_.visit(visit);
    visit(delay_key_, added_delay_);
  }
  /// T_a_b. ConfigError whose place is the key.
  RigidMotion place() const {
    const auto T_a_b = T_a_b_.motion();
    if (!T_a_b) reject_key("a key is missing", T_a_b_.forward.key, "say where the sensor sits");
    return *T_a_b;
  }
  /// s
  double added_delay() const {
    check_key(delay_key_, added_delay_, -kMaxAddedDelay, kMaxAddedDelay);
    return added_delay_;
  }
  const std::string& table() const { return table_; }

 private:
  std::string table_;
  MotionKeys T_a_b_;
  std::string delay_key_;
  double added_delay_ = 0;
};

/// All keys of a calibrated drive.
class CalibratedDriveKeys {
 public:
  /// @param cameras  names of the tables below [calibrated.camera]
  explicit CalibratedDriveKeys(std::vector<std::string> cameras) : names_(std::move(cameras)) {
    for (const std::string& name : names_) {
      cameras_.emplace_back(fmt::format("{}.camera.{}", kTable, name), "cam", "lidar");
    }
  }

  void visit(SettingVisitor& visit) {
    visit("version", version_);
    visit(drive_key_, drive_);
    has_imu_ = visit.is_given(imu_.table());
    imu_.visit(visit);
    for (SensorKeys& camera : cameras_) camera.visit(visit);
  }

  /// ConfigError whose place is the key.
  CalibratedDrive drive() const {
    check_drive_version(version_);
    if (drive_.empty()) {
      reject_key("the folder of the drive is missing", drive_key_,
                 "name it, relative to this file or absolute");
    }
    CalibratedDrive result{drive_, {}};
    for (std::size_t k = 0; k < names_.size(); ++k) {
      const SensorKeys& keys = cameras_[k];
      result.correction.cameras.push_back({camera_number(k), keys.place(), keys.added_delay()});
    }
    if (has_imu_) result.correction.imu = {imu_.place(), imu_.added_delay()};
    return result;
  }

 private:
  int camera_number(std::size_t k) const {
    const std::string& name = names_[k];
    static_assert(kMaxCameraIndex == 9, "a number has one digit");
    if (name.size() == 1 && name[0] >= '0' && name[0] <= '9') return name[0] - '0';
    reject_key(
        fmt::format("'{}' is no number of a camera", name), cameras_[k].table(),
        fmt::format("give a number of 0 to {}: the camera's index in the drive", kMaxCameraIndex));
  }

  std::string drive_key_ = fmt::format("{}.drive", kTable);
  std::optional<int> version_;
  std::string drive_;
  bool has_imu_ = false;
  SensorKeys imu_{fmt::format("{}.imu", kTable), "lidar", "imu"};
  std::vector<std::string> names_;
  std::vector<SensorKeys> cameras_;  // by place in names_
};

/// [[...], [...], [...]]
std::string motion_text(const RigidMotion& T) {
  std::array<std::string, 3> rows;
  for (int row = 0; row < 3; ++row) {
    std::array<std::string, 4> numbers;
    for (int column = 0; column < 4; ++column) {
      numbers[std::size_t(column)] = number_text(T(row, column));
    }
    rows[std::size_t(row)] = fmt::format("[{}]", fmt::join(numbers, ", "));
  }
  return fmt::format("[{}]", fmt::join(rows, ", "));
}

std::string delay_text(double added_delay) {
  return fmt::format("added_delay = {}\n", number_text(added_delay));
}

/// A path as a string of TOML.
std::string path_text(const std::filesystem::path& path) {
  std::string text;
  for (const char c : path.string()) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      text += {'\\', c};
    } else if (byte < 0x20 || byte == 0x7F) {
      text += fmt::format("\\u{:04X}", byte);
    } else {
      text += c;
    }
  }
  text = fmt::format("\"{}\"", text);
  try {
    SettingsDocument::from_text("drive = " + text, path.string());
  } catch (const ConfigError&) {
    throw InputError("the name of the drive's folder is no UTF-8, which drive.toml needs",
                     path.string(), "rename the folder");
  }
  return text;
}

}  // namespace

bool is_calibrated_drive(const SettingsDocument& document) { return document.has(kTable); }

CalibratedDrive parse_calibrated_drive(const SettingsDocument& document) {
  CalibratedDriveKeys keys(document.tables(fmt::format("{}.camera", kTable)));
  CalibratedDrive drive;
  document.apply([&](SettingVisitor& visit) { keys.visit(visit); }, [&] { drive = keys.drive(); },
                 "see \"A calibrated drive\" in docs/drives.md for the keys");
  return drive;
}

std::string calibrated_drive_text(const CalibratedDrive& drive) {
  std::string text =
      fmt::format("version = 1\n\n[{}]\ndrive = {}\n", kTable, path_text(drive.drive));
  for (const DriveCorrection::CorrectedCamera& camera : drive.correction.cameras) {
    text += fmt::format("\n[{}.camera.{}]\nT_cam_lidar = {}\n{}", kTable, camera.camera,
                        motion_text(camera.T_cam_lidar), delay_text(camera.added_delay));
  }
  if (const auto& imu = drive.correction.imu) {
    text += fmt::format("\n[{}.imu]\nT_lidar_imu = {}\n{}", kTable, motion_text(imu->T_lidar_imu),
                        delay_text(imu->added_delay));
  }
  return text;
}

}  // namespace fovea
