#include "fovea/core/lanes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "fovea/core/random.h"

namespace fovea::lanes_test {

Lanes random_lanes(Random& random) {
  Lanes lanes;
  for (int i = 0; i < kLanes; ++i) lanes[i] = static_cast<float>(random.normal());
  return lanes;
}

TEST(Lanes, TheLeastIsThatOfAllLanes) {
  Random random(1);
  for (int round = 0; round < 100; ++round) {
    const Lanes lanes = random_lanes(random);
    float least = lanes[0];
    for (int i = 1; i < kLanes; ++i) least = std::min(least, lanes[i]);
    EXPECT_EQ(min_of_lanes(lanes), least);
  }
}

TEST(Lanes, SumsOfFourAreTheSumsOfEach) {
  Random random(2);
  for (int round = 0; round < 100; ++round) {
    std::array<Lanes, 4> all;
    for (Lanes& lanes : all) lanes = random_lanes(random);
    const HalfLanes sums = sums_of_lanes(all[0], all[1], all[2], all[3]);
    for (std::size_t k = 0; k < all.size(); ++k) {
      const Lanes& v = all[k];
      EXPECT_EQ(sums[k], ((v[0] + v[4]) + (v[1] + v[5])) + ((v[2] + v[6]) + (v[3] + v[7])))
          << "in the order that all processors keep";
      EXPECT_EQ(sum_of_lanes(v), sums[k]);
    }
  }
}

TEST(Lanes, EachLaneHasABit) {
  for (unsigned bits = 0; bits < 256; ++bits) {
    LaneMask mask{};
    for (unsigned lane = 0; lane < kLanes; ++lane) mask[lane] = (bits >> lane & 1) != 0 ? -1 : 0;
    EXPECT_EQ(bits_of(mask), bits);
  }
}

}  // namespace fovea::lanes_test
