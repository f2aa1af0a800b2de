#include "fovea/simulation/building.h"

#include <cmath>

namespace fovea {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

constexpr double kFloor = 3.1, kGroundFloor = 3.6, kRecess = 0.16;

struct Opening {
  double x0, x1, z0, z1;
};

class BuildingMaker {
 public:
  BuildingMaker(MeshBuilder& make, const Palette& palette, const BuildingPlan& plan, Random& random)
      : make_(make), p_(palette), plan_(plan), random_(random) {
    wall_ = pick(p_.walls);
    frame_ = random_.uniform() < 0.6 ? p_.frame_white : p_.frame_dark;
    door_ = pick(p_.doors);
    bays_ = std::max(2, static_cast<int>(plan_.width / random_.uniform(2.4, 3.2)));
    window_width_ = random_.uniform(1.0, 1.3);
    window_height_ = random_.uniform(1.45, 1.75);
    top_ = kGroundFloor + kFloor * (plan_.floors - 1) + 0.4;
    // Bricks and stains of one house are not those of the next.
    const double along = random_.uniform(0, 90), up = random_.uniform(0, 3);
    shift_ = Vector3f(float(random_.uniform(0, 50)), float(up), float(along));
  }

  void build() {
    for (int floor = 0; floor < plan_.floors; ++floor) add_floor(floor);
    wall(0, plan_.width, top_ - 0.4, top_, 0);
    add_sides();
    add_details();
    if (plan_.gable) {
      add_gable_roof();
    } else {
      add_flat_roof();
    }
  }

 private:
  std::uint16_t pick(const std::vector<std::uint16_t>& choices) {
    return choices[random_.below(choices.size())];
  }

  /// A piece of the front, in the plane y.
  void wall(double x0, double x1, double z0, double z1, double y) {
    if (x1 - x0 < 1e-6 || z1 - z0 < 1e-6) return;
    make_.material = wall_;
    const auto t = [&](double x, double z) -> Vector3f {
      return shift_ + Vector3d(plan_.width - x, z, 0).cast<float>();
    };
    make_.quad({Vector3d(x1, y, z0), Vector3d(x0, y, z0), Vector3d(x0, y, z1), Vector3d(x1, y, z1)},
               {t(x1, z0), t(x0, z0), t(x0, z1), t(x1, z1)});
  }

  /// A pane that faces the street.
  void pane(const Opening& o, double y, std::uint16_t material) {
    make_.material = material;
    make_.quad({o.x1, y, o.z0}, {o.x0, y, o.z0}, {o.x0, y, o.z1}, {o.x1, y, o.z1});
  }

  void reveals(const Opening& o) {
    make_.material = p_.concrete;
    const double r = -kRecess;
    make_.quad({o.x0, r, o.z0}, {o.x0, 0, o.z0}, {o.x0, 0, o.z1}, {o.x0, r, o.z1});
    make_.quad({o.x1, 0, o.z0}, {o.x1, r, o.z0}, {o.x1, r, o.z1}, {o.x1, 0, o.z1});
    make_.quad({o.x0, r, o.z0}, {o.x1, r, o.z0}, {o.x1, 0, o.z0}, {o.x0, 0, o.z0});
    make_.quad({o.x0, 0, o.z1}, {o.x1, 0, o.z1}, {o.x1, r, o.z1}, {o.x0, r, o.z1});
  }

  /// Bars round an opening, and `columns` x `rows` panes between them.
  void frame(const Opening& o, int columns, int rows) {
    constexpr double kBar = 0.06, kThin = 0.035;
    const double y0 = -kRecess, y1 = -kRecess + 0.05;
    make_.material = frame_;
    make_.box({o.x0, y0, o.z0}, {o.x0 + kBar, y1, o.z1});
    make_.box({o.x1 - kBar, y0, o.z0}, {o.x1, y1, o.z1});
    make_.box({o.x0 + kBar, y0, o.z0}, {o.x1 - kBar, y1, o.z0 + kBar});
    make_.box({o.x0 + kBar, y0, o.z1 - kBar}, {o.x1 - kBar, y1, o.z1});
    for (int k = 1; k < columns; ++k) {
      const double x = o.x0 + (o.x1 - o.x0) * k / columns;
      make_.box({x - kThin, y0, o.z0 + kBar}, {x + kThin, y1 - 0.005, o.z1 - kBar});
    }
    for (int k = 1; k < rows; ++k) {
      const double z = o.z0 + (o.z1 - o.z0) * k / rows;
      make_.box({o.x0 + kBar, y0, z - kThin}, {o.x1 - kBar, y1 - 0.01, z + kThin});
    }
  }

  void window(const Opening& o, int columns, int rows) {
    reveals(o);
    pane(o, -kRecess, p_.glass);
    frame(o, columns, rows);
    if (random_.uniform() < 0.5) {  // curtains, just before the glass that they are seen through
      const double w = (o.x1 - o.x0) * random_.uniform(0.18, 0.32), y = -kRecess + 0.003;
      pane({o.x0, o.x0 + w, o.z0, o.z1}, y, p_.curtain);
      pane({o.x1 - w, o.x1, o.z0, o.z1}, y, p_.curtain);
    }
    make_.material = p_.concrete;
    make_.box({o.x0 - 0.06, -kRecess, o.z0 - 0.06}, {o.x1 + 0.06, 0.07, o.z0});
  }

  void door(const Opening& o) {
    reveals(o);
    pane({o.x0, o.x1, o.z0, o.z1 - 0.5}, -kRecess, door_);
    pane({o.x0, o.x1, o.z1 - 0.5, o.z1}, -kRecess, p_.glass);
    make_.material = frame_;
    make_.box({o.x0, -kRecess, o.z1 - 0.53}, {o.x1, -kRecess + 0.04, o.z1 - 0.47});
    make_.material = p_.chrome;
    make_.bar({o.x0 + 0.12, -kRecess + 0.05, o.z0 + 1.0},
              {o.x0 + 0.12, -kRecess + 0.05, o.z0 + 1.25}, 0.015, 0.015, 8);
    make_.material = p_.concrete;
    make_.box({o.x0 - 0.1, -kRecess, 0}, {o.x1 + 0.1, 0.35, o.z0});
  }

  void shop_front(const Opening& o) {
    reveals(o);
    pane(o, -kRecess, p_.glass);
    frame(o, std::max(2, static_cast<int>((o.x1 - o.x0) / 1.3)), 1);
    // The sign over it.
    const double width = kShopSign.x(), middle = 0.5 * (o.x0 + o.x1), z = o.z1 + 0.18;
    const Vector3f t0(0, 0, 0), t1(kShopSign.x(), 0, 0), t2(kShopSign.x(), kShopSign.y(), 0),
        t3(0, kShopSign.y(), 0);
    make_.material = p_.frame_dark;
    make_.box({middle - 0.5 * width - 0.04, 0, z - 0.04},
              {middle + 0.5 * width + 0.04, 0.08, z + kShopSign.y() + 0.04});
    make_.material = pick(p_.shop_signs);
    make_.quad({Vector3d(middle + 0.5 * width, 0.085, z), Vector3d(middle - 0.5 * width, 0.085, z),
                Vector3d(middle - 0.5 * width, 0.085, z + kShopSign.y()),
                Vector3d(middle + 0.5 * width, 0.085, z + kShopSign.y())},
               {t0, t1, t2, t3});
    if (random_.uniform() < 0.5) {  // an awning
      make_.material = pick(p_.clothes);
      make_.quad({o.x1, 0, o.z1 + 0.1}, {o.x0, 0, o.z1 + 0.1}, {o.x0, 1.1, o.z1 - 0.35},
                 {o.x1, 1.1, o.z1 - 0.35});
      make_.quad({o.x1, 1.1, o.z1 - 0.55}, {o.x0, 1.1, o.z1 - 0.55}, {o.x0, 1.1, o.z1 - 0.35},
                 {o.x1, 1.1, o.z1 - 0.35});
    }
  }

  /// One storey of the front: openings, and the wall around each within its bay.
  void add_floor(int floor) {
    const bool ground = floor == 0;
    const double low = ground ? 0 : kGroundFloor + kFloor * (floor - 1);
    const double high = ground ? kGroundFloor : low + kFloor;
    const double bay = plan_.width / bays_;
    const int door_bay = bays_ / 2;
    for (int k = 0; k < bays_; ++k) {
      const double left = bay * k, middle = left + 0.5 * bay;
      Opening o{middle - 0.5 * window_width_, middle + 0.5 * window_width_, low + 0.9,
                low + 0.9 + window_height_};
      double right = left + bay;
      if (ground && k == door_bay) {
        o = {middle - 0.55, middle + 0.55, 0.18, 2.75};
        door(o);
      } else if (ground && plan_.shop && k + 1 != door_bay && k + 1 < bays_) {
        right += bay;  // a shop window takes two bays
        o = {left + 0.35, right - 0.35, 0.55, 2.55};
        shop_front(o);
        ++k;
      } else {
        window(o, 2, random_.uniform() < 0.5 ? 2 : 1);
        if (!ground && plan_.balconies && k % 2 == 0) balcony(middle, low, bay);
      }
      wall(left, o.x0, low, high, 0);
      wall(o.x1, right, low, high, 0);
      wall(o.x0, o.x1, low, o.z0, 0);
      wall(o.x0, o.x1, o.z1, high, 0);
    }
  }

  void balcony(double middle, double low, double bay) {
    const double half = 0.42 * bay, out = 0.95;
    make_.material = p_.concrete;
    make_.box({middle - half, 0, low + 0.05}, {middle + half, out, low + 0.17});
    make_.material = p_.dark_metal;
    const double z0 = low + 0.17, z1 = low + 1.1;
    make_.box({middle - half, out - 0.05, z1}, {middle + half, out - 0.01, z1 + 0.04});
    for (const double x : {middle - half, middle + half - 0.04})
      make_.box({x, 0, z1}, {x + 0.04, out - 0.05, z1 + 0.04});
    const int bars = static_cast<int>(2 * half / 0.13);
    for (int k = 0; k <= bars; ++k) {
      const double x = middle - half + 2 * half * k / bars;
      make_.box({x - 0.008, out - 0.04, z0}, {x + 0.008, out - 0.024, z1});
    }
  }

  void add_sides() {
    make_.material = wall_;
    const double w = plan_.width, d = -plan_.depth;
    make_.texture_origin = shift_;
    make_.quad({0, 0, 0}, {0, d, 0}, {0, d, top_}, {0, 0, top_});
    make_.quad({w, d, 0}, {w, 0, 0}, {w, 0, top_}, {w, d, top_});
    make_.quad({0, d, 0}, {w, d, 0}, {w, d, top_}, {0, d, top_});
    make_.texture_origin = Vector3f::Zero();
  }

  void add_details() {
    make_.material = p_.concrete;
    make_.box({0, 0, 0}, {plan_.width, 0.05, 0.17});  // plinth, below every opening
    for (int floor = 1; floor < plan_.floors; ++floor) {
      const double z = kGroundFloor + kFloor * (floor - 1);
      if (floor == 1 || random_.uniform() < 0.3)
        make_.box({0, 0, z - 0.08}, {plan_.width, 0.06, z + 0.06});
    }
    make_.box({-0.05, 0, top_ - 0.22}, {plan_.width + 0.05, 0.28, top_});
    make_.material = p_.metal;  // a downpipe
    const double x = random_.uniform() < 0.5 ? 0.14 : plan_.width - 0.14;
    make_.bar({x, 0.13, 0.17}, {x, 0.13, top_ - 0.22}, 0.05, 0.05, 8);
  }

  void add_flat_roof() {
    make_.material = p_.roof_felt;
    const double w = plan_.width, d = -plan_.depth;
    make_.quad({0, d, top_ - 0.05}, {w, d, top_ - 0.05}, {w, 0, top_ - 0.05}, {0, 0, top_ - 0.05});
    make_.material = p_.concrete;
    make_.box({0, -0.25, top_}, {w, 0, top_ + 0.5});
  }

  void add_gable_roof() {
    const double w = plan_.width, d = plan_.depth, rise = 0.42 * d;
    const Vector3d ridge0(-0.2, -0.5 * d, top_ + rise), ridge1(w + 0.2, -0.5 * d, top_ + rise);
    const double eave = 0.35, drop = eave * rise / (0.5 * d);
    make_.material = p_.roof_tiles;
    make_.quad({w + 0.2, eave, top_ - drop}, {-0.2, eave, top_ - drop}, ridge0, ridge1);
    make_.quad({-0.2, -d - eave, top_ - drop}, {w + 0.2, -d - eave, top_ - drop}, ridge1, ridge0);
    make_.material = wall_;
    make_.triangle({0, 0, top_}, {0, -d, top_}, {0, -0.5 * d, top_ + rise - 0.1});
    make_.triangle({w, -d, top_}, {w, 0, top_}, {w, -0.5 * d, top_ + rise - 0.1});
    make_.box({0.2 * w, -0.62 * d, top_ + 0.5 * rise},
              {0.2 * w + 0.7, -0.62 * d + 0.5, top_ + rise + 0.7});
  }

  MeshBuilder& make_;
  const Palette& p_;
  const BuildingPlan& plan_;
  Random& random_;
  std::uint16_t wall_ = 0, frame_ = 0, door_ = 0;
  int bays_ = 3;
  double window_width_ = 1.2, window_height_ = 1.5, top_ = 0;
  Vector3f shift_ = Vector3f::Zero();
};

}  // namespace

void add_building(MeshBuilder& make, const Palette& palette, const BuildingPlan& plan,
                  Random& random) {
  BuildingMaker(make, palette, plan, random).build();
}

}  // namespace fovea
