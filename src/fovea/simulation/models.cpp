#include "fovea/simulation/models.h"

#include <cmath>
#include <numbers>

#include "fovea/simulation/mesh_builder.h"

namespace fovea {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

/// A board that faces x, its lower edge's middle at `at`, lettered on both sides.
void add_board(MeshBuilder& make, const Vector3d& at, const Eigen::Vector2f& size) {
  const double half = 0.5 * size.x(), h = size.y(), thick = 0.01;
  const Vector3f t0(0, 0, 0), t1(size.x(), 0, 0), t2(size.x(), size.y(), 0), t3(0, size.y(), 0);
  for (const double side : {1.0, -1.0}) {
    const Vector3d left = at + Vector3d(side * thick, -side * half, 0),
                   right = at + Vector3d(side * thick, side * half, 0), up(0, 0, h);
    make.quad({left, right, right + up, left + up}, {t0, t1, t2, t3});
  }
}

Model make_lamp(const Palette& p) {
  MeshBuilder make;
  make.material = p.dark_metal;
  make.bar({0, 0, 0}, {0, 0, 0.9}, 0.09, 0.09, 12);
  make.bar({0, 0, 0.9}, {0, 0, 6.2}, 0.06, 0.045, 12);
  make.bar({0, 0, 6.15}, {0, 1.5, 6.5}, 0.035, 0.03, 8);
  make.box({-0.14, 1.3, 6.44}, {0.14, 1.9, 6.56});
  make.material = p.headlight;
  make.box({-0.10, 1.36, 6.41}, {0.10, 1.84, 6.44});
  return {"lamp post", make.take(), 7.2, {}};
}

Model make_bin(const Palette& p) {
  MeshBuilder make;
  make.material = Palette::kPaint;
  make.box({-0.28, -0.28, 0.06}, {0.28, 0.28, 1.02});
  make.material = p.dark_metal;
  make.box({-0.31, -0.31, 1.02}, {0.31, 0.31, 1.09});
  make.bar({-0.22, -0.33, 0.09}, {-0.22, 0.33, 0.09}, 0.08, 0.08, 10);
  return {"bin", make.take(), 1.3, {}};
}

Model make_bollard(const Palette& p) {
  MeshBuilder make;
  make.material = p.dark_metal;
  make.bar({0, 0, 0}, {0, 0, 0.9}, 0.06, 0.06, 10);
  make.material = p.headlight;
  make.bar({0, 0, 0.72}, {0, 0, 0.82}, 0.063, 0.063, 10);
  make.material = p.dark_metal;
  make.ball({0, 0, 0.92}, {0.075, 0.075, 0.07}, 10);
  return {"bollard", make.take(), 1.1, {}};
}

Model make_bench(const Palette& p) {
  MeshBuilder make;
  make.material = p.wood;
  for (int k = 0; k < 4; ++k)
    make.box({-0.9, -0.24 + 0.13 * k, 0.44}, {0.9, -0.14 + 0.13 * k, 0.48});
  for (int k = 0; k < 3; ++k) make.box({-0.9, 0.26, 0.56 + 0.13 * k}, {0.9, 0.30, 0.65 + 0.13 * k});
  make.material = p.dark_metal;
  for (const double x : {-0.75, 0.75}) {
    make.box({x - 0.03, -0.22, 0}, {x + 0.03, 0.28, 0.44});
    make.box({x - 0.03, 0.30, 0.2}, {x + 0.03, 0.34, 0.95});
  }
  return {"bench", make.take(), 1.5, {}};
}

Model make_hydrant(const Palette& p) {
  MeshBuilder make;
  make.material = p.sign_red;
  make.bar({0, 0, 0}, {0, 0, 0.6}, 0.12, 0.11, 12);
  make.ball({0, 0, 0.62}, {0.13, 0.13, 0.14}, 12);
  make.bar({-0.2, 0, 0.42}, {0.2, 0, 0.42}, 0.06, 0.06, 10);
  return {"hydrant", make.take(), 0.9, {}};
}

Model make_table(const Palette& p) {
  MeshBuilder make;
  make.material = p.metal;
  make.bar({0, 0, 0}, {0, 0, 0.72}, 0.03, 0.03, 8);
  make.material = p.wood;
  make.bar({0, 0, 0.72}, {0, 0, 0.75}, 0.38, 0.38, 16);
  for (const double x : {-0.7, 0.7}) {  // chairs
    make.box({x - 0.2, -0.2, 0.42}, {x + 0.2, 0.2, 0.46});
    const double back = x > 0 ? x + 0.18 : x - 0.18;
    make.box({back - 0.02, -0.2, 0.46}, {back + 0.02, 0.2, 0.86});
    for (const double dx : {-0.18, 0.18}) {
      for (const double y : {-0.18, 0.18})
        make.bar({x + dx, y, 0}, {x + dx, y, 0.42}, 0.015, 0.015, 5);
    }
  }
  return {"cafe table", make.take(), 1.4, {}};
}

Model make_planter(const Palette& p) {
  MeshBuilder make;
  make.material = p.wood;
  make.box({-0.6, -0.25, 0}, {0.6, 0.25, 0.45});
  Model planter{"planter", make.take(), 1.5, {}};
  for (const double x : {-0.3, 0.3}) {
    Eigen::Affine3d T(Eigen::Translation3d(x, 0, 0.4));
    T.scale(0.5);
    planter.mesh.append(make_bush(p, 1).mesh, T);
  }
  return planter;
}

/// A round sign with a red rim, and a street's name below it.
Model make_sign(const Palette& p, std::size_t name) {
  MeshBuilder make;
  make.material = p.metal;
  make.bar({0, 0, 0}, {0, 0, 2.75}, 0.03, 0.03, 10);
  make.material = p.sign_red;
  make.bar({0.03, 0, 2.45}, {0.045, 0, 2.45}, 0.30, 0.30, 24);
  make.material = p.headlight;
  make.bar({0.045, 0, 2.45}, {0.05, 0, 2.45}, 0.23, 0.23, 24);
  make.material = p.dark_metal;
  make.box({0.05, -0.16, 2.42}, {0.054, 0.16, 2.48});
  make.material = p.street_signs[name % p.street_signs.size()];
  add_board(make, {0.04, 0, 1.85}, kStreetSign);
  return {"sign", make.take(), 3.0, {}};
}

Model make_fence(const Palette& p) {
  MeshBuilder make;
  make.material = p.dark_metal;
  for (const double z : {0.15, 1.0}) make.box({0, -0.015, z}, {2, 0.015, z + 0.04});
  for (int k = 0; k < 14; ++k) {
    const double x = (k + 0.5) * 2.0 / 14;
    make.box({x - 0.008, -0.008, 0.05}, {x + 0.008, 0.008, 1.15});
  }
  make.box({-0.03, -0.03, 0}, {0.03, 0.03, 1.2});
  return {"fence", make.take(), 2.5, {}};
}

Model make_fountain(const Palette& p) {
  MeshBuilder make;
  make.material = p.concrete;
  constexpr int kSides = 32;
  for (int k = 0; k < kSides; ++k) {  // the rim of the basin
    const double a = 2 * std::numbers::pi * k / kSides, b = 2 * std::numbers::pi * (k + 1) / kSides;
    const auto at = [](double angle, double r, double z) {
      return Vector3d(r * std::cos(angle), r * std::sin(angle), z);
    };
    make.texture_origin = Vector3f(float(k) * 0.6f, 0, 0);
    make.quad(at(a, 3.0, 0), at(b, 3.0, 0), at(b, 3.0, 0.55), at(a, 3.0, 0.55));
    make.quad(at(a, 3.0, 0.55), at(b, 3.0, 0.55), at(b, 2.7, 0.55), at(a, 2.7, 0.55));
    make.quad(at(b, 2.7, 0.2), at(a, 2.7, 0.2), at(a, 2.7, 0.55), at(b, 2.7, 0.55));
  }
  make.bar({0, 0, 0}, {0, 0, 2.2}, 0.45, 0.30, 20);
  make.ball({0, 0, 2.5}, {0.5, 0.5, 0.5}, 20);
  make.material = p.glass;  // water
  make.bar({0, 0, 0}, {0, 0, 0.3}, 2.7, 2.7, kSides);
  return {"fountain", make.take(), 4.2, {}};
}

}  // namespace

ModelSet make_models(const Palette& palette) {
  ModelSet set;
  const auto add = [&](Model model) {
    set.models.push_back(std::move(model));
    return static_cast<std::uint32_t>(set.models.size() - 1);
  };
  for (int k = 0; k < 6; ++k) set.cars.push_back(add(make_car(palette, k % 3, k)));
  for (int k = 0; k < 6; ++k) set.trees.push_back(add(make_tree(palette, k)));
  for (int k = 0; k < 3; ++k) set.bushes.push_back(add(make_bush(palette, k)));
  for (int k = 0; k < 2; ++k) set.pedestrians.push_back(add(make_pedestrian(palette, k)));
  set.cyclists.push_back(add(make_cyclist(palette, 0)));
  set.lamp = add(make_lamp(palette));
  set.bin = add(make_bin(palette));
  set.bollard = add(make_bollard(palette));
  set.bench = add(make_bench(palette));
  set.hydrant = add(make_hydrant(palette));
  set.table = add(make_table(palette));
  set.planter = add(make_planter(palette));
  for (std::size_t k = 0; k < palette.street_signs.size(); ++k) {
    set.signs.push_back(add(make_sign(palette, k)));
  }
  set.fence = add(make_fence(palette));
  set.fountain = add(make_fountain(palette));
  return set;
}

}  // namespace fovea
