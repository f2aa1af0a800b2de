#include "fovea/core/path_name.h"

#include <gtest/gtest.h>

namespace fovea::path_name_test {

TEST(PathName, IsTheLastPartHoweverItIsWritten) {
  for (const char* path :
       {"/a/drive", "/a/drive/", "/a/drive//", "/a/./drive/.", "/a/b/../drive"}) {
    EXPECT_EQ(name_of(path), "drive") << path;
  }
  EXPECT_EQ(name_of("."), std::filesystem::current_path().filename().string());
  EXPECT_EQ(name_of("a.fovea"), "a.fovea");
}

}  // namespace fovea::path_name_test
