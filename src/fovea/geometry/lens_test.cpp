#include "fovea/geometry/lens.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "fovea/geometry/rectified_camera.h"

namespace fovea::lens_test {

using Eigen::Vector2d;
using Eigen::Vector3d;

const Lens kPlumbBob(LensModel::kPlumbBob, {-0.28, 0.07, 0.0005, -0.0004, -0.005});
const Lens kRational(LensModel::kRationalPolynomial,
                     {0.2, 0.05, 0.0005, -0.0004, 0.001, 0.5, 0.1, 0.005});
const Lens kFisheye(LensModel::kEquidistant, {-0.012, 0.004, -0.002, 0.0003});

LensCamera camera_with(const Lens& lens) { return {640, 480, 400, 410, 325.5, 236.25, lens}; }

/// What the formulas of OpenCV's documentation give, evaluated term by term in another language.
TEST(Lens, DistortsAsTheFormulasOfOpenCv) {
  struct Case {
    Vector3d ray;
    Vector2d plumb_bob, rational, fisheye;
  };
  const std::array<Case, 4> cases = {{{{0.3, -0.2, 1},
                                       {0.289247604500, -0.192801403000},
                                       {0.288607482742, -0.192374655161},
                                       {0.287530246928, -0.191686831285}},
                                      {{-0.9, 0.4, 1},
                                       {-0.712125671500, 0.316812854000},
                                       {-0.707208225329, 0.314627322368},
                                       {-0.706342387653, 0.313929950068}},
                                      {{0.06, 0.6, 1.2},
                                       {0.046606122262, 0.467197472617},
                                       {0.046434678571, 0.465483035709},
                                       {0.046220222945, 0.462202229447}},
                                      {{1.2, 0.7, 1.6},
                                       {0.619489038816, 0.361921470559},
                                       {0.615706496169, 0.359714987349},
                                       {0.614314885390, 0.358350349811}}}};
  for (const Case& c : cases) {
    EXPECT_LT((*kPlumbBob.distort(c.ray) - c.plumb_bob).norm(), 2e-12);
    EXPECT_LT((*kRational.distort(c.ray) - c.rational).norm(), 2e-12);
    EXPECT_LT((*kFisheye.distort(c.ray) - c.fisheye).norm(), 2e-12);
    EXPECT_LT((*Lens().distort(c.ray) - c.ray.head<2>() / c.ray.z()).norm(), 1e-15);
  }
}

TEST(Lens, RaysOfPixelsProjectBackOntoThem) {
  for (const Lens& lens : {Lens(), kPlumbBob, kRational, kFisheye}) {
    const LensCamera camera = camera_with(lens);
    for (double u = -0.5; u < camera.width; u += 16) {
      for (double v = -0.5; v < camera.height; v += 16) {
        const auto ray = camera.ray({u, v});
        ASSERT_TRUE(ray) << to_string(lens.model()) << u << " " << v;
        EXPECT_LT((*camera.project(*ray) - Vector2d(u, v)).norm(), 1e-9);
      }
    }
    const auto axis = camera.ray({camera.cx, camera.cy});
    EXPECT_LT((axis->normalized() - Vector3d::UnitZ()).norm(), 1e-12);
  }
}

TEST(Lens, AFisheyeSeesToTheSideAndBehindAndOthersDoNot) {
  const Lens ideal(LensModel::kEquidistant, {});
  const double angle = 110 * std::numbers::pi / 180;
  const Vector3d back(std::sin(angle), 0, std::cos(angle));
  EXPECT_NEAR(ideal.distort(back)->x(), angle, 1e-12);
  EXPECT_LT((*ideal.ray({angle, 0}) - back).norm(), 1e-12);
  EXPECT_FALSE(ideal.ray({3.2, 0}));  // beyond half a turn
  EXPECT_FALSE(kPlumbBob.distort(back));
  EXPECT_FALSE(Lens().distort(back));
  EXPECT_FALSE(kPlumbBob.distort({0, 0, 0}));
}

TEST(Lens, StopsWhereTheModelTurnsBack) {
  // r - r^3 / 3 grows up to r = 1.
  const Lens lens(LensModel::kPlumbBob, {-1.0 / 3, 0, 0, 0, 0});
  EXPECT_TRUE(lens.distort({0.99, 0, 1}));
  EXPECT_FALSE(lens.distort({1.01, 0, 1}));
  EXPECT_FALSE(lens.ray({0.67, 0}));
  EXPECT_NEAR(lens.ray({0.6, 0})->x() - std::pow(lens.ray({0.6, 0})->x(), 3) / 3, 0.6, 1e-12);
}

TEST(Lens, CoefficientsAreReadAsFilesListThem) {
  using Listed = std::vector<double>;
  const auto of = [](LensModel model, const Listed& listed) {
    return lens_coefficients(model, listed);
  };
  const LensCoefficients k3_missing{1, 2, 3, 4}, whole{1, 2, 3, 4, 5};
  EXPECT_EQ(of(LensModel::kPlumbBob, {1, 2, 3, 4}), k3_missing);
  EXPECT_EQ(of(LensModel::kPlumbBob, {1, 2, 3, 4, 5, 0, 0}), whole);
  EXPECT_EQ(of(LensModel::kNone, {}), LensCoefficients{});
  EXPECT_EQ(of(LensModel::kEquidistant, {1, 2, 3, 4, 0}), k3_missing);
  EXPECT_EQ(of(LensModel::kPlumbBob, {1, 2, 3}), std::nullopt);
  EXPECT_EQ(of(LensModel::kPlumbBob, {1, 2, 3, 4, 5, 6}), std::nullopt);
  EXPECT_EQ(of(LensModel::kEquidistant, {1, 2, 3}), std::nullopt);
  EXPECT_EQ(of(LensModel::kEquidistant, {1, 2, 3, std::nan("")}), std::nullopt);
  EXPECT_EQ(of(LensModel::kEquidistant, {1, 2, 3, 4, std::nan("")}), std::nullopt);
  EXPECT_EQ(of(LensModel::kEquidistant, {1, 2, 3, 1.1e6}), std::nullopt);
}

TEST(Lens, APinholeIsANumberOfPixels) {
  LensCamera camera{640, 480, 500, 500, 320, 240, {}};
  EXPECT_TRUE(camera.has_pinhole());
  for (const double focal : {0.0, -500.0, 2e5, std::nan("")}) {
    camera.fy = focal;
    EXPECT_FALSE(camera.has_pinhole()) << focal;
  }
  camera.fy = 500, camera.cx = std::nan("");
  EXPECT_FALSE(camera.has_pinhole());
}

TEST(Lens, SenselessCoefficientsGiveNoRayAndNoCrash) {
  for (const double k : {1e6, -1e6, 1e300, -1e300, std::nan("")}) {
    for (const LensModel model :
         {LensModel::kPlumbBob, LensModel::kRationalPolynomial, LensModel::kEquidistant}) {
      const Lens lens(model, {k, -k, k, k, k, k, k, -k});
      for (const double x : {0.0, 1e-3, 0.5, 2.0}) {
        const auto ray = lens.ray({x, -x});
        EXPECT_TRUE(!ray || ray->allFinite());
      }
      LensCamera camera = camera_with(lens);
      rectified_camera(camera, 1.7, 8192);
    }
  }
}

TEST(RectifiedCamera, OfAPinholeIsThePinhole) {
  const auto camera = rectified_camera(camera_with(Lens()), 0.1, 8192);
  ASSERT_TRUE(camera);
  EXPECT_EQ(camera->width, 640);
  EXPECT_EQ(camera->height, 480);
  EXPECT_EQ(camera->cx, 325.5);
  EXPECT_EQ(camera->fy, 410);
}

TEST(RectifiedCamera, HasNoPixelThatTheLensDidNotTakeAndLosesFew) {
  for (const Lens& lens : {kPlumbBob, kRational, kFisheye}) {
    SCOPED_TRACE(std::string(to_string(lens.model())));
    const LensCamera camera = camera_with(lens);
    const auto pinhole = rectified_camera(camera, 100 * std::numbers::pi / 180, 8192);
    ASSERT_TRUE(pinhole);
    const auto seen = [&](int u, int v) {
      const auto pixel =
          camera.project({(u - pinhole->cx) / pinhole->fx, (v - pinhole->cy) / pinhole->fy, 1});
      return pixel && camera.in_view(*pixel);
    };
    for (int v = 0; v < pinhole->height; ++v) {
      for (int u = 0; u < pinhole->width; ++u) ASSERT_TRUE(seen(u, v)) << u << " " << v;
    }
    // Each side could not lie further out.
    int beyond = 0;
    for (int u = 0; u < pinhole->width; ++u) beyond += !seen(u, -1) + !seen(u, pinhole->height);
    for (int v = 0; v < pinhole->height; ++v) beyond += !seen(-1, v) + !seen(pinhole->width, v);
    EXPECT_GT(beyond, 0);
    EXPECT_GT(pinhole->width, 560);
    EXPECT_GT(pinhole->height, 420);
  }
}

TEST(RectifiedCamera, IsNoWiderThanTheFieldOfViewAskedFor) {
  const double limit = 60 * std::numbers::pi / 180;
  const auto camera = rectified_camera(camera_with(kFisheye), limit, 8192);
  ASSERT_TRUE(camera);
  EXPECT_NEAR(camera->width, 2 * 400 * std::tan(limit / 2), 2);
  EXPECT_FALSE(rectified_camera(camera_with(kFisheye), limit, 300));  // longer than 300 pixels
}

}  // namespace fovea::lens_test
