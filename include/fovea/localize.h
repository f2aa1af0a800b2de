// Where scans were taken, in a map or a city that was made before.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <memory>
#include <optional>

#include "fovea/drive.h"
#include "fovea/rigid_motion.h"
#include "fovea/time.h"

namespace fovea {

enum class LocalizationState {
  kLocalized,
  kLost,     ///< the scan fits nowhere that was tried
  kOutside,  ///< the map has next to nothing where the scan should have been taken
  kSkipped   ///< there was no scan
};
/// "localized", "lost", "outside" or "skipped".
FOVEA_API const char* to_string(LocalizationState state);

/// Of one scan. Poses are T_local_lidar at the scan's stamp, `local` the map's.
struct Localization {
  int index = 0;
  std::optional<TimeNs> stamp;
  LocalizationState state = LocalizationState::kSkipped;
  RigidMotion T_local_lidar = RigidMotion::Identity();  ///< where kLocalized
  /// Of a twist of the LiDAR in its own frame, rotation first (rad^2, m^2), where kLocalized.
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
  /// Of what the scan has standing where the map has something, the share that lies on a surface of
  /// the map, times the share of the map's that the scan does not see through: 0 to 1. Where not
  /// localized, of the best that was tried.
  double health = 0;
  /// Not from the pose before: the first of all, after it was lost, or elsewhere than predicted.
  bool found = false;
  int degenerate_directions = 0;  ///< of six, that the scene leaves open: predicted, not measured
};

struct DriveLocalizerOptions {
  /// Navigation of the drive says about where scans were taken, if map and drive have coordinates.
  bool use_navigation = true;
  /// T_local_lidar of the first scan, some 4 m and 10 degrees off at most. Without either, the
  /// first scan is looked for along the map's drives.
  std::optional<RigidMotion> first = {};
};

/// Registers the scans of a drive to a map, one after the other.
///
///   DriveLocalizer localizer("street.fovea", drive);
///   const Localization place = localizer.localize(drive.load(0));
///   if (place.state == LocalizationState::kLocalized) use(place.T_local_lidar);
class FOVEA_API DriveLocalizer {
 public:
  /// @param map  a map file, or a city's folder
  /// @throws InputError  if the map is missing or damaged, or has no points
  DriveLocalizer(const std::filesystem::path& map, const Drive& drive,
                 const DriveLocalizerOptions& options = {});
  ~DriveLocalizer();
  DriveLocalizer(DriveLocalizer&&) noexcept;

  /// The drive's next scan.
  /// @throws InputError             if the map is damaged there
  /// @throws std::invalid_argument  for a frame of another drive
  Localization localize(const DriveFrame& frame);

 private:
  struct Content;
  std::unique_ptr<Content> content_;
};

}  // namespace fovea
