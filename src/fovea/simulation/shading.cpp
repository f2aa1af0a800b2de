#include "fovea/simulation/shading.h"

#include <cmath>

namespace fovea {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

const Vector3f kSunColor(1.0f, 0.95f, 0.86f), kSkyColor(0.80f, 0.93f, 1.12f);
const Vector3f kZenith(0.22f, 0.40f, 0.78f), kHaze(0.72f, 0.80f, 0.90f),
    kFarGround(0.26f, 0.27f, 0.25f);
constexpr double kOffSurface = 1e-3;  // m: a ray that leaves a surface must not meet it again

}  // namespace

Shader::Shader(const RayCaster& caster, const LightOptions& options)
    : caster_(caster), options_(options) {
  const double level = std::cos(options.sun_elevation);
  to_sun_ = {level * std::sin(options.sun_azimuth), level * std::cos(options.sun_azimuth),
             std::sin(options.sun_elevation)};  // x east, y north
}

Vector3f Shader::sky(const Vector3d& along) const {
  const auto up = static_cast<float>(along.z());
  const auto level = static_cast<float>(options_.sky / 0.4);
  if (up < 0) return level * kFarGround;
  const float share = std::pow(1 - up, 4.0f);
  Vector3f color = (1 - share) * kZenith + share * kHaze;
  const auto sun = static_cast<float>(std::max(along.dot(to_sun_), 0.0));
  color +=
      Vector3f::Constant(0.35f * std::pow(sun, 24.0f)) + kSunColor * (sun > 0.9998f ? 30.0f : 0.0f);
  return level * color;
}

auto Shader::matte_light(const RayCaster::Moment& moment, const Packet<std::optional<RayHit>>& hits,
                         const Packet<double>& footprint) const -> Packet<SeenLight> {
  Packet<Vector3d> from;
  Packet<bool> faces_sun{};
  for (std::size_t i = 0; i < hits.size(); ++i) {
    from[i] =
        hits[i] ? Vector3d(hits[i]->position + kOffSurface * hits[i]->normal) : Vector3d::Zero();
    faces_sun[i] = hits[i] && hits[i]->normal.dot(to_sun_) > 0;
  }
  const Packet<bool> shadow =
      caster_.blocked(moment, from, faces_sun, to_sun_, kOffSurface, kHorizon);
  Packet<SeenLight> light;
  for (std::size_t i = 0; i < hits.size(); ++i) {
    if (!hits[i]) continue;
    // A hemisphere of sky above, ground that throws a third of it back below.
    const auto up = static_cast<float>(0.5 + 0.5 * hits[i]->normal.z());
    Vector3f irradiance =
        static_cast<float>(options_.sky) * (up * kSkyColor + (1 - up) * Vector3f::Constant(0.38f));
    light[i].sunlit = faces_sun[i] && !shadow[i];
    if (light[i].sunlit) {
      irradiance += static_cast<float>(options_.sun * hits[i]->normal.dot(to_sun_)) * kSunColor;
    }
    const Material& material = caster_.scenery().palette().materials[hits[i]->material];
    light[i].color = albedo(material, hits[i]->texture, static_cast<float>(footprint[i]))
                         .cwiseProduct(irradiance);
  }
  return light;
}

Vector3f Shader::reflection(const RayCaster::Moment& moment, const RayHit& hit,
                            const Vector3d& along, double footprint) const {
  const Vector3d mirrored = along - 2 * along.dot(hit.normal) * hit.normal;
  const Vector3d from = hit.position + kOffSurface * hit.normal;
  const auto seen = caster_.cast(moment, from, mirrored, kOffSurface, kHorizon);
  // What a mirror shows is itself drawn as matte: one bounce is what is seen.
  return seen ? matte_light(moment, {seen}, {2 * footprint})[0].color : sky(mirrored);
}

auto Shader::light(const RayCaster::Moment& moment, const Packet<std::optional<RayHit>>& hits,
                   const Packet<Vector3d>& along, const Packet<double>& footprint) const
    -> Packet<SeenLight> {
  Packet<SeenLight> light = matte_light(moment, hits, footprint);
  for (std::size_t i = 0; i < hits.size(); ++i) {
    if (!hits[i]) {
      light[i].color = sky(along[i]);
      continue;
    }
    const Material& material = caster_.scenery().palette().materials[hits[i]->material];
    if (material.gloss <= 0 || !options_.reflections) continue;
    // Schlick's approximation of Fresnel's law.
    const auto grazing = static_cast<float>(1 - std::min(1.0, -along[i].dot(hits[i]->normal)));
    const float share = material.gloss + (1 - material.gloss) * std::pow(grazing, 5.0f);
    light[i].color =
        (1 - share) * light[i].color + share * reflection(moment, *hits[i], along[i], footprint[i]);
  }
  return light;
}

}  // namespace fovea
