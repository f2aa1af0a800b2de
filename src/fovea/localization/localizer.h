// Where a scan was taken, in a map made before (docs/localization.md).
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "fovea/drive/frame_source.h"
#include "fovea/localization/place_candidates.h"
#include "fovea/localization/prior_map.h"
#include "fovea/localization/surface_source.h"
#include "fovea/localize.h"
#include "fovea/map/map_store.h"
#include "fovea/mapping/range_image.h"
#include "fovea/pipeline/motion_model.h"

namespace fovea {

/// What is known of where the vehicle is before any scan is looked at.
struct LocalizationGuess {
  /// T_local_lidar in the map's frame over time, good to a few metres (navigation), and better from
  /// one scan to the next; or nothing.
  std::optional<Trajectory> trajectory;
  /// Where the first scan may have been taken, some 4 m and 10 degrees off at most. Without
  /// either, all places of the map are tried, the first ones first.
  std::optional<RigidMotion> first;
};

struct LocalizerOptions {
  bool compensate_motion = true;
  /// With normals, not point to point.
  RegistrationOptions registration{.max_distance = 0.5, .robust_width = 0.1};
  void validate() const;  ///< ConfigError that names the field
};

/// Registers one scan after the other to the map. A scan is registered from where navigation or
/// constant velocity predict it; one that fits badly there is looked for around the prediction, and
/// then along the map's drives, a few places a scan, the nearest first. The map is read as far as
/// the vehicle comes.
class Localizer {
 public:
  /// @param source  of a map or a city
  /// @param drive   must outlive this
  /// @throws InputError   if the map or the city is damaged
  /// @throws ConfigError  as LocalizerOptions::validate
  Localizer(std::unique_ptr<SurfaceSource> source, const DriveInfo& drive, LocalizationGuess guess,
            const LocalizerOptions& options = {});
  /// In a map, see map_surface_source().
  Localizer(const MapReader& map, const DriveInfo& drive, LocalizationGuess guess,
            const LocalizerOptions& options = {});
  Localizer(const Localizer&) = delete;
  Localizer& operator=(const Localizer&) = delete;

  /// Continues the trajectory of the guess, for a drive whose navigation comes with its frames.
  /// Forgets navigation of more than a minute before the last pose, or ten minutes if there is no
  /// pose that long.
  /// @param T_local_lidar  later than the poses before, in the map's frame
  /// @throws std::invalid_argument  if the guess has no trajectory
  void add_navigation(const std::vector<StampedPose>& T_local_lidar);

  /// The next scan of the drive. InputError if the map is damaged where it is looked at,
  /// std::invalid_argument if the scan is not later than the one before.
  Localization localize(const Frame& frame);

 private:
  /// A scan registered somewhere.
  struct Attempt {
    RegistrationResult registration;  // T_target_source: T_local_lidar
    double health = 0;
    bool covered = false;  // the map has something there
    bool fits = false;
    bool elsewhere = false;  // than where it was predicted

    bool better_than(const Attempt& other) const {
      return std::pair(fits, health) > std::pair(other.fits, other.health);
    }
  };
  /// A scan without the sweep's motion, LiDAR frame.
  struct Scan {
    std::vector<Eigen::Vector3f> points;  // near ones, thinned
    RangeImage image;                     // of all
  };
  Scan prepare(const Frame& frame, const std::optional<SweepMotion>& motion) const;
  /// The points of a scan where the map has something; none if these are too few to tell anything.
  RegistrationCloud covered(const Scan& scan, const PriorMap::Target& target,
                            const RigidMotion& T_target_lidar, double height) const;
  /// How far the map contradicts a scan at a pose, 0 to 1.
  double contradiction(const Scan& scan, const PriorMap::Target& target,
                       const RegistrationResult& result) const;
  MotionModel new_motion_model() const;
  Attempt follow(const Scan& scan, const RigidMotion& guess_T_local_lidar);
  Attempt look_around(const Scan& scan, const RigidMotion& guess_T_local_lidar);
  RigidMotion register_coarsely(const Scan& scan, const RigidMotion& guess);
  Attempt track(const Frame& frame, const MotionPrediction& motion);
  Attempt search(const Frame& frame, const MotionPrediction& motion, bool placed);
  Attempt compensated(const Frame& frame, const Attempt& found);
  void accept(const Attempt& attempt, Localization& result);

  const DriveInfo& drive_;
  LocalizerOptions options_;
  std::unique_ptr<SurfaceSource> source_;
  LocalizationGuess guess_;
  MotionModel motion_model_;
  PriorMap prior_;
  PlaceCandidates candidates_;       // added when they are needed
  std::optional<StampedPose> last_;  // localized
  std::optional<TimeNs> latest_;     // scan, localized or not
  bool tracking_ = false;
  int open_frames_ = 0;  // in a row whose scene left a direction open
};

}  // namespace fovea
