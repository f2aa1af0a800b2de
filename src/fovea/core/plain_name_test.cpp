#include "fovea/core/plain_name.h"

#include <gtest/gtest.h>

namespace fovea::plain_name_test {

TEST(PlainName, IsAlsoThatOfAFolderOrATable) {
  for (const char* name : {"front", "Camera_2", "0", "a-b"}) EXPECT_TRUE(is_plain_name(name));
  for (const char* name : {"", "..", "a/b", "a.b", "a b", "ä", "a\n", "[x]"}) {
    EXPECT_FALSE(is_plain_name(name)) << name;
  }
}

}  // namespace fovea::plain_name_test
