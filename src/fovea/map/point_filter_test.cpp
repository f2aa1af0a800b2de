#include "fovea/map/point_filter.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "fovea/errors.h"

namespace fovea::point_filter_test {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

PointCloud four_points() {
  PointCloud points;
  points.position.resize(4);
  points.views = {0, 1, 2, 255};
  points.spread = {0, 5, 10, 20};
  points.range = {3.5f, 8, 10, 14};
  points.incidence = {0, 0.5f, std::numeric_limits<float>::quiet_NaN(), 1.2f};
  points.frame = {0, 1, 7, 7};
  points.camera = {kNoCamera, 2, 2, 3};
  points.interpolated = {0, 1, 1, 0};
  points.reason = {0, 1, 2 | kExposureMatched, kExposureMatched};
  return points;
}

std::vector<int> passing(const std::string& text) {
  const PointFilter filter = PointFilter::parse(text);
  const PointCloud points = four_points();
  std::vector<int> passed;
  for (int i = 0; i < 4; ++i) {
    const PointPlace place{{double(i), -2.0 * i, 0.5}, i - 0.5};
    if (filter.matches(points, std::size_t(i), place)) passed.push_back(i);
  }
  return passed;
}

TEST(PointFilter, EveryOperator) {
  EXPECT_THAT(passing("views>=2"), ElementsAre(2, 3));
  EXPECT_THAT(passing("views > 2"), ElementsAre(3));
  EXPECT_THAT(passing("views < 2"), ElementsAre(0, 1));
  EXPECT_THAT(passing("views <= 2"), ElementsAre(0, 1, 2));
  EXPECT_THAT(passing("frame == 7"), ElementsAre(2, 3));
  EXPECT_THAT(passing("frame = 1"), ElementsAre(1));
  EXPECT_THAT(passing("frame != 7"), ElementsAre(0, 1));
}

TEST(PointFilter, EveryField) {
  EXPECT_THAT(passing("spread < 10"), ElementsAre(0, 1));
  EXPECT_THAT(passing("range < 9.5"), ElementsAre(0, 1));
  EXPECT_THAT(passing("camera == -1"), ElementsAre(0));
  EXPECT_THAT(passing("interpolated == 0"), ElementsAre(0, 3));
  EXPECT_THAT(passing("incidence < 29"), ElementsAre(0, 1));  // 28.6 degrees
  EXPECT_THAT(passing("incidence < 28"), ElementsAre(0));
  EXPECT_THAT(passing("x >= 2"), ElementsAre(2, 3));
  EXPECT_THAT(passing("y < -3"), ElementsAre(2, 3));
  EXPECT_THAT(passing("z == 0.5 and x < 1"), ElementsAre(0));
  EXPECT_THAT(passing("height < 1"), ElementsAre(0, 1));
}

TEST(PointFilter, RulesByNameOrNumber) {
  EXPECT_THAT(passing("rule == measured"), ElementsAre(0, 3));
  EXPECT_THAT(passing("rule = short-edges"), ElementsAre(1));
  EXPECT_THAT(passing("rule == 2"), ElementsAre(2));
  EXPECT_THAT(passing("rule != planar"), ElementsAre(0, 1, 3));
  EXPECT_THAT(passing("rule == centroid"), ElementsAre());
  EXPECT_THAT(passing("matched == 1"), ElementsAre(2, 3));
  EXPECT_THAT(passing("matched = 0 and rule = measured"), ElementsAre(0));
}

TEST(PointFilter, UnknownValuesMeetNothing) {
  EXPECT_THAT(passing("incidence >= 0"), ElementsAre(0, 1, 3));
  EXPECT_THAT(passing("incidence != 0"), ElementsAre(1, 3));
  EXPECT_THAT(passing("intensity >= 0"), ElementsAre());  // the map has none
  EXPECT_FALSE(PointFilter::parse("height != 0").matches(four_points(), 0, {}));
}

TEST(PointFilter, ConditionsHoldTogether) {
  EXPECT_THAT(passing("views >= 1 and range < 12"), ElementsAre(1, 2));
  EXPECT_THAT(passing("views >= 1  and  range<12 and frame==7"), ElementsAre(2));
  EXPECT_TRUE(PointFilter().matches(four_points(), 0, {}));
  EXPECT_TRUE(PointFilter().empty());
}

TEST(PointFilter, SaysWhatItDoesNotUnderstand) {
  for (const char* text : {"",
                           " ",
                           "views",
                           "views >=",
                           ">= 2",
                           "view >= 2",
                           "views >= two",
                           "views >= 2 3",
                           "views => 2",
                           "views >= 2 and",
                           "and views >= 2",
                           "views >= 2 or range < 3",
                           "views >= nan",
                           "views >= 1e999",
                           "rule == flat",
                           "views == planar",
                           "X > 2",
                           "height",
                           "height < low",
                           "xy > 2",
                           "p.x < 2",
                           "views >= 2,range<3"}) {
    try {
      PointFilter::parse(text);
      ADD_FAILURE() << text;
    } catch (const ConfigError& error) {
      EXPECT_THAT(error.what(), HasSubstr("--where")) << text;
    }
  }
}

}  // namespace fovea::point_filter_test
