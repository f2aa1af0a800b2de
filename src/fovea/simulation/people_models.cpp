#include <cmath>
#include <numbers>

#include "fovea/simulation/mesh_builder.h"
#include "fovea/simulation/models.h"

namespace fovea {
namespace {

using Eigen::Vector3d;

/// Trunk, arms and head above the hips, leaning forward by `lean` (m at the shoulders).
void add_upper_body(MeshBuilder& make, const Palette& palette, const Vector3d& hips, double lean,
                    const Vector3d& hands) {
  const Vector3d shoulders = hips + Vector3d(lean, 0, 0.52);
  make.material = Palette::kPaint;
  make.bar(hips, shoulders, 0.16, 0.20, 12);
  make.ball(shoulders, {0.14, 0.23, 0.10}, 12);
  for (const double side : {-1.0, 1.0}) {
    const Vector3d shoulder = shoulders + Vector3d(0, side * 0.22, 0);
    make.material = Palette::kPaint;
    make.bar(shoulder, hips + Vector3d(hands.x(), side * hands.y(), hands.z()), 0.06, 0.045, 8);
    make.material = palette.skin;
    make.ball(hips + Vector3d(hands.x(), side * hands.y(), hands.z()), {0.05, 0.04, 0.06}, 8);
  }
  make.material = palette.skin;
  make.bar(shoulders, shoulders + Vector3d(0.02, 0, 0.18), 0.06, 0.06, 8);
  make.ball(shoulders + Vector3d(0.03, 0, 0.28), {0.10, 0.08, 0.13}, 12);
  make.material = palette.hair;
  make.ball(shoulders + Vector3d(0.0, 0, 0.33), {0.11, 0.09, 0.10}, 12);
}

void add_leg(MeshBuilder& make, const Palette& palette, const Vector3d& hip, const Vector3d& knee,
             const Vector3d& foot) {
  make.material = palette.trousers;
  make.bar(hip, knee, 0.09, 0.07, 8);
  make.bar(knee, foot, 0.065, 0.05, 8);
  make.material = palette.rubber;
  make.box(foot + Vector3d(-0.08, -0.05, -0.06), foot + Vector3d(0.18, 0.05, 0.02));
}

}  // namespace

Model make_pedestrian(const Palette& palette, int variant) {
  MeshBuilder make;
  const double stride = variant == 0 ? 0.05 : 0.26;  // one of them stands
  const Vector3d hips(0, 0, 0.92);
  add_leg(make, palette, hips + Vector3d(0, 0.10, 0), {0.6 * stride, 0.10, 0.48},
          {stride, 0.10, 0.06});
  add_leg(make, palette, hips + Vector3d(0, -0.10, 0), {-0.1 * stride, -0.10, 0.48},
          {-stride, -0.10, 0.06});
  add_upper_body(make, palette, hips, 0.03, {0.10, 0.28, 0.0});
  return {"pedestrian", make.take(), 2.0, "Pedestrian"};
}

Model make_cyclist(const Palette& palette, int /*variant*/) {
  MeshBuilder make;
  constexpr double kRadius = 0.34;
  constexpr int kPieces = 24;
  make.material = palette.rubber;
  for (const double x : {-0.52, 0.52}) {
    for (int k = 0; k < kPieces; ++k) {
      const double a = 2 * std::numbers::pi * k / kPieces,
                   b = 2 * std::numbers::pi * (k + 1) / kPieces;
      make.bar({x + kRadius * std::cos(a), 0, kRadius + 0.02 + kRadius * std::sin(a)},
               {x + kRadius * std::cos(b), 0, kRadius + 0.02 + kRadius * std::sin(b)}, 0.02, 0.02,
               5);
    }
  }
  make.material = palette.sign_red;
  const Vector3d crank(0, 0, 0.30), saddle(-0.18, 0, 0.92), head(0.40, 0, 0.88);
  make.bar(crank, saddle, 0.02, 0.02, 6);
  make.bar(crank, head, 0.02, 0.02, 6);
  make.bar(saddle - Vector3d(0, 0, 0.1), head, 0.02, 0.02, 6);
  make.bar(head + Vector3d(-0.02, 0, 0.12), {0.52, 0, 0.36}, 0.02, 0.02, 6);
  make.bar(crank, {-0.52, 0, 0.36}, 0.015, 0.015, 6);
  make.material = palette.dark_metal;
  make.box(saddle + Vector3d(-0.13, -0.07, 0), saddle + Vector3d(0.12, 0.07, 0.05));
  make.bar({0.40, -0.26, 1.02}, {0.40, 0.26, 1.02}, 0.015, 0.015, 6);
  const Vector3d hips(-0.16, 0, 1.02);
  add_leg(make, palette, hips + Vector3d(0, 0.10, 0), {0.22, 0.11, 0.80}, {0.05, 0.11, 0.42});
  add_leg(make, palette, hips + Vector3d(0, -0.10, 0), {0.16, -0.11, 0.62}, {-0.05, -0.11, 0.22});
  add_upper_body(make, palette, hips, 0.28, {0.56, 0.24, 0.03});
  return {"cyclist", make.take(), 2.2, "Cyclist"};
}

}  // namespace fovea
