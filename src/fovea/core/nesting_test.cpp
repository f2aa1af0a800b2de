#include "fovea/core/nesting.h"

#include <gtest/gtest.h>

#include <string>

namespace fovea::nesting_test {

std::string repeated(const std::string& part, int count) {
  std::string text;
  for (int i = 0; i < count; ++i) text += part;
  return text;
}

TEST(Nesting, BracketsAndDotsAreLevels) {
  EXPECT_EQ(nesting_depth(""), 0u);
  EXPECT_EQ(nesting_depth("a = 1"), 0u);
  EXPECT_EQ(nesting_depth("a.b.c = 1"), 2u);
  EXPECT_EQ(nesting_depth("[a.b]\nc.d = 1.5"), 2u);
  EXPECT_EQ(nesting_depth("a = [[1, 2], [3]]"), 2u);
  EXPECT_EQ(nesting_depth("a.b = { c.d = [1] }"), 4u);
  EXPECT_EQ(nesting_depth("{\"a\": [1, {\"b\": []}]}"), 4u);
  EXPECT_EQ(nesting_depth(repeated("a.", 50'000) + "a = 1"), 50'000u);
  EXPECT_EQ(nesting_depth("a = " + repeated("[", 1000)), 1000u);
  EXPECT_EQ(nesting_depth(repeated("{a.a.a = ", 100)), 300u);
}

TEST(Nesting, WhatIsNotNestedIsNotDeep) {
  EXPECT_LE(nesting_depth("a = [" + repeated("1.5, ", 10'000) + "]"), 2u);
  EXPECT_LE(nesting_depth(repeated("a = [1, 2]\nb.c = 1.5\n", 10'000)), 2u);
  EXPECT_EQ(nesting_depth("# " + repeated("[.", 1000)), 0u);
  EXPECT_EQ(nesting_depth("a = \"" + repeated("[.", 1000) + "\""), 0u);
  EXPECT_EQ(nesting_depth("a = '" + repeated("[.", 1000) + "'"), 0u);
  EXPECT_EQ(nesting_depth("a = \"\"\"\n" + repeated("[.\n", 1000) + "\"\"\""), 0u);
}

TEST(Nesting, NothingHidesBehindAString) {
  const std::string deep = "\nb = " + repeated("[", 100);
  for (const char* before :
       {"a = \"\"", "a = ''", "a = \"\\\"\"", "a = \"\\\\\"", "a = 'x\\'", "a = \"\"\"x\"\"\"",
        "a = \"\"\"x\"\"\"\"", "a = \"\"\"x\"\"\"\"\"", "a = '''x'''", "a = \"\"\"\\\"\"\"\"",
        "'a' = 1 # \"", "a = \"#\" # '''", "a = '''\n'''", "\"a\".b = 1"}) {
    EXPECT_GE(nesting_depth(before + deep), 100u) << before;
  }
}

}  // namespace fovea::nesting_test
