#include "fovea/map/number_text.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>

#include "fovea/core/random.h"

namespace fovea::number_text_test {

TEST(NumberText, AnyFiniteDoubleReadsBack) {
  Random random(1);
  for (int i = 0; i < 20'000; ++i) {
    const auto value = std::bit_cast<double>(random.next());
    if (!std::isfinite(value)) continue;
    const std::vector<double> numbers = {value, -0.0};
    const auto back = numbers_from_text(to_text(numbers));
    ASSERT_TRUE(back && back->size() == 2);
    EXPECT_EQ(std::bit_cast<std::uint64_t>((*back)[0]), std::bit_cast<std::uint64_t>(value));
    EXPECT_TRUE(std::signbit((*back)[1]));
    EXPECT_EQ(numbers_from_json(to_json({{"x", value}}))->at("x"), value);
  }
}

TEST(NumberText, RefusesWhatIsNoNumber) {
  EXPECT_TRUE(numbers_from_text("")->empty());
  for (const char* text : {"1 x", "1,2", "nan", "inf 1", "1 2e999", "0x10", "1-2"}) {
    EXPECT_FALSE(numbers_from_text(text)) << text;
  }
  EXPECT_FALSE(motion_from_text("1 0 0 0 0 1 0 0 0 0 1"));
  EXPECT_FALSE(motion_from_text("1 0 0 0 0 1 0 0 0 0 1 0 0"));
  for (const char* text : {"", "1 2 3 4 5", "1 2 3 4 5 6 7", "1 2 3 4 5 6 7 8 9 10 11 12 13"}) {
    EXPECT_FALSE(sweep_motion_from_text(text)) << text;
  }
  EXPECT_EQ(motion_from_text("1 0 0 4 0 1 0 5 0 0 1 6")->translation(), Eigen::Vector3d(4, 5, 6));
}

TEST(NumberText, SweepMotionsHaveTheirAccelerationWhereThereIsOne) {
  SweepMotion motion;
  motion.velocity << 0.1, 0, -0.2, 9.5, 0, 1e-9;
  EXPECT_EQ(to_text(motion), "0.1 0 -0.2 9.5 0 1e-09");
  EXPECT_EQ(sweep_motion_from_text(to_text(motion)), motion);
  motion.acceleration << 1, 2, 3, 4, 5, 6;
  EXPECT_EQ(to_text(motion), "0.1 0 -0.2 9.5 0 1e-09 1 2 3 4 5 6");
  EXPECT_EQ(sweep_motion_from_text(to_text(motion)), motion);
}

TEST(NumberText, SweepMotionsHaveTheirPathWhereThereIsOne) {
  SweepMotion motion;
  motion.velocity << 1, 2, 3, 4, 5, 6;
  motion.path = SweepPath{-0.05, 0.005, {Twist::Constant(0.25), Twist::Constant(0.5)}};
  EXPECT_EQ(to_text(motion),
            "1 2 3 4 5 6 0 0 0 0 0 0 -0.05 0.005 0.25 0.25 0.25 0.25 0.25 0.25 0.5 0.5 0.5 0.5 0.5 "
            "0.5");
  EXPECT_EQ(sweep_motion_from_text(to_text(motion)), motion);
  motion.path->placements.pop_back();  // one place is no path
  EXPECT_FALSE(sweep_motion_from_text(to_text(motion)));
  for (const double step : {0.0, -0.1, 1e9}) {
    motion.path = SweepPath{0, step, {Twist::Zero(), Twist::Zero()}};
    EXPECT_FALSE(sweep_motion_from_text(to_text(motion))) << step;
  }
}

TEST(NumberText, JsonObjectsKeepNamesAndValues) {
  const std::map<std::string, double> numbers = {
      {"", 1}, {"a b", -0.5}, {"quote \" backslash \\ tab \t", 1e-300}, {"ünicode", 3}};
  EXPECT_EQ(numbers_from_json(to_json(numbers)), numbers);
  EXPECT_EQ(to_json({{"b", 0.1}, {"a", 1}}), R"({"a":1,"b":0.1})");
  EXPECT_EQ(to_json({}), "{}");
  EXPECT_EQ(to_json({{"n", std::nan("")}, {"o", -INFINITY}}), R"({"n":null,"o":null})");
  EXPECT_TRUE(std::isnan(numbers_from_json(R"({ "n" : null })")->at("n")));
}

TEST(NumberText, RefusesOtherJson) {
  for (const char* text : {"", "{", "[]", "{\"a\"}", "{\"a\":}", "{\"a\":1", "{\"a\":1,}", "{a:1}",
                           "{\"a\":\"1\"}", "{\"a\":1}x", "{\"a\":{}}", "{\"a", "{\"a\\",
                           "{\"\\u00", "{\"\\u12345\":1}", "{\"a\":inf}", "{\"a\":1e999}"}) {
    EXPECT_FALSE(numbers_from_json(text)) << text;
  }
}

}  // namespace fovea::number_text_test
