#include "fovea/drive/lidar_keys.h"

#include <fmt/format.h>

#include <array>

#include "fovea/core/angle.h"
#include "fovea/geometry/sweep_direction_names.h"

namespace fovea {

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

LidarKeys::LidarKeys(const std::string& name)
    : table_(name.empty() ? "lidar" : "lidar." + name),
      folder_(name.empty() ? "lidar" : "lidar/" + name),
      T_lidar_sensor_(table_, "lidar", "sensor") {
  lidar_.name = name;
}

std::string LidarKeys::key(std::string_view name) const {
  return fmt::format("{}.{}", table_, name);
}

void LidarKeys::visit(SettingVisitor& visit) {
  visit(key("folder"), folder_);
  visit(key("compensated"), lidar_.sweep_compensated);
  visit(key("sweep_period_s"), lidar_.sweep.period);
  visit(key("rotation"), lidar_.sweep.direction);
  visit(key("sweep_start_deg"), sweep_start_deg_);
  visit(key("stamp_phase"), lidar_.sweep.stamp_phase);
  visit(key("intensity_max"), lidar_.scan_format.intensity_max);
  visit(key("length_unit"), length_unit_);
  visit(key("time_unit"), time_unit_);
  visit(key("time_reference"), time_reference_);
  if (!lidar_.name.empty()) T_lidar_sensor_.visit(visit);
}

LidarDescription LidarKeys::lidar() {
  lidar_.folder = folder_;
  lidar_.T_lidar_sensor = T_lidar_sensor_.motion().value_or(RigidMotion::Identity());
  finish_scan_format();
  finish_sweep();
  return lidar_;
}

void LidarKeys::finish_scan_format() {
  StatedScanFormat& format = lidar_.scan_format;
  check_key(key("intensity_max"), format.intensity_max.value_or(1), 1e-6, 1e9);
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

void LidarKeys::finish_sweep() {
  SweepDescription& sweep = lidar_.sweep;
  check_key(key("sweep_period_s"), sweep.period.value_or(0.1), 0.01, 1);
  check_key(key("sweep_start_deg"), sweep_start_deg_.value_or(0), -360, 360);
  check_key(key("stamp_phase"), sweep.stamp_phase.value_or(0), 0, 1);
  if (sweep_start_deg_) sweep.start_azimuth = *sweep_start_deg_ * kDegree;
}

}  // namespace fovea
