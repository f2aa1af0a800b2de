// Cameras: what a perfect one sees, and what a real one makes of it.
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "fovea/camera.h"
#include "fovea/geometry/lens.h"
#include "fovea/image.h"
#include "fovea/simulation/shading.h"

namespace fovea {

/// What a perfect camera sees.
struct Rendering {
  int width = 0, height = 0;
  std::vector<Eigen::Vector3f> light;  ///< linear RGB, mean over each pixel's square
  std::vector<float> depth;            ///< z of the surface at each pixel's centre (m), 0 for sky
};

class CameraModel {
 public:
  /// Keeps references. Every ray through the image, half a pixel round it included, must be there.
  CameraModel(const RayCaster& caster, const Shader& shader, const LensCamera& camera);
  /// A camera without distortion.
  CameraModel(const RayCaster& caster, const Shader& shader, const Camera& camera);

  Rendering render(const RigidMotion& T_world_cam, const RayCaster::Moment& moment) const;

  /// Where the camera is and what moves at one time.
  struct View {
    RigidMotion T_world_cam = RigidMotion::Identity();
    RayCaster::Moment moment;
  };
  /// A rolling shutter: each row is taken at its own time.
  /// @param view_of  of a row, by its place: 0 is the first row, 1 the last. Called from several
  ///                 threads
  Rendering render_rows(const std::function<View(double)>& view_of) const;

  /// Mean light over the square of one pixel's size round (u, v), anywhere in the image.
  Eigen::Vector3f light_at(double u, double v, const RigidMotion& T_world_cam,
                           const RayCaster::Moment& moment) const;
  /// What the ray through (u, v) meets.
  std::optional<RayHit> hit_at(double u, double v, const RigidMotion& T_world_cam,
                               const RayCaster::Moment& moment) const;

 private:
  class PixelSum;

  /// @param view_of_row  of the row of that number
  template <class ViewOfRow>
  Rendering render_each_row(const ViewOfRow& view_of_row) const;
  /// Casts and shades rays through `pixel`, of which n lie along a pixel's side; add(k, hit,
  /// light).
  template <class Add>
  void trace(const RayCaster::Packet<Eigen::Vector2d>& pixel, int n, const RigidMotion& T_world_cam,
             const RayCaster::Moment& moment, const Add& add) const;
  /// Samples of the pixel (u, v) and of its right neighbour.
  std::array<PixelSum, 2> sample_pair(double u, double v, const RigidMotion& T_world_cam,
                                      const RayCaster::Moment& moment) const;
  Eigen::Vector3f sample_finely(double u, double v, const RigidMotion& T_world_cam,
                                const RayCaster::Moment& moment) const;
  double depth_at(double u, double v, const RigidMotion& T_world_cam,
                  const RayCaster::Moment& moment) const;
  double depth_of_plane(const RayHit& on_plane, double u, double v,
                        const RigidMotion& T_world_cam) const;

  const RayCaster& caster_;
  const Shader& shader_;
  LensCamera camera_;
};

/// How much of the light an image takes.
struct ImageLight {
  double exposure;
  Eigen::Vector3f white_balance;
};

/// How light becomes numbers in one image.
struct Development {
  double exposure = 1;                                      ///< factor on linear light
  Eigen::Vector3f white_balance = Eigen::Vector3f::Ones();  ///< factors on linear red, green, blue
  double vignetting = 0;                                    ///< light lost in the farthest corner
  Eigen::Vector2d center = {-1, -1};  ///< optical axis, pixels; negative: the middle
  double noise = 0;                   ///< grey levels at half light
  bool grey = false;
  std::uint64_t seed = 0;  ///< of this image's noise
};
Image develop(const Rendering& rendering, const Development& development);

/// Exposure of an image: a smooth function of time, a little different for each camera.
double exposure_at(const CameraOptions& options, int camera, double time, int seed);
/// Factors on linear red, green and blue: constant for four seconds, then others.
Eigen::Vector3f white_balance_at(const CameraOptions& options, int camera, double time, int seed);
inline ImageLight image_light_at(const CameraOptions& options, int camera, double time, int seed) {
  return {exposure_at(options, camera, time, seed), white_balance_at(options, camera, time, seed)};
}

}  // namespace fovea
