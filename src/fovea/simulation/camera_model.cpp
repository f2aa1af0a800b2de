#include "fovea/simulation/camera_model.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "fovea/core/parallel.h"
#include "fovea/core/random.h"
#include "fovea/world/material.h"

namespace fovea {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

/// Pixels whose samples differ by more than this (encoded, 0-255) are sampled again, finer.
constexpr float kEdge = 20;
// Samples along each side of a pixel, else and there: a packet is two coarse pixels or half a fine
// one.
constexpr int kCoarse = 2, kFine = 4;
static_assert(RayCaster::kPacket == std::size_t{2} * kCoarse * kCoarse);
/// Coarse samples from a pixel's centre: of the fine ones one in each row and column, so that an
/// upright or level edge that takes more than an eighth of the pixel does not pass unseen.
constexpr std::array<std::array<double, 2>, 4> kCoarsePlaces{
    {{-0.125, -0.375}, {0.375, -0.125}, {-0.375, 0.125}, {0.125, 0.375}}};
constexpr double kNear = 0.02;

// Kinds of random numbers.
constexpr std::uint64_t kNoise = 0xca3e5a, kExposure = 0xe59051, kWhiteBalance = 0x3ba1a;

/// Whether light differs by more than kEdge once it is encoded. sRGB is steepest in the dark, where
/// it is about 13 times linear: what differs less than that allows need not be encoded.
bool differ(const Vector3f& low, const Vector3f& high) {
  if ((high - low).maxCoeff() < kEdge / (255 * 12.92f)) return false;
  return (encode_srgb_float(high.cwiseMin(2.0f)) - encode_srgb_float(low.cwiseMin(2.0f)))
             .maxCoeff() > kEdge;
}

bool same_plane(const RayHit& a, const RayHit& b) {
  return a.surface == b.surface && a.material == b.material && a.normal == b.normal &&
         std::abs(a.normal.dot(a.position - b.position)) < 1e-6;
}

Vector3d direction(const LensCamera& camera, const RigidMotion& T_world_cam, double u, double v) {
  // The options are checked for lenses that reach all of the image.
  return (T_world_cam.linear() * camera.ray({u, v}).value()).normalized();
}

/// From 1 for the first camera to the options' ratio for the last, evenly in the logarithm.
double exposure_factor(const CameraOptions& options, int camera) {
  const auto place = std::find_if(options.cameras.begin(), options.cameras.end(),
                                  [&](const SimulatedCamera& c) { return c.number == camera; });
  if (place == options.cameras.end() || options.cameras.size() < 2) return 1;
  const auto last = static_cast<double>(options.cameras.size() - 1);
  return std::pow(options.exposure_ratio, double(place - options.cameras.begin()) / last);
}

}  // namespace

CameraModel::CameraModel(const RayCaster& caster, const Shader& shader, const LensCamera& camera)
    : caster_(caster), shader_(shader), camera_(camera) {}

CameraModel::CameraModel(const RayCaster& caster, const Shader& shader, const Camera& camera)
    : CameraModel(caster, shader,
                  LensCamera{camera.width, camera.height, camera.fx, camera.fy, camera.cx,
                             camera.cy, Lens()}) {}

/// What the samples of a pixel's square add up to.
class CameraModel::PixelSum {
 public:
  void add(const std::optional<RayHit>& hit, const SeenLight& light) {
    if (count_ == 0) {
      first_ = hit;
      first_sunlit_ = light.sunlit;
    }
    one_plane_ = one_plane_ && hit && same_plane(*hit, *first_);
    one_light_ = one_light_ && light.sunlit == first_sunlit_;
    low_ = low_.cwiseMin(light.color);
    high_ = high_.cwiseMax(light.color);
    sum_ += light.color;
    ++count_;
  }
  Vector3f mean() const { return sum_ / static_cast<float>(count_); }
  /// Whether more samples are needed. On one plane in one light only texture differs, and that is
  /// averaged over each sample already.
  bool edge() const { return !(one_plane_ && one_light_) && differ(low_, high_); }
  /// The plane that all of the square sees, where it is but one.
  const std::optional<RayHit>& plane() const { return one_plane_ ? first_ : nothing_; }

 private:
  int count_ = 0;
  bool one_plane_ = true, one_light_ = true, first_sunlit_ = false;
  std::optional<RayHit> first_, nothing_;
  Vector3f sum_ = Vector3f::Zero(), low_ = Vector3f::Constant(1e9f), high_ = -low_;
};

template <class Add>
void CameraModel::trace(const RayCaster::Packet<Eigen::Vector2d>& pixel, int n,
                        const RigidMotion& T_world_cam, const RayCaster::Moment& moment,
                        const Add& add) const {
  const double width = 1.0 / (camera_.fx * n);  // rad, of a sample's square
  RayCaster::Packet<Vector3d> along;
  for (std::size_t k = 0; k < along.size(); ++k) {
    along[k] = direction(camera_, T_world_cam, pixel[k].x(), pixel[k].y());
  }
  const auto hits = caster_.cast(moment, T_world_cam.translation(), along, kNear, Shader::kHorizon);
  RayCaster::Packet<double> footprint{};
  for (std::size_t k = 0; k < hits.size(); ++k) {
    if (!hits[k]) continue;
    // A grazing ray's square is drawn out; its mean width stands for it.
    const double facing = std::max(-along[k].dot(hits[k]->normal), 0.03);
    footprint[k] = hits[k]->distance * width / std::sqrt(facing);
  }
  const auto light = shader_.light(moment, hits, along, footprint);
  for (std::size_t k = 0; k < hits.size(); ++k) add(k, hits[k], light[k]);
}

auto CameraModel::sample_pair(double u, double v, const RigidMotion& T_world_cam,
                              const RayCaster::Moment& moment) const -> std::array<PixelSum, 2> {
  RayCaster::Packet<Eigen::Vector2d> places;
  for (std::size_t k = 0; k < places.size(); ++k) {
    const auto& [x, y] = kCoarsePlaces[k % 4];
    places[k] = {(k < 4 ? u : u + 1) + x, v + y};
  }
  std::array<PixelSum, 2> sums;
  trace(
      places, kCoarse, T_world_cam, moment,
      [&](std::size_t k, const auto& hit, const SeenLight& light) { sums[k / 4].add(hit, light); });
  return sums;
}

Vector3f CameraModel::sample_finely(double u, double v, const RigidMotion& T_world_cam,
                                    const RayCaster::Moment& moment) const {
  PixelSum sum;
  for (int half = 0; half < 2; ++half) {
    RayCaster::Packet<Eigen::Vector2d> places;
    for (std::size_t k = 0; k < places.size(); ++k) {
      places[k] = {u + (static_cast<double>(k % kFine) + 0.5) / kFine - 0.5,
                   v + (2 * half + (k < kFine ? 0.5 : 1.5)) / kFine - 0.5};
    }
    trace(places, kFine, T_world_cam, moment,
          [&](std::size_t, const auto& hit, const SeenLight& light) { sum.add(hit, light); });
  }
  return sum.mean();
}

Vector3f CameraModel::light_at(double u, double v, const RigidMotion& T_world_cam,
                               const RayCaster::Moment& moment) const {
  const PixelSum coarse = sample_pair(u, v, T_world_cam, moment)[0];
  return coarse.edge() ? sample_finely(u, v, T_world_cam, moment) : coarse.mean();
}

std::optional<RayHit> CameraModel::hit_at(double u, double v, const RigidMotion& T_world_cam,
                                          const RayCaster::Moment& moment) const {
  return caster_.cast(moment, T_world_cam.translation(), direction(camera_, T_world_cam, u, v),
                      kNear, Shader::kHorizon);
}

double CameraModel::depth_at(double u, double v, const RigidMotion& T_world_cam,
                             const RayCaster::Moment& moment) const {
  const auto hit = hit_at(u, v, T_world_cam, moment);
  return hit ? (T_world_cam.inverse() * hit->position).z() : 0.0;
}

double CameraModel::depth_of_plane(const RayHit& on_plane, double u, double v,
                                   const RigidMotion& T_world_cam) const {
  const Vector3d ray = camera_.ray({u, v}).value();
  const Vector3d normal = T_world_cam.linear().transpose() * on_plane.normal;
  return ray.z() * normal.dot(T_world_cam.inverse() * on_plane.position) / normal.dot(ray);
}

template <class ViewOfRow>
Rendering CameraModel::render_each_row(const ViewOfRow& view_of_row) const {
  const auto width = static_cast<std::size_t>(camera_.width),
             height = static_cast<std::size_t>(camera_.height);
  Rendering rendering{camera_.width, camera_.height, std::vector<Vector3f>(width * height),
                      std::vector<float>(width * height)};
  const auto finish_pixel = [&](std::size_t u, std::size_t v, const PixelSum& coarse,
                                const View& view) {
    const auto& [T_world_cam, moment] = view;
    const auto x = static_cast<double>(u), y = static_cast<double>(v);
    rendering.light[v * width + u] =
        coarse.edge() ? sample_finely(x, y, T_world_cam, moment) : coarse.mean();
    rendering.depth[v * width + u] =
        static_cast<float>(coarse.plane() ? depth_of_plane(*coarse.plane(), x, y, T_world_cam)
                                          : depth_at(x, y, T_world_cam, moment));
  };
  parallel_for(height, 4, [&](std::size_t v) {
    const View& view = view_of_row(v);
    for (std::size_t u = 0; u < width; u += 2) {
      const auto pair = sample_pair(static_cast<double>(u), static_cast<double>(v),
                                    view.T_world_cam, view.moment);
      for (std::size_t k = 0; k < 2 && u + k < width; ++k) finish_pixel(u + k, v, pair[k], view);
    }
  });
  return rendering;
}

Rendering CameraModel::render(const RigidMotion& T_world_cam,
                              const RayCaster::Moment& moment) const {
  const View view{T_world_cam, moment};
  return render_each_row([&](std::size_t) -> const View& { return view; });
}

Rendering CameraModel::render_rows(const std::function<View(double)>& view_of) const {
  const double last = std::max(1, camera_.height - 1);
  return render_each_row([&](std::size_t row) { return view_of(static_cast<double>(row) / last); });
}

Image develop(const Rendering& rendering, const Development& development) {
  Image image(rendering.width, rendering.height, development.grey ? 1 : 3);
  const Eigen::Vector2d last(rendering.width - 1, rendering.height - 1);
  const Eigen::Vector2d center =
      development.center.minCoeff() < 0 ? Eigen::Vector2d(0.5 * last) : development.center;
  const double corner2 = center.cwiseMax(last - center).squaredNorm();
  parallel_for(static_cast<std::size_t>(rendering.height), 8, [&](std::size_t row) {
    const int v = static_cast<int>(row);
    Random random = Random::of_item(development.seed, kNoise, row);
    for (int u = 0; u < rendering.width; ++u) {
      const double away2 = (Eigen::Vector2d(u, v) - center).squaredNorm();
      const double gain = development.exposure * (1 - development.vignetting * away2 / corner2);
      Vector3f light = rendering.light[row * static_cast<std::size_t>(rendering.width) +
                                       static_cast<std::size_t>(u)] *
                       static_cast<float>(gain);
      light = light.cwiseProduct(development.white_balance);
      if (development.grey) {
        light.setConstant(light.dot(Vector3f(0.299f, 0.587f, 0.114f)));
      }
      Vector3f color = encode_srgb_float(light.cwiseMin(1.0f));
      for (int c = 0; c < image.channels; ++c) {
        if (development.noise > 0) {
          // Shot noise grows with the light, read noise is always there.
          const double sigma = development.noise * std::sqrt(0.4 + 0.6 * color[c] / 127.5);
          color[c] += static_cast<float>(sigma * random.normal());
        }
        image.pixel(u, v)[c] =
            static_cast<std::uint8_t>(std::lround(std::clamp(color[c], 0.0f, 255.0f)));
      }
    }
  });
  return image;
}

double exposure_at(const CameraOptions& options, int camera, double time, int seed) {
  const double own_exposure = options.exposure * exposure_factor(options, camera);
  if (options.exposure_variation == 0) return own_exposure;
  Random random = Random::of_item(static_cast<std::uint64_t>(seed), kExposure, 100);
  const double a = random.uniform(0, 2 * std::numbers::pi),
               b = random.uniform(0, 2 * std::numbers::pi);
  const double swing = 0.65 * std::sin(2 * std::numbers::pi * time / 6.5 + a) +
                       0.35 * std::sin(2 * std::numbers::pi * time / 2.3 + b);
  Random own = Random::of_item(static_cast<std::uint64_t>(seed), kExposure,
                               static_cast<std::uint64_t>(camera));
  const double trim = 0.08 * own.uniform(-1, 1);
  return own_exposure * std::exp(options.exposure_variation * (swing + trim));
}

Vector3f white_balance_at(const CameraOptions& options, int camera, double time, int seed) {
  constexpr double kDuration = 4;  // s
  constexpr std::uint64_t kCameras = 16;
  const auto step = static_cast<std::int64_t>(std::floor(time / kDuration));
  Random random = Random::of_item(
      static_cast<std::uint64_t>(seed), kWhiteBalance,
      static_cast<std::uint64_t>(step) * kCameras + static_cast<std::uint64_t>(camera));
  const double red = options.white_balance_step * random.normal();
  const double blue = options.white_balance_step * random.normal();
  return {static_cast<float>(std::exp(red)), 1, static_cast<float>(std::exp(blue))};
}

}  // namespace fovea
