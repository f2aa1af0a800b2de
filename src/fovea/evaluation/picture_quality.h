// The map drawn into a scored view against the photograph taken there, pixel by pixel.
#pragma once

#include <array>

#include "fovea/rendering/splat.h"

namespace fovea {

/// Sums over pixels of any number of views.
struct PictureSums {
  std::size_t pixels = 0, covered = 0;          ///< of the views; with something drawn
  double squared_all = 0, squared_covered = 0;  ///< squared errors, mean over channels (0-255)
  double ssim_all = 0, ssim_covered = 0;

  PictureSums& operator+=(const PictureSums& other);
  double share_covered() const;
  /// 10 log10 (255^2 / mean squared error), dB; infinite without error.
  double psnr_all() const;
  double psnr_covered() const;
  double mean_ssim_all() const;
  double mean_ssim_covered() const;  ///< all are NaN without pixels
};

/// Adds up squared errors (of RGB; of luma for a grey photograph) and the structural similarity of
/// the lumas (Wang, Bovik, Sheikh, Simoncelli 2004, "Image quality assessment: from error
/// visibility to structural similarity", IEEE TIP 13: Gaussian window of 11 x 11 pixels,
/// deviation 1.5, K1 = 0.01, K2 = 0.03). "All" takes what is not drawn as black; "covered" averages
/// over covered pixels, and its windows weigh covered pixels only. At the border windows are cut.
PictureSums compare_pictures(const SplatView& drawn, const Image& photograph);

/// How far the drawn texture lies beside the photograph's: sums of absolute differences of luma for
/// each whole shift of up to kReach pixels, over a third of the rows and columns.
struct ShiftSums {
  static constexpr int kReach = 8, kSide = 2 * kReach + 1;
  std::size_t pixels = 0;
  std::array<double, std::size_t{kSide} * kSide> difference{};

  ShiftSums& operator+=(const ShiftSums& other);
  double at(const Eigen::Vector2i& shift) const;
  /// What is drawn at p lies at p + shift in the photograph; zero if nothing could be compared, and
  /// of equal ones the smallest.
  Eigen::Vector2i best() const;
};
ShiftSums compare_shifts(const SplatView& drawn, const Image& photograph);

}  // namespace fovea
