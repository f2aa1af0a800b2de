#include "fovea/core/scratch_file.h"

#include <gtest/gtest.h>

#include <Eigen/Core>

namespace fovea::scratch_file_test {

TEST(ScratchFile, WhatWasWrittenIsReadAgainInAnyOrder) {
  ScratchFile file;
  std::vector<ScratchFile::Place> places;
  for (int i = 0; i < 20; ++i) {
    places.push_back(file.append(
        std::vector<Eigen::Vector3f>(std::size_t(i * 1000), Eigen::Vector3f(1, 2, float(i)))));
  }
  const auto number = file.append(std::vector<int>{7});
  for (int i = 19; i >= 0; --i) {
    const auto values = file.read<Eigen::Vector3f>(places[std::size_t(i)]);
    ASSERT_EQ(values.size(), std::size_t(i * 1000));
    for (const Eigen::Vector3f& value : values) ASSERT_EQ(value, Eigen::Vector3f(1, 2, float(i)));
  }
  EXPECT_EQ(file.read<int>(number), std::vector<int>{7});
}

}  // namespace fovea::scratch_file_test
