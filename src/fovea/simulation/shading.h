// Light: a sun with hard shadows, a sky, and mirrors.
#pragma once

#include "fovea/simulation/ray_caster.h"

namespace fovea {

/// Light that comes along a ray.
struct SeenLight {
  Eigen::Vector3f color = Eigen::Vector3f::Zero();  ///< linear RGB, 1 is full scale at exposure 1
  bool sunlit = false;                              ///< the sun shines on what is seen
};

class Shader {
 public:
  Shader(const RayCaster& caster, const LightOptions& options);

  template <class T>
  using Packet = RayCaster::Packet<T>;

  /// @param hits       what the rays meet, or nothing: the sky
  /// @param footprint  width of each ray where it meets it (m): finer texture is averaged
  Packet<SeenLight> light(const RayCaster::Moment& moment,
                          const Packet<std::optional<RayHit>>& hits,
                          const Packet<Eigen::Vector3d>& along,
                          const Packet<double>& footprint) const;
  Eigen::Vector3f sky(const Eigen::Vector3d& along) const;

  /// Nothing is seen beyond (m).
  static constexpr double kHorizon = 400;

 private:
  /// Sun and sky on matte surfaces, without reflections: albedo times irradiance; black for no
  /// surface.
  Packet<SeenLight> matte_light(const RayCaster::Moment& moment,
                                const Packet<std::optional<RayHit>>& hits,
                                const Packet<double>& footprint) const;
  Eigen::Vector3f reflection(const RayCaster::Moment& moment, const RayHit& hit,
                             const Eigen::Vector3d& along, double footprint) const;

  const RayCaster& caster_;
  LightOptions options_;
  Eigen::Vector3d to_sun_;
};

}  // namespace fovea
