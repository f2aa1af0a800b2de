#include "fovea/evaluation/truth_ghosts.h"

#include <unordered_map>

#include "fovea/core/parallel.h"
#include "fovea/geometry/kd_tree.h"

namespace fovea {
namespace {

constexpr float kReach = 0.5f;  // m

/// Whether a moving hit is the nearest of all. The few moving ones are asked first: most points are
/// far from all of them.
class GhostTest {
 public:
  explicit GhostTest(const std::vector<TrueReturn>& returns)
      : moving_hits_(hits(returns, true)),
        static_hits_(moving_hits_.empty() ? std::vector<Eigen::Vector3f>() : hits(returns, false)),
        moving_(moving_hits_),
        static_(static_hits_) {}

  bool any_moving() const { return !moving_hits_.empty(); }

  bool is_ghost(const Eigen::Vector3f& p_lidar) const {
    const float to_moving = moving_.nearest(p_lidar, kReach).squared_distance;
    if (!(to_moving <= kReach * kReach)) return false;
    return static_hits_.empty() || to_moving < static_.nearest(p_lidar, kReach).squared_distance;
  }

 private:
  static std::vector<Eigen::Vector3f> hits(const std::vector<TrueReturn>& returns, bool moving) {
    std::vector<Eigen::Vector3f> chosen;
    for (const TrueReturn& r : returns) {
      if (r.moving == moving) chosen.push_back(r.hit_lidar);
    }
    return chosen;
  }

  std::vector<Eigen::Vector3f> moving_hits_, static_hits_;
  KdTree moving_, static_;
};

}  // namespace

std::vector<std::uint8_t> find_ghosts(const PointCloud& points_map,
                                      const std::vector<PosePair>& frames,
                                      const DriveTruth& truth) {
  std::unordered_map<int, std::size_t> place_of_frame;
  for (std::size_t i = 0; i < frames.size(); ++i) place_of_frame[frames[i].frame] = i;
  std::vector<std::vector<std::uint32_t>> points_of(frames.size());
  for (std::uint32_t p = 0; p < points_map.size(); ++p) {
    const auto place = place_of_frame.find(points_map.frame[p]);
    if (place != place_of_frame.end()) points_of[place->second].push_back(p);
  }
  std::vector<std::uint8_t> ghosts(points_map.size(), 0);
  parallel_for(frames.size(), 1, [&](std::size_t i) {
    if (points_of[i].empty()) return;
    const GhostTest test(truth.returns(frames[i].frame));
    if (!test.any_moving()) return;
    const RigidMotion T_lidar_map = frames[i].T_map_lidar.inverse();
    for (const std::uint32_t p : points_of[i]) {
      const Eigen::Vector3d p_map = points_map.origin + points_map.position[p].cast<double>();
      ghosts[p] = test.is_ghost((T_lidar_map * p_map).cast<float>()) ? 1 : 0;
    }
  });
  return ghosts;
}

}  // namespace fovea
