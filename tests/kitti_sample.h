// Where tests find the real drive; KITTI's licence keeps it out of this project.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>

namespace fovea {

/// Folder of the sample drive: $FOVEA_KITTI_SAMPLE, or beside the project; empty if it is not
/// there.
inline std::optional<std::filesystem::path> kitti_sample() {
  const char* from_environment = std::getenv("FOVEA_KITTI_SAMPLE");
  const std::filesystem::path path =
      from_environment != nullptr ? from_environment
                                  : FOVEA_SOURCE_DIR
          "/../shared/data/kitti/2011_09_26/2011_09_26_drive_0009_sync";
  if (!std::filesystem::is_directory(path)) return std::nullopt;
  return path;
}

inline bool kitti_required() {
  const char* required = std::getenv("FOVEA_REQUIRE_KITTI");
  return required != nullptr && std::string(required) == "1";
}

}  // namespace fovea

/// Declares `variable` as the sample drive's path; without it the test is skipped, or fails where
/// FOVEA_REQUIRE_KITTI=1 says that it must be there.
#define FOVEA_KITTI_SAMPLE_OR_SKIP(variable)                                               \
  const auto variable##_found = ::fovea::kitti_sample();                                   \
  if (!variable##_found) {                                                                 \
    if (::fovea::kitti_required()) FAIL() << "FOVEA_REQUIRE_KITTI=1, but no sample drive"; \
    GTEST_SKIP() << "no KITTI sample drive (set FOVEA_KITTI_SAMPLE)";                      \
  }                                                                                        \
  const std::filesystem::path variable = *variable##_found
