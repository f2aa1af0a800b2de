// Keys of drive.toml that state a rigid motion.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "fovea/core/settings.h"
#include "fovea/rigid_motion.h"

namespace fovea {

/// @throws ConfigError  whose place is the key
[[noreturn]] void reject_key(std::string_view problem, const std::string& key,
                             std::string_view remedy);

/// Rejects a value outside of [low, high], and NaN.
void check_key(const std::string& key, double value, double low, double high);

/// Rejects a distance that no vehicle has, and NaN.
void check_lever(const std::string& key, const Eigen::Vector3d& t);

/// A rigid motion as a matrix or as translation and quaternion.
struct MotionText {
  std::string key;
  std::optional<std::vector<double>> matrix{}, translation{}, rotation{};

  void visit(SettingVisitor& visit);
  bool given() const { return matrix || translation || rotation; }
  RigidMotion motion() const;
};

/// A motion that the file states as T_a_b or as T_b_a.
struct MotionKeys {
  MotionText forward, backward;
  MotionKeys(const std::string& table, const std::string& a, const std::string& b)
      : forward{.key = table + ".T_" + a + "_" + b}, backward{.key = table + ".T_" + b + "_" + a} {}

  void visit(SettingVisitor& visitor);
  /// T_a_b; empty if the file states neither.
  std::optional<RigidMotion> motion() const;
};

}  // namespace fovea
