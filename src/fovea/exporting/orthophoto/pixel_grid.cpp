#include "fovea/exporting/orthophoto/pixel_grid.h"

#include <fmt/format.h>

#include <cmath>

#include "fovea/errors.h"

namespace fovea {
namespace {

double number(double coordinate, double pixel) { return std::floor(coordinate / pixel); }

struct Size {
  double width, height;
  bool fits() const {
    return width <= double(PixelGrid::kLongestEdge) && height <= double(PixelGrid::kLongestEdge) &&
           width * height <= double(PixelGrid::kMostPixels);
  }
};

Size size_of(const Eigen::AlignedBox2d& bounds, double pixel) {
  const auto edge = [&](int axis) {
    return number(bounds.max()[axis], pixel) - number(bounds.min()[axis], pixel) + 1;
  };
  return {edge(0), edge(1)};
}

/// The smallest of 1, 2, 5, 10, ... mm whose picture fits.
double smallest_pixel(const Eigen::AlignedBox2d& bounds) {
  for (double decade = 0.001;; decade *= 10) {
    for (const double pixel : {decade, 2 * decade, 5 * decade}) {
      if (!std::isfinite(pixel) || size_of(bounds, pixel).fits()) return pixel;
    }
  }
}

}  // namespace

PixelGrid::PixelGrid(const Eigen::AlignedBox2d& bounds, double pixel)
    : pixel_(pixel),
      west_(number(bounds.min().x(), pixel)),
      north_(number(bounds.max().y(), pixel)) {
  const Size size = size_of(bounds, pixel);
  if (!size.fits()) {
    throw ConfigError(
        fmt::format("the picture would have {:.0f} x {:.0f} pixels", size.width, size.height),
        "--pixel",
        fmt::format("choose {:g} m or more, or fewer points with --where", smallest_pixel(bounds)));
  }
  width_ = static_cast<int>(size.width);
  height_ = static_cast<int>(size.height);
}

int PixelGrid::column(double x) const { return static_cast<int>(number(x, pixel_) - west_); }

int PixelGrid::row(double y) const { return static_cast<int>(north_ - number(y, pixel_)); }

std::string PixelGrid::world_file() const {
  return fmt::format("{0}\n0\n0\n-{0}\n{1:.6f}\n{2:.6f}\n", pixel_, (west_ + 0.5) * pixel_,
                     (north_ + 0.5) * pixel_);
}

}  // namespace fovea
