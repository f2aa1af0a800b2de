// The intensity that stands for a reflectance of 1, estimated from measured intensities.
#pragma once

#include <cstddef>
#include <span>

namespace fovea {

/// LiDARs give intensities up to 1, 255 or 65535. One value in a thousand may exceed the scale.
class IntensityScale {
 public:
  void add(std::span<const float> intensities) {
    points_ += intensities.size();
    for (const float intensity : intensities) {
      above_1_ += intensity > 1;
      above_255_ += intensity > 255;
    }
  }
  void add(const IntensityScale& other) {
    points_ += other.points_;
    above_1_ += other.above_1_;
    above_255_ += other.above_255_;
  }
  double max() const {
    if (above_255_ * 1000 > points_) return 65535;
    return above_1_ * 1000 > points_ ? 255 : 1;
  }

 private:
  std::size_t points_ = 0, above_1_ = 0, above_255_ = 0;
};

}  // namespace fovea
