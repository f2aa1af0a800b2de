// Colours that an image has for points of a map: means over the patches that the points stand for.
#pragma once

#include "fovea/geometry/camera.h"
#include "fovea/mapping/image_pyramid.h"
#include "fovea/mapping/view_places.h"

namespace fovea {

/// An image that colours points.
struct ColorView {
  const ImagePyramid& image;
  const Camera& camera;
  int frame = 0;
  double footprint = 0.02;  ///< m: edge of the patch of surface whose mean colour a point gets
  /// By which the image's colours are multiplied, a channel.
  Eigen::Array3f gain = Eigen::Array3f::Ones();
  bool is_exposure_matched() const { return (gain != 1).any(); }
};

class PatchColors {
 public:
  explicit PatchColors(const ColorView& view)
      : image_(view.image),
        gain_(view.gain),
        footprint_(static_cast<float>(view.footprint * view.camera.fx)) {}

  /// At the first `count` places.
  void at(const ViewPlaces& places, std::size_t count, ColorBlock& colors) const {
    std::array<float, ColorBlock::kSize> footprint;
    for (std::size_t i = 0; i < count; ++i) footprint[i] = footprint_ / places.depth[i];
    image_.colors_at({places.u.data(), count}, {places.v.data(), count}, {footprint.data(), count},
                     colors);
    for (std::size_t i = 0; i < count; ++i) {
      colors.red[i] *= gain_.x();
      colors.green[i] *= gain_.y();
      colors.blue[i] *= gain_.z();
    }
  }

 private:
  const ImagePyramid& image_;
  Eigen::Array3f gain_;
  float footprint_;  // pixels, a metre before the camera
};

}  // namespace fovea
