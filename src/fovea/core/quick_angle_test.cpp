#include "fovea/core/quick_angle.h"

#include <gtest/gtest.h>

#include "fovea/core/random.h"

namespace fovea::quick_angle_test {

TEST(QuickAngle, IsTheLibrarysAngle) {
  Random random(1);
  for (int i = 0; i < 200'000; ++i) {
    const double angle = random.uniform(-4, 4), radius = std::exp(random.uniform(-9, 9));
    const auto y = static_cast<float>(radius * std::sin(angle));
    const auto x = static_cast<float>(radius * std::cos(angle));
    ASSERT_NEAR(quick_atan2(y, x), std::atan2(double(y), double(x)), 1e-6) << y << " " << x;
  }
}

TEST(QuickAngle, AxesAndDiagonals) {
  for (const float r : {1e-20f, 1.f, 1e20f}) {
    for (const auto& [y, x] : {std::pair(0.f, r),
                               {r, 0.f},
                               {0.f, -r},
                               {-r, 0.f},
                               {r, r},
                               {-r, r},
                               {r, -r},
                               {-r, -r},
                               {-0.f, -r}}) {
      EXPECT_NEAR(quick_atan2(y, x), std::atan2(double(y), double(x)), 1e-6) << y << " " << x;
    }
  }
  EXPECT_EQ(quick_atan2(0, 0), 0);
}

}  // namespace fovea::quick_angle_test
