#include "fovea/drive/hold_out.h"

#include <gtest/gtest.h>

#include "fovea/errors.h"

namespace fovea::hold_out_test {

TEST(HoldOut, EmptyHoldsNothing) {
  EXPECT_TRUE(HoldOut().none());
  EXPECT_TRUE(HoldOut::parse("").none());
  EXPECT_FALSE(HoldOut::parse("").contains(0));
}

TEST(HoldOut, EveryNth) {
  const HoldOut held = HoldOut::parse("8:4");
  EXPECT_FALSE(held.none());
  EXPECT_EQ(held.spec(), "8:4");
  std::vector<int> frames;
  for (int i = 0; i < 30; ++i) {
    if (held.contains(i)) frames.push_back(i);
  }
  EXPECT_EQ(frames, (std::vector<int>{4, 12, 20, 28}));
}

TEST(HoldOut, BlocksIncludeBothEnds) {
  const HoldOut held = HoldOut::parse("120-135,300-300");
  for (const int in : {120, 128, 135, 300}) EXPECT_TRUE(held.contains(in)) << in;
  for (const int out : {0, 119, 136, 299, 301}) EXPECT_FALSE(held.contains(out)) << out;
}

TEST(HoldOut, RejectsEverythingElse) {
  for (const char* spec : {":",       "8:",
                           ":4",      "8:8",
                           "8:-1",    "0:0",
                           "1:0",     "-8:4",
                           "8:4:2",   "8",
                           "1-",      "-5",
                           "5-3",     "1-2,",
                           ",1-2",    "1-2,,3-4",
                           "a-b",     "1-2x",
                           " 1-2",    "1 - 2",
                           "8:4,1-2", "99999999999-99999999999"}) {
    EXPECT_THROW(HoldOut::parse(spec), ConfigError) << spec;
  }
}

}  // namespace fovea::hold_out_test
