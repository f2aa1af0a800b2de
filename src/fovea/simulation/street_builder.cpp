#include "fovea/simulation/street_builder.h"

#include <cmath>
#include <numbers>

#include "fovea/simulation/building.h"

namespace fovea {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

constexpr double kKerbWidth = 0.15;
constexpr double kHalfTurn = std::numbers::pi;

class StreetMaker {
 public:
  StreetMaker(const StreetAxis& axis, double begin, const StreetStyle& style,
              const Palette& palette, const ModelSet& models, Random random,
              std::uint32_t first_surface)
      : axis_(axis),
        begin_(begin),
        style_(style),
        p_(palette),
        models_(models),
        random_(random),
        next_surface_(first_surface) {}

  Chunk build(const std::optional<Random>& parked_cars) {
    add_ground();
    for (const double side : {1.0, -1.0}) {
      add_houses(side);
      if (style_.raised && !parked_cars) add_parked_cars(side);
      add_street_trees(side);
      add_furniture(side);
      add_clutter(side);
    }
    if (style_.raised && parked_cars) {
      random_ = *parked_cars;
      for (const double side : {1.0, -1.0}) add_parked_cars(side);
    }
    chunk_.mesh_world = make_.take();
    return std::move(chunk_);
  }

 private:
  bool chance(double share) { return random_.uniform() < share; }
  std::uint32_t pick(const std::vector<std::uint32_t>& choices) {
    return choices[random_.below(choices.size())];
  }
  std::uint16_t pick(const std::vector<std::uint16_t>& choices) {
    return choices[random_.below(choices.size())];
  }
  double ground() const { return style_.raised ? kPavement : 0.0; }

  /// A new thing of a kind; what is built next belongs to it.
  std::uint32_t begin_surface(const char* kind) {
    make_.surface = next_surface_++;
    chunk_.surfaces[make_.surface] = kind;
    return make_.surface;
  }

  /// Stands a model on (s, d), turned from the street's direction.
  void stand(std::uint32_t model, double s, double d, double z, double turn,
             std::uint16_t paint = Palette::kPaint, const char* kind = nullptr) {
    const std::uint32_t surface =
        begin_surface(kind != nullptr ? kind : models_.models[model].kind.c_str());
    const Placement placement{model, axis_.frame(begin_ + s, d, z, turn), paint, surface};
    make_.append(placed_mesh(models_.models[model], placement));
    if (!models_.models[model].label.empty()) chunk_.standing.push_back(placement);
  }

  /// A strip of ground from d0 to d1 (d0 < d1), its texture (across, along) the street.
  void strip(const char* kind, std::uint16_t material, double d0, double z0, double d1, double z1) {
    begin_surface(kind);
    make_.material = material;
    constexpr int kPieces = 16;
    for (int k = 0; k < kPieces; ++k) {
      const double s0 = begin_ + kChunkLength * k / kPieces,
                   s1 = begin_ + kChunkLength * (k + 1) / kPieces +
                        (k + 1 == kPieces ? kOverlap : 0.0);
      const bool wall = std::abs(d1 - d0) < 1e-9;  // a kerb's face: textured by height
      const auto t = [&](double s, double d, double z) {
        return Vector3f(float(wall ? s : d), float(wall ? z : s), 0);
      };
      make_.quad({axis_.place(s0, d0, z0), axis_.place(s1, d0, z0), axis_.place(s1, d1, z1),
                  axis_.place(s0, d1, z1)},
                 {t(s0, d0, z0), t(s1, d0, z0), t(s1, d1, z1), t(s0, d1, z1)});
    }
  }

  void add_ground() {
    const double kerb = style_.kerb, front = style_.front;
    if (!style_.raised) {
      strip("square", p_.plaza, -front, 0, front, 0);
      strip("grass", p_.grass, front, 0, style_.far, 0);
      strip("grass", p_.grass, -style_.far, 0, -front, 0);
      return;
    }
    strip("road", p_.road, -kerb, 0, kerb, 0);
    strip("kerb", p_.kerb, kerb, 0, kerb, kPavement);
    strip("kerb", p_.kerb, kerb, kPavement, kerb + kKerbWidth, kPavement);
    strip("kerb", p_.kerb, -kerb, kPavement, -kerb, 0);
    strip("kerb", p_.kerb, -kerb - kKerbWidth, kPavement, -kerb, kPavement);
    strip("pavement", p_.pavement, kerb + kKerbWidth, kPavement, front, kPavement);
    strip("pavement", p_.pavement, -front, kPavement, -kerb - kKerbWidth, kPavement);
    strip("grass", p_.grass, front, kPavement, style_.far, kPavement);
    strip("grass", p_.grass, -style_.far, kPavement, -front, kPavement);
  }

  /// Frame of a front from s to s + width on a side: x along the front, y to the street, z up.
  RigidMotion front_frame(double s, double width, double side, double d) const {
    const double turn = side > 0 ? kHalfTurn : 0.0;
    RigidMotion T = axis_.frame(begin_ + s + 0.5 * width, side * d, 0, turn);
    T.translate(Vector3d(-0.5 * width, 0, 0));
    return T;
  }

  void add_houses(double side) {
    double s = 0;
    while (s < kChunkLength - 1e-9) {
      const double left = kChunkLength - s;
      double width = left < 16 ? left : std::floor(random_.uniform(9, 14));
      if (left < 8 || (s > 0 && chance(style_.gap_chance))) {
        add_garden(s, left, side);
        width = left;
      } else {
        add_house(s, width, side);
      }
      s += width;
    }
    if (!style_.backdrop) return;
    begin_surface("distant house");
    make_.material = pick(p_.distant);
    make_.frame = front_frame(0, kChunkLength, side, std::max(style_.front + 22, 32.0));
    const double length = random_.uniform(14, 22);
    make_.box({1, -10, 0}, {length, 0, random_.uniform(6, 13)});
    make_.frame.setIdentity();
  }

  void add_house(double s, double width, double side) {
    BuildingPlan plan;
    plan.width = width;
    plan.depth = random_.uniform(8, 10);
    plan.floors = style_.min_floors + static_cast<int>(random_.below(static_cast<std::uint64_t>(
                                          style_.max_floors - style_.min_floors + 1)));
    plan.shop = chance(0.4);
    plan.gable = plan.floors <= 3 && chance(0.6);
    plan.balconies = chance(0.3);
    begin_surface("house");
    make_.frame = front_frame(s, width, side, style_.front);
    add_building(make_, p_, plan, random_);
    make_.frame.setIdentity();
  }

  void add_garden(double s, double width, double side) {
    for (double at = 0.2; at + 2 <= width; at += 2) {
      stand(models_.fence, s + at, side * (style_.front + 0.1), ground(), 0);
    }
    for (double at = 0.6; at < width; at += random_.uniform(0.9, 1.6)) {
      const double turn = random_.uniform(0, 6), behind = random_.uniform(0.8, 1.4);
      stand(pick(models_.bushes), s + at, side * (style_.front + behind), ground(), turn);
    }
    if (width > 4) {
      const double turn = random_.uniform(0, 6);
      stand(pick(models_.trees), s + 0.5 * width, side * (style_.front + 4), ground(), turn);
    }
  }

  void add_parked_cars(double side) {
    constexpr double kPlace = 6;
    for (double s = 0.5 * kPlace; s < kChunkLength; s += kPlace) {
      if (!chance(style_.parked)) continue;
      const double turn = (side > 0 ? kHalfTurn : 0.0) + random_.uniform(-0.03, 0.03);
      const std::uint16_t paint = pick(p_.car_paints);
      const double off_kerb = random_.uniform(-0.1, 0.08), ahead = random_.uniform(-0.4, 0.4);
      stand(pick(models_.cars), s + ahead, side * (style_.kerb - 1.12 + off_kerb), 0, turn, paint,
            "parked car");
    }
  }

  void add_street_trees(double side) {
    for (const double s : {7.0, 19.0}) {
      if (!chance(style_.trees)) continue;
      const double d = side * (style_.kerb + 0.85);
      begin_surface("tree pit");
      make_.material = p_.soil;
      make_.frame = axis_.frame(begin_ + s, d, ground() + 0.004, 0);
      make_.quad({-0.5, -0.5, 0}, {0.5, -0.5, 0}, {0.5, 0.5, 0}, {-0.5, 0.5, 0});
      make_.frame.setIdentity();
      const double turn = random_.uniform(0, 6);
      stand(pick(models_.trees), s, d, ground(), turn);
    }
  }

  void add_furniture(double side) {
    const double near_kerb = side * (style_.kerb + 0.45), near_wall = side * (style_.front - 0.75);
    const double toward_road = side > 0 ? kHalfTurn : 0.0;
    if (side > 0 || style_.raised) {
      stand(models_.lamp, side > 0 ? 1.2 : 13.2, near_kerb, ground(), toward_road);
    }
    if (chance(0.5 * style_.furniture)) {
      stand(pick(models_.signs), 4.2, near_kerb, ground(), side > 0 ? 0.0 : kHalfTurn);
    }
    if (chance(style_.furniture)) {
      const std::uint16_t color = pick(p_.clothes);
      const double turn = random_.uniform(-0.1, 0.1);
      stand(models_.bin, random_.uniform(3, 9), near_wall, ground(), turn, color);
    }
    if (chance(style_.furniture))
      stand(models_.bench, random_.uniform(10, 14), side * (style_.front - 0.9), ground(),
            side > 0 ? 0.0 : kHalfTurn);
    if (chance(0.7 * style_.furniture)) {
      for (double s = 15.5; s < 19; s += 1.9)
        stand(models_.table, s, side * (style_.front - 1.3), ground(), random_.uniform(-0.4, 0.4));
    }
    if (chance(0.6 * style_.furniture))
      stand(models_.planter, random_.uniform(20, 23), side * (style_.front - 0.5), ground(), 0);
    if (chance(0.25 * style_.furniture)) stand(models_.hydrant, 10.5, near_kerb, ground(), 0);
    if (chance(style_.furniture)) {
      for (double s = 20; s < kChunkLength; s += 1.5)
        stand(models_.bollard, s, side * (style_.kerb + 0.3), ground(), 0);
    }
  }

  void add_clutter(double side) {
    for (double s = 0; s < kChunkLength; s += 2) {
      if (chance(style_.railings))
        stand(models_.fence, s, side * (style_.kerb + 0.28), ground(), 0);
      if (chance(2 * style_.bushes)) {
        const double turn = random_.uniform(0, 6);
        const double d = random_.uniform(style_.kerb + 0.9, style_.front - 0.6);
        const double ahead = random_.uniform(0, 2);
        stand(pick(models_.bushes), s + ahead, side * d, ground(), turn);
      }
      if (chance(2 * style_.bystanders)) {
        const std::uint16_t clothes = pick(p_.clothes);
        const double turn = random_.uniform(0, 6);
        const double d = random_.uniform(style_.kerb + 0.7, style_.front - 0.6);
        stand(models_.pedestrians.front(), s + random_.uniform(0, 2), side * d, ground(), turn,
              clothes, "bystander");
      }
    }
  }

  const StreetAxis& axis_;
  double begin_;
  const StreetStyle& style_;
  const Palette& p_;
  const ModelSet& models_;
  Random random_;
  std::uint32_t next_surface_;
  MeshBuilder make_;
  Chunk chunk_;
};

}  // namespace

Chunk build_street(const StreetAxis& axis, double begin, const StreetStyle& style,
                   const Palette& palette, const ModelSet& models, Random random,
                   std::uint32_t first_surface, std::optional<Random> parked_cars) {
  return StreetMaker(axis, begin, style, palette, models, random, first_surface).build(parked_cars);
}

}  // namespace fovea
