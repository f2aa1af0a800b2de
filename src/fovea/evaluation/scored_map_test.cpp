#include "fovea/evaluation/scored_map.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

#include "../../../tests/peak_memory.h"
#include "fovea/errors.h"
#include "fovea/map/point_files/ply_reader.h"

namespace fovea::scored_map_test {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;

class ScoredMapTest : public testing::Test {
 protected:
  ScoredMapTest() {
    folder_ = std::filesystem::temp_directory_path() /
              ("fovea_scored_map_" + std::to_string(::getpid()) + "_" +
               testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::create_directories(folder_);
  }
  ~ScoredMapTest() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path write(const std::string& name, const std::string& content) const {
    std::ofstream(folder_ / name, std::ios::binary) << content;
    return folder_ / name;
  }

  template <class T>
  static void put(std::string& bytes, T value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
  }

  void expect_rejected(const std::string& content, const std::string& why) const {
    const std::filesystem::path file = write("bad.ply", content);
    EXPECT_THAT([&] { read_ply(file, Eigen::Vector3d::Zero()); },
                ThrowsMessage<InputError>(HasSubstr(why)))
        << content;
  }

  std::filesystem::path folder_;
};

const std::string kAsciiHeader =
    "ply\nformat ascii 1.0\ncomment made by hand\nelement vertex 2\nproperty float x\n"
    "property float y\nproperty float z\nproperty uchar red\nproperty uchar green\n"
    "property uchar blue\nend_header\n";

TEST_F(ScoredMapTest, ReadsAsciiClouds) {
  const CloudFile ply =
      read_ply(write("a.ply", kAsciiHeader + "1 2 3 4 5 6\n-1.5 1e1 0 255 0 7"), {1, 1, 1});
  ASSERT_EQ(ply.points.size(), 2u);
  EXPECT_EQ(ply.points.origin, Eigen::Vector3d(1, 1, 1));
  EXPECT_THAT(ply.points.position,
              ElementsAre(Eigen::Vector3f(0, 1, 2), Eigen::Vector3f(-2.5f, 9, -1)));
  EXPECT_THAT(ply.points.color, ElementsAre(Rgb{4, 5, 6}, Rgb{255, 0, 7}));
  EXPECT_THAT(ply.points.camera, ElementsAre(0, 0));
  EXPECT_FALSE(ply.has_camera);
  EXPECT_TRUE(ply.points.frame.empty());
  EXPECT_TRUE(ply.points.interpolated.empty());
}

TEST_F(ScoredMapTest, ReadsBinaryCloudsWithAnyFurtherProperties) {
  std::string bytes =
      "ply\r\nformat binary_little_endian 1.0\r\nelement vertex 2\r\nproperty double x\r\n"
      "property double y\r\nproperty double z\r\nproperty float range\r\nproperty uint8 red\r\n"
      "property uint8 green\r\nproperty uint8 blue\r\nproperty char camera\r\nproperty int "
      "frame\r\nproperty uchar interpolated\r\n"
      "element face 1\r\nproperty list uchar int vertex_indices\r\nend_header\r\n";
  for (const int i : {0, 1}) {
    for (const double x : {500000.25 + i, 2.0, 3.0}) put(bytes, x);
    put(bytes, 7.5f);
    bytes += {1, 2, static_cast<char>(200)};
    put(bytes, static_cast<std::int8_t>(i == 0 ? 3 : kNoCamera));
    put(bytes, 100 + i);
    put(bytes, static_cast<std::uint8_t>(i));
  }
  const CloudFile ply = read_ply(write("b.ply", bytes + "face"), {500000, 0, 0});
  EXPECT_THAT(ply.points.position,
              ElementsAre(Eigen::Vector3f(0.25f, 2, 3), Eigen::Vector3f(1.25f, 2, 3)));
  EXPECT_THAT(ply.points.color, ElementsAre(Rgb{1, 2, 200}, Rgb{1, 2, 200}));
  EXPECT_THAT(ply.points.camera, ElementsAre(3, kNoCamera));
  EXPECT_THAT(ply.points.frame, ElementsAre(100, 101));
  EXPECT_THAT(ply.points.interpolated, ElementsAre(0, 1));
  EXPECT_TRUE(ply.has_camera);
}

TEST_F(ScoredMapTest, CloudsWithoutColorsAreUncoloured) {
  const CloudFile ply =
      read_ply(write("c.ply",
                     "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
                     "property float z\nend_header\n1 2 3\n"),
               Eigen::Vector3d::Zero());
  EXPECT_THAT(ply.points.camera, ElementsAre(kNoCamera));
}

TEST_F(ScoredMapTest, ManyPropertiesTakeNoMemoryWhereThereAreFewVertices) {
  std::string bytes =
      "ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty double x\n"
      "property double y\nproperty double z\n";
  for (int i = 0; i < 900; ++i) bytes += "property double a\n";
  bytes += "end_header\n" + std::string(8 * 903, '\0');
  const auto file = write("many.ply", bytes);
  EXPECT_LT(rise_of_peak_memory([&] { read_ply(file, {0, 0, 0}); }), kMemoryOfASmallFile);
}

TEST_F(ScoredMapTest, RejectsMalformedClouds) {
  expect_rejected("", "no PLY file");
  expect_rejected("plyformat", "no PLY file");
  expect_rejected("ply\nformat ascii 1.0\n", "ends early");
  expect_rejected("ply\nend_header\n", "lacks format");
  expect_rejected("ply\nformat binary_big_endian 1.0\n", "binary_big_endian");
  expect_rejected("ply\nformat ascii 1.0\nelement face 1\n", "first element");
  expect_rejected("ply\nformat ascii 1.0\nelement vertex x\n", "count");
  expect_rejected("ply\nformat ascii 1.0\nelement vertex 1\nproperty list uchar int a\n", "list");
  expect_rejected("ply\nformat ascii 1.0\nelement vertex 0\nend_header\n", "no x");
  std::string header = kAsciiHeader;
  const std::string kTwoVertices = "1 2 3 4 5 6\n1 2 3 4 5 6\n";
  expect_rejected(kAsciiHeader + "1 2 3 4 5 6\n1.25 2 3 4 5\n", "bad.ply:13");
  expect_rejected(kAsciiHeader + "1 2 3 4 5 6\n1 2 3 4 5 256\n", "0-255");
  expect_rejected(kAsciiHeader + "1 2 3 4 5 6\n1 nan 3 4 5 6\n", "point 1");
  expect_rejected(kAsciiHeader + "1 2 3 4 5 6\n", "too short");
  header.replace(header.find("vertex 2"), 8, "vertex 99999999999999");
  expect_rejected(header + "1 2 3 4 5 6\n", "too short");
  header = kAsciiHeader;
  header.replace(header.find("float y"), 7, "uchar y");
  expect_rejected(header, "float or double");
  header = kAsciiHeader;
  header.replace(header.find("uchar red"), 9, "float red");
  expect_rejected(header + kTwoVertices, "uchar");
  header = kAsciiHeader;
  header.replace(header.find("uchar blue"), 10, "uchar hue");
  expect_rejected(header + kTwoVertices, "not all there");
  expect_rejected(
      "ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty float x\n"
      "property float y\nproperty float z\nend_header\n12345678901",
      "too short");
  EXPECT_THROW(read_ply(folder_ / "missing.ply", Eigen::Vector3d::Zero()), InputError);
  EXPECT_THROW(read_ply(folder_, Eigen::Vector3d::Zero()), InputError);
}

TEST_F(ScoredMapTest, ACloudComesWithItsPoses) {
  ScoredMapOptions options;
  const auto cloud = write("d.ply", kAsciiHeader + "101 2 3 4 5 6\n1 2 3 4 5 6\n");
  EXPECT_THROW(load_scored_map(cloud, options), ConfigError);
  options.poses = write("poses.txt", "1 0 0 100 0 1 0 0 0 0 1 0\n0 -1 0 102 1 0 0 0 0 0 1 0\n");
  options.first_frame = 30;
  const ScoredMap map = load_scored_map(cloud, options);
  EXPECT_FALSE(map.statuses_known);
  EXPECT_TRUE(map.cameras.empty());
  ASSERT_EQ(map.frames.size(), 2u);
  EXPECT_EQ(map.frames[1].index, 31);
  EXPECT_EQ(map.frames[1].T_local_lidar.translation().x(), 102);
  EXPECT_NEAR(map.frames[1].T_local_lidar.linear()(1, 0), 1, 1e-12);
  EXPECT_EQ(map.points_local.origin, Eigen::Vector3d(101, 0, 0));
  EXPECT_EQ(map.points_local.position[0], Eigen::Vector3f(0, 2, 3));
  options.poses = write("poses.txt", "1 0 0\n");
  EXPECT_THROW(load_scored_map(cloud, options), InputError);
}

TEST_F(ScoredMapTest, CompressedLasIsRefusedWithAWayOut) {
  for (const char* name : {"a.laz", "a.LAZ"}) {
    EXPECT_THAT([&] { load_scored_map(write(name, "x"), {}); },
                ThrowsMessage<InputError>(HasSubstr("laszip")));
  }
}

TEST_F(ScoredMapTest, TheContentOfACloudDecidesItsFormat) {
  const auto poses = write("poses.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n");
  const std::string pcd =
      "FIELDS x y z rgb\nSIZE 4 4 4 4\nTYPE F F F U\nWIDTH 1\nHEIGHT 1\nDATA ascii\n1 2 3 66051\n";
  for (const char* name : {"a.pcd", "a.PCD", "a.ply", "a.las", "a"}) {
    const ScoredMap map = load_scored_map(write(name, pcd), {.poses = poses});
    EXPECT_THAT(map.points_local.color, ElementsAre(Rgb{1, 2, 3}));
  }
  for (const char* name : {"a.ply", "a.fovea"}) {
    EXPECT_THAT([&] { load_scored_map(write(name, "ASTM-E57 and more"), {.poses = poses}); },
                ThrowsMessage<InputError>(HasSubstr("an E57 point cloud, neither a map nor")));
  }
  const std::string ply =
      "ply \nformat ascii 1.0\nelement vertex 1\nproperty float X\nproperty float Y\n"
      "property float Z\nproperty uchar Red\nproperty uchar Green\nproperty uchar Blue\n"
      "end_header\n1 2 3 4 5 6\n";
  const ScoredMap map = load_scored_map(write("a.ply", ply), {.poses = poses});
  EXPECT_THAT(map.points_local.color, ElementsAre(Rgb{4, 5, 6}));
}

TEST_F(ScoredMapTest, LoadsAFoveaMap) {
  const std::filesystem::path file = folder_ / "m.fovea";
  {
    const auto writer = MapWriter::create(file, false);
    FrameRecord record;
    record.index = 4;
    record.status = FrameStatus::kHeldOut;
    record.T_local_lidar.translation() = Eigen::Vector3d(1000, 0, 0);
    writer->put_frame(record);
    TileMap tiles;
    tiles.add_submap(RigidMotion(Eigen::Translation3d(1000, 0, 0)));
    PointCloud points;
    points.origin = {1000, 0, 0};
    points.position = {{1, 2, 3}, {-20, 0, 0}};
    points.color = {{1, 2, 3}, {0, 0, 0}};
    points.camera = {3, kNoCamera};
    points.frame = {5, 6};
    points.range.assign(2, 1);
    points.incidence.assign(2, 0);
    points.interpolated = {0, 1};
    points.views = {1, 1};
    points.spread = {0, 0};
    points.weight = {1, 1};
    points.reason = {0, reason_of(PointRule::kPlanar)};
    tiles.add(points);
    writer->put_submap(0, tiles.submaps()[0].T_local_submap);
    for (const auto& [key, tile] : tiles.submaps()[0].tiles)
      writer->put_tile({0, key}, *tile.points);
    writer->put_meta("cameras", "3");
    writer->commit();
  }
  const ScoredMap map = load_scored_map(file, {});
  EXPECT_TRUE(map.statuses_known);
  EXPECT_THAT(map.cameras, ElementsAre(3));
  EXPECT_EQ(map.frames.at(0).status, FrameStatus::kHeldOut);
  EXPECT_EQ(map.meta.at("cameras"), "3");
  ASSERT_EQ(map.points_local.size(), 2u);
  EXPECT_EQ(map.points_local.origin, Eigen::Vector3d(1000, 0, 0));
  const std::size_t coloured = map.points_local.camera[0] == 3 ? 0 : 1;
  EXPECT_TRUE(map.points_local.position[coloured].isApprox(Eigen::Vector3f(1, 2, 3), 1e-5f));
  EXPECT_EQ(map.points_local.color[coloured], (Rgb{1, 2, 3}));
  EXPECT_EQ(map.points_local.frame[coloured], 5);
  ASSERT_EQ(map.points_local.interpolated.size(), 2u);
  EXPECT_EQ(map.points_local.interpolated[coloured], 0);
  EXPECT_EQ(map.points_local.interpolated[1 - coloured], 1);
  EXPECT_EQ(map.points_local.reason[1 - coloured], reason_of(PointRule::kPlanar));
  ScoredMapOptions with_poses;
  with_poses.poses = "poses.txt";
  EXPECT_THROW(load_scored_map(file, with_poses), ConfigError);
}

}  // namespace fovea::scored_map_test
