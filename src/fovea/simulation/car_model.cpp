#include <array>

#include "fovea/simulation/mesh_builder.h"
#include "fovea/simulation/models.h"

namespace fovea {
namespace {

using Eigen::Vector3d;

/// A cross section of a car's body, symmetric to the middle.
struct Station {
  double x;         // forward, m
  double width;     // half, at the belt line
  double belt;      // height of the belt line
  double roof;      // height of the top; the belt's where there is no cabin
  bool glass_side;  // the cabin's side between this station and the next is glass
  bool glass_top;   // ... and its top (windscreen, rear window)
};

constexpr double kSill = 0.27;  // height of the body's lower edge
constexpr double kLean = 0.80;  // the roof's half width over the body's

using Stations = std::vector<Station>;

Stations stations_of(int body) {
  switch (body) {
    case 0:
      return {{2.28, 0.62, 0.60, 0.60, false, false},  {2.18, 0.78, 0.72, 0.72, false, false},
              {1.75, 0.86, 0.82, 0.82, false, false},  {0.98, 0.89, 0.93, 0.93, false, true},
              {0.28, 0.90, 0.94, 1.40, true, false},   {-0.38, 0.90, 0.95, 1.45, true, false},
              {-1.05, 0.90, 0.96, 1.40, true, true},   {-1.70, 0.88, 0.98, 0.98, false, false},
              {-2.18, 0.82, 0.95, 0.95, false, false}, {-2.28, 0.72, 0.62, 0.62, false, false}};
    case 1:
      return {{1.98, 0.62, 0.62, 0.62, false, false}, {1.88, 0.76, 0.76, 0.76, false, false},
              {1.50, 0.84, 0.86, 0.86, false, false}, {0.95, 0.86, 0.97, 0.97, false, true},
              {0.22, 0.87, 0.98, 1.46, true, false},  {-0.60, 0.87, 0.99, 1.51, true, false},
              {-1.42, 0.86, 1.00, 1.45, false, true}, {-1.88, 0.82, 1.00, 1.00, false, false},
              {-1.96, 0.74, 0.60, 0.60, false, false}};
    default:
      return {{2.55, 0.80, 0.75, 0.75, false, false}, {2.45, 0.90, 0.95, 0.95, false, false},
              {1.95, 0.96, 1.12, 1.12, false, true},  {1.25, 0.98, 1.16, 1.98, true, false},
              {0.45, 0.99, 1.18, 2.05, false, false}, {-2.45, 0.99, 1.20, 2.03, false, false},
              {-2.52, 0.96, 0.70, 0.70, false, false}};
  }
}

/// Points of a section from the sill up over the roof's edge to the middle of the roof, left side.
std::array<Vector3d, 5> outline(const Station& s) {
  const bool cabin = s.roof > s.belt;
  const double top = cabin ? s.width * kLean : s.width * 0.93;
  return {Vector3d(s.x, s.width * 0.96, kSill), Vector3d(s.x, s.width, 0.5 * (kSill + s.belt)),
          Vector3d(s.x, s.width * 0.97, s.belt),
          Vector3d(s.x, top, cabin ? s.roof - 0.04 : s.belt + 0.01),
          Vector3d(s.x, 0, s.roof + 0.02)};
}

Vector3d mirrored(const Vector3d& p) { return {p.x(), -p.y(), p.z()}; }

void add_body(MeshBuilder& make, const Palette& palette, const Stations& stations) {
  for (std::size_t i = 0; i + 1 < stations.size(); ++i) {
    const auto front = outline(stations[i]), back = outline(stations[i + 1]);
    for (std::size_t k = 0; k + 1 < front.size(); ++k) {
      const bool side = k == 2, top = k == 3;
      const bool glass = (side && stations[i].glass_side) || (top && stations[i].glass_top);
      make.material = glass ? palette.car_glass : Palette::kPaint;
      make.quad(back[k], front[k], front[k + 1], back[k + 1]);
      make.quad(mirrored(front[k]), mirrored(back[k]), mirrored(back[k + 1]),
                mirrored(front[k + 1]));
    }
    // A pillar between side windows: a strip of paint a little outside the glass.
    if (stations[i].glass_side && i + 1 < stations.size() && stations[i + 1].glass_side) {
      const Vector3d out(0, 0.008, 0), half(0.035, 0, 0);
      make.material = Palette::kPaint;
      make.quad(back[2] - half + out, back[2] + half + out, back[3] + half + out,
                back[3] - half + out);
      make.quad(mirrored(back[2] + half + out), mirrored(back[2] - half + out),
                mirrored(back[3] - half + out), mirrored(back[3] + half + out));
    }
  }
  // Front, rear and floor.
  make.material = Palette::kPaint;
  const auto nose = outline(stations.front()), tail = outline(stations.back());
  const std::size_t top = nose.size() - 1;  // on the middle: its own mirror image
  for (std::size_t k = 0; k + 1 < top; ++k) {
    make.quad(nose[k], mirrored(nose[k]), mirrored(nose[k + 1]), nose[k + 1]);
    make.quad(mirrored(tail[k]), tail[k], tail[k + 1], mirrored(tail[k + 1]));
  }
  make.triangle(nose[top - 1], mirrored(nose[top - 1]), nose[top]);
  make.triangle(mirrored(tail[top - 1]), tail[top - 1], tail[top]);
  make.material = palette.dark_metal;
  make.quad(mirrored(tail[0]), mirrored(nose[0]), nose[0], tail[0]);
}

void add_wheel(MeshBuilder& make, const Palette& palette, double x, double y, double radius) {
  const Vector3d center(x, y, radius), outward(0, y > 0 ? 1 : -1, 0);
  make.material = palette.rubber;
  make.bar(center - 0.12 * outward, center + 0.10 * outward, radius, radius, 20);
  make.material = palette.metal;
  make.bar(center + 0.10 * outward, center + 0.106 * outward, 0.64 * radius, 0.60 * radius, 12);
  make.material = palette.dark_metal;
  for (int k = 0; k < 5; ++k) {  // gaps between spokes
    const double a = 2 * 3.14159265 * k / 5;
    const Vector3d place(center.x() + 0.38 * radius * std::cos(a), center.y(),
                         center.z() + 0.38 * radius * std::sin(a));
    make.bar(place + 0.104 * outward, place + 0.109 * outward, 0.13 * radius, 0.13 * radius, 6);
  }
}

void add_trim(MeshBuilder& make, const Palette& palette, const Stations& stations, int plate) {
  const double nose = stations.front().x, tail = stations.back().x;
  const double width = stations[1].width;
  for (const double y : {-1.0, 1.0}) {
    make.material = palette.headlight;
    make.box({nose - 0.12, y * (width - 0.16) - 0.13, 0.58},
             {nose + 0.02, y * (width - 0.16) + 0.13, 0.72});
    make.material = palette.taillight;
    make.box({tail - 0.02, y * (width - 0.12) - 0.09, 0.66},
             {tail + 0.10, y * (width - 0.12) + 0.09, 0.90});
    make.material = Palette::kPaint;  // mirrors
    const double mirror = stations[stations.size() / 2 - 1].width;
    make.box({0.62, y * (mirror + 0.09) - 0.09, 0.98}, {0.74, y * (mirror + 0.09) + 0.09, 1.11});
  }
  make.material = palette.dark_metal;  // grille and bumpers
  make.box({nose - 0.05, -0.42, 0.36}, {nose + 0.012, 0.42, 0.50});
  make.box({tail - 0.012, -0.6, 0.34}, {tail + 0.05, 0.6, 0.44});
  make.material = palette.plates[static_cast<std::size_t>(plate) % palette.plates.size()];
  const double half = 0.5 * kPlate.x(), height = kPlate.y();
  const Eigen::Vector3f t0(0, 0, 0), t1(kPlate.x(), 0, 0), t2(kPlate.x(), kPlate.y(), 0),
      t3(0, kPlate.y(), 0);
  make.quad(
      {Vector3d(nose + 0.02, half * -1, 0.50), Vector3d(nose + 0.02, half, 0.50),
       Vector3d(nose + 0.02, half, 0.50 + height), Vector3d(nose + 0.02, -half, 0.50 + height)},
      {t0, t1, t2, t3});
  make.quad(
      {Vector3d(tail - 0.02, half, 0.50), Vector3d(tail - 0.02, -half, 0.50),
       Vector3d(tail - 0.02, -half, 0.50 + height), Vector3d(tail - 0.02, half, 0.50 + height)},
      {t0, t1, t2, t3});
}

}  // namespace

Model make_car(const Palette& palette, int body, int plate) {
  const Stations stations = stations_of(body);
  MeshBuilder make;
  add_body(make, palette, stations);
  const double radius = body == 2 ? 0.36 : 0.32;
  const double track = stations[2].width - 0.10;
  const double front = stations.front().x - (body == 2 ? 0.95 : 0.85),
               rear = stations.back().x + (body == 2 ? 1.05 : 0.80);
  for (const double x : {front, rear}) {
    for (const double y : {-track, track}) add_wheel(make, palette, x, y, radius);
  }
  add_trim(make, palette, stations, plate);
  return {"car", make.take(), 3.4, body == 2 ? "Van" : "Car"};
}

}  // namespace fovea
