#include "fovea/mapping/response_fit.h"

#include <gtest/gtest.h>

#include <cmath>

#include "fovea/core/random.h"

namespace fovea::response_fit_test {

struct TrueCamera {
  double offset = 0;
  double vignetting = 0;  // share of the light that the corner loses
  double gamma = 1 / 2.4;

  float value(double light, double s) const {
    const double seen = std::pow(light * (1 - vignetting * s), gamma);
    return static_cast<float>((255 + offset) * seen - offset);
  }
};

struct Scene {
  double noise = 0.05;        // standard deviation of the logarithm of a value
  double approach = 0.3;      // mean growth of s from the first image to the second
  double exposure_swing = 1;  // stops, amplitude from pair to pair
  double outliers = 0.1;      // share of points that something hides in the second image
};

/// A pair of images of surfaces that a camera approaches.
std::vector<SharedPoint> pair_of(const TrueCamera& camera, const Scene& scene, int number) {
  Random random(std::uint64_t(number) + 1);
  const double first_exposure = std::exp2(scene.exposure_swing * std::sin(number)) / 2;
  const double second_exposure = std::exp2(scene.exposure_swing * std::cos(2 * number)) / 2;
  std::vector<SharedPoint> points;
  while (points.size() < 800) {
    const double light = std::exp2(random.uniform(-5, 0));
    const double s1 = random.uniform(0, 0.5);
    const double s2 = std::min(1.0, s1 + random.uniform(0, 2) * scene.approach);
    const bool is_hidden = random.uniform(0, 1) < scene.outliers;
    SharedPoint point;
    point.first = {Eigen::Array3f::Constant(camera.value(first_exposure * light, s1)), float(s1)};
    point.second = {
        Eigen::Array3f::Constant(camera.value(second_exposure * light * (is_hidden ? 0.4 : 1), s2)),
        float(s2)};
    for (PointInImage* seen : {&point.first, &point.second}) {
      for (int c = 0; c < 3; ++c) {
        seen->value[c] *= static_cast<float>(std::exp(scene.noise * random.normal()));
      }
    }
    const bool counts = std::min(point.first.value.minCoeff(), point.second.value.minCoeff()) > 6 &&
                        std::max(point.first.value.maxCoeff(), point.second.value.maxCoeff()) < 248;
    if (counts) points.push_back(point);
  }
  return points;
}

CameraResponse fitted(const TrueCamera& camera, const Scene& scene, int pairs) {
  ResponseFit fit;
  for (int number = 0; number < pairs; ++number) fit.add(pair_of(camera, scene, number));
  return fit.response();
}

double true_vignetting(const TrueCamera& camera, double s) {
  return camera.gamma * std::log2(1 - camera.vignetting * s);
}

TEST(ResponseFit, FindsTheVignettingOfAPowerLaw) {
  const TrueCamera camera{.vignetting = 0.3};
  const CameraResponse response = fitted(camera, {}, 80);
  EXPECT_EQ(response.offset, 0);
  for (const double s : {0.2, 0.5, 0.8}) {
    EXPECT_NEAR(response.vignetting_at(float(s)), true_vignetting(camera, s), 0.01) << s;
  }
}

TEST(ResponseFit, FindsTheCurve) {
  for (const double offset : {255 * 0.055, 255 * 0.099}) {
    const TrueCamera camera{.offset = offset, .vignetting = 0.3};
    const CameraResponse response = fitted(camera, {}, 80);
    EXPECT_DOUBLE_EQ(response.offset, offset);
    EXPECT_NEAR(response.vignetting_at(0.5f), true_vignetting(camera, 0.5), 0.01);
  }
}

TEST(ResponseFit, OfAPlainCameraIsPlain) {
  EXPECT_EQ(fitted({}, {}, 80), CameraResponse());
  EXPECT_EQ(ResponseFit().response(), CameraResponse());
}

TEST(ResponseFit, WithoutMotionSeesNoVignetting) {
  const CameraResponse response = fitted({.vignetting = 0.3}, {.approach = 0}, 40);
  EXPECT_EQ(response.vignetting, CameraResponse().vignetting);
}

TEST(ResponseFit, WithAConstantExposureSeesNoOffsetOfAPowerLaw) {
  EXPECT_EQ(fitted({.vignetting = 0.3}, {.exposure_swing = 0}, 40).offset, 0);
}

TEST(ResponseFit, LeavesOutWhatItDoesNotKnow) {
  EXPECT_EQ(fitted({.vignetting = 0.03}, {.noise = 0.3}, 1), CameraResponse());
}

}  // namespace fovea::response_fit_test
