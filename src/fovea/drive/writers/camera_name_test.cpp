#include "fovea/drive/writers/camera_name.h"

#include <gtest/gtest.h>

namespace fovea::camera_name_test {

TEST(CameraName, IsAFoldersAndATablesToo) {
  for (const char* name : {"front", "Camera_2", "0", "a-b"}) EXPECT_TRUE(is_camera_name(name));
  for (const char* name : {"", "..", "a/b", "a.b", "a b", "ä", "a\n", "[x]"}) {
    EXPECT_FALSE(is_camera_name(name)) << name;
  }
}

}  // namespace fovea::camera_name_test
