#include "fovea/live.h"

#include <gtest/gtest.h>

#include <chrono>

#include "../../../tests/temporary_folder.h"
#include "fovea/errors.h"

namespace fovea::api_live_test {

using std::chrono::milliseconds;

constexpr const char* kDrive = "version = 1\n[lidar]\ncompensated = true\nintensity_max = 1\n";

PointCloud scan() {
  PointCloud points;
  for (int i = 0; i < 100; ++i) points.position.emplace_back(5.f, 0.1f * float(i), 0.f);
  return points;
}

TEST(ApiLiveMapper, CountsWhatComes) {
  const TemporaryFolder folder;
  LiveMapper mapper(kDrive, folder / "a.fovea");
  mapper.add_scan(1, scan());
  mapper.add_scan(1, scan());
  const std::map<std::string, std::size_t> figures = mapper.figures();
  EXPECT_EQ(figures.at("scans"), 2u);
  EXPECT_EQ(figures.at("scans_out_of_order"), 1u);
  EXPECT_EQ(figures.at("images"), 0u);
}

TEST(ApiLiveMapper, EndsEarlyWithoutWaiting) {
  const TemporaryFolder folder;
  LiveMapper mapper(kDrive, folder / "a.fovea", {.max_wait = 60});
  mapper.stop();
  while (!mapper.close_within(milliseconds(10))) {
  }
  EXPECT_TRUE(mapper.close_within(milliseconds(0)));
  EXPECT_THROW(mapper.close(), Error);  // no scan came
  EXPECT_THROW(mapper.close(), Error);  // again
  EXPECT_THROW(mapper.add_scan(1, scan()), Error);
}

TEST(ApiLiveMapper, RefusesWhatCannotBe) {
  const TemporaryFolder folder;
  EXPECT_THROW(LiveMapper(kDrive, folder / "a.fovea", {.cameras = {3}}), InputError);
  LiveMapperOptions paper{.settings = {.preset = "paper"}};
  paper.on_pose = [](const LivePose&) {};
  EXPECT_THROW(LiveMapper(kDrive, folder / "a.fovea", paper), ConfigError);
  std::filesystem::create_directory(folder / "photos");
  EXPECT_THROW(LiveMapper(kDrive, folder / "a.fovea", {.record = folder / "photos"}), OutputError);
}

}  // namespace fovea::api_live_test
