#include "fovea/geometry/voxel_table.h"

#include <gtest/gtest.h>

#include "fovea/core/random.h"

namespace fovea::voxel_table_test {

TEST(VoxelTable, NumbersVoxelsInTheOrderOfAppearance) {
  VoxelTable table(0.5f);
  Random random(1);
  std::vector<VoxelTable::Voxel> voxels;
  for (int i = 0; i < 5000; ++i) {
    const Eigen::Vector3f p(float(random.uniform(-900, 900)), float(random.uniform(-900, 900)),
                            float(i));
    voxels.push_back(table.voxel_of(p));
    EXPECT_EQ(table.insert(voxels.back()), i);
  }
  for (std::uint32_t i = 0; i < voxels.size(); ++i) {
    EXPECT_EQ(table.find(voxels[i]), i);
    EXPECT_EQ(table.insert(voxels[i]), i);
    EXPECT_EQ(table.voxel(i), voxels[i]);
  }
  EXPECT_EQ(table.find({0, 0, -1}), VoxelTable::kNone);
  EXPECT_EQ(table.voxel_of({-0.1f, 0.1f, 0.6f}), VoxelTable::Voxel(-1, 0, 1));
}

TEST(VoxelTable, KnowsWhatIsAroundAVoxel) {
  VoxelTable table(1);
  Random random(2);
  for (int i = 0; i < 600; ++i) {
    table.insert(
        {int(random.uniform(-6, 6)), int(random.uniform(-6, 6)), int(random.uniform(-6, 6))});
  }
  for (int i = 0; i < 300; ++i) {
    const VoxelTable::Voxel center(int(random.uniform(-9, 9)), int(random.uniform(-9, 9)),
                                   int(random.uniform(-9, 9)));
    std::vector<std::uint32_t> asked, found;
    for (const VoxelTable::Voxel& near : VoxelTable::block_around(center)) {
      if (table.find(near) != VoxelTable::kNone) asked.push_back(table.find(near));
    }
    table.for_each_around(center, [&](std::uint32_t id) { found.push_back(id); });
    EXPECT_EQ(found, asked);
  }
}

}  // namespace fovea::voxel_table_test
