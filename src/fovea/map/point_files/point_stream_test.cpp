#include "fovea/map/point_files/point_stream.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "../../../../tests/sample_map.h"
#include "../../../../tests/temporary_folder.h"
#include "fovea/errors.h"

namespace fovea::point_stream_test {

using ::testing::HasSubstr;

class PointStreamTest : public testing::Test {
 protected:
  void SetUp() override { write_sample_map(path()); }
  std::filesystem::path path() const { return folder_ / "a.fovea"; }
  /// All that the stream gives, after `before` was done between counting and streaming.
  std::vector<ExportPoint> all(const PointChoice& choice,
                               const std::function<void()>& before = {}) {
    const MapReader map(path());
    const PointStream stream(map, choice);
    if (before) before();
    std::vector<ExportPoint> points;
    stream.for_each_block([&](std::span<const ExportPoint> block) {
      points.insert(points.end(), block.begin(), block.end());
    });
    EXPECT_EQ(points.size(), stream.figures().points);
    return points;
  }
  void change(const std::function<void(MapWriter&)>& f) const {
    const auto writer = MapWriter::open(path());
    f(*writer);
    writer->commit();
  }
  TemporaryFolder folder_;
};

TEST_F(PointStreamTest, GivesEveryColumn) {
  const std::vector<ExportPoint> points = all({.include_uncolored = true});
  const ColorDisplay display = color_display({}, MapReader(path()).frames());
  std::size_t row = 0;
  for_each_sample_point([&](const Eigen::Vector3d& p_local, const PointCloud& tile, std::size_t i) {
    const ExportPoint& point = points.at(row++);
    EXPECT_EQ(point.position, p_local);
    EXPECT_EQ(point.color, tile.camera[i] == kNoCamera ? kUncolored : display(tile.color[i]));
    EXPECT_EQ(point.camera, tile.camera[i]);
    EXPECT_EQ(point.frame, tile.frame[i]);
    EXPECT_EQ(point.range, tile.range[i]);
    EXPECT_EQ(point.intensity, tile.intensity[i]);
    EXPECT_EQ(point.interpolated, tile.interpolated[i]);
    EXPECT_EQ(point.views, tile.views[i]);
    EXPECT_EQ(point.spread, tile.spread[i]);
    EXPECT_EQ(point.reason, tile.reason[i]);
  });
  EXPECT_EQ(row, points.size());
}

// What is written while a map grows is the map as it was when the export began.
TEST_F(PointStreamTest, CountsAndStreamsOneCommittedState) {
  PointChoice choice;
  choice.where = PointFilter::parse("range < 9");
  const std::size_t before = all(choice).size();
  const auto writer = MapWriter::open(path());
  const std::vector<ExportPoint> points = all(choice, [&] {
    RigidMotion moved = RigidMotion::Identity();
    moved.translation().x() = 1e4;
    writer->put_submap(0, moved);
    PointCloud more = one_point_each({{1, 1, 1}, {2, 2, 2}});
    more.intensity.assign(2, 0.f);
    more.origin = {400, 400, 400};
    writer->put_tile({1, {100, 100, 100}}, more);
    writer->commit();
  });
  EXPECT_EQ(points.size(), before);
  for (const ExportPoint& point : points) EXPECT_LT(point.position.norm(), 1e3);
  EXPECT_EQ(all(choice).size(), before + 2);
}

TEST_F(PointStreamTest, HandsOverBlocksOfBoundedSize) {
  change([](MapWriter& writer) {
    PointCloud big = one_point_each(std::vector<Eigen::Vector3f>(150'000, {1, 2, 3}));
    big.intensity.assign(big.size(), 0.5f);
    writer.put_tile({0, {0, 0, 0}}, big);
  });
  const MapReader map(path());
  const PointChoice choice;
  std::size_t largest = 0;
  PointStream(map, choice).for_each_block([&](std::span<const ExportPoint> block) {
    largest = std::max(largest, block.size());
  });
  EXPECT_EQ(largest, 65536u);
}

TEST_F(PointStreamTest, AMapSaysItselfWhetherItHasAPlaceOnEarth) {
  const auto needs_earth = [&] { return all({.crs = Crs::kUtm}); };
  EXPECT_FALSE(needs_earth().empty());
  change([](MapWriter& writer) { writer.put_meta("georeferenced", "0"); });
  try {
    needs_earth();
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("no georeference"));
    EXPECT_THAT(error.what(), HasSubstr("--crs local"));
  }
  change([](MapWriter& writer) {
    writer.put_meta("georeferenced", "1");
    writer.put_meta("origin.latitude_deg", "49\nproperty");
  });
  EXPECT_THROW(needs_earth(), InputError);
  EXPECT_FALSE(all({}).empty());
}

TEST_F(PointStreamTest, RefusesPositionsThatAreNotFinite) {
  change([](MapWriter& writer) {
    RigidMotion far = RigidMotion::Identity();
    far.translation().x() = 1e308;
    far.linear() *= 1e308;
    writer.put_submap(0, far);
  });
  EXPECT_THROW(all({}), InputError);
}

}  // namespace fovea::point_stream_test
