#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <fstream>

#include "../../../../tests/file_content.h"
#include "../../../../tests/file_size_limit.h"
#include "../../../../tests/sample_map.h"
#include "../../../../tests/temporary_folder.h"
#include "fovea/core/parallel.h"
#include "fovea/errors.h"
#include "fovea/exporting/mesh/mesh_file_writer.h"
#include "fovea/exporting/mesh/mesh_tileset_writer.h"

namespace fovea::mesh_writers_test {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

void write_map(const std::filesystem::path& path, const PointCloud& points) {
  TileMap map(4.0);
  map.add_submap(RigidMotion(Eigen::Translation3d(3, -2, 1)));
  if (!points.empty()) map.add(points);
  const auto writer = MapWriter::create(path, true);
  writer->put_meta("map.tile_size_m", "4");
  FrameRecord frame;
  frame.T_local_lidar.translation() = Eigen::Vector3d(0, 0, 5);
  writer->put_frame(frame);
  writer->put_submap(0, map.submaps()[0].T_local_submap);
  for (const auto& [key, tile] : map.submaps()[0].tiles) writer->put_tile({0, key}, *tile.points);
  writer->commit();
}

PointCloud points_at(const std::vector<Eigen::Vector3f>& positions) {
  PointCloud points = one_point_each(positions);
  points.frame.assign(positions.size(), 0);
  return points;
}

/// 30 m x 4 m of ground, over three blocks.
PointCloud ground() {
  std::vector<Eigen::Vector3f> positions;
  for (int i = 0; i < 750; ++i) {
    for (int k = 0; k < 100; ++k) {
      const float x = 0.04f * float(i);
      positions.emplace_back(x, 0.04f * float(k), 0.3f * std::sin(x));
    }
  }
  return points_at(positions);
}

struct MeshWriters : testing::Test {
  TemporaryFolder folder;
  std::filesystem::path map_path = folder / "map.fovea";
};

TEST_F(MeshWriters, ATilesetWithLevels) {
  write_map(map_path, ground());
  const MeshTilesetFigures figures =
      write_mesh_tileset(MapReader(map_path), folder / "mesh", {.voxel = 0.1});
  EXPECT_EQ(figures.points, 75'000u);
  EXPECT_EQ(figures.without_frame, 0u);
  EXPECT_EQ(figures.uncolored_vertices, 0u);
  EXPECT_GT(figures.triangles, 20'000u);
  const auto files = contents(folder / "mesh");
  EXPECT_EQ(files.size(), figures.tiles + 1);
  const std::string& json = files.at("tileset.json");
  EXPECT_THAT(json, HasSubstr(R"("geometricError":0.2,"content")"));
  EXPECT_THAT(json, HasSubstr(R"("geometricError":0,"content")"));
  for (const auto& [name, bytes] : files) {
    if (name == "tileset.json") continue;
    EXPECT_EQ(bytes.substr(0, 4), "glTF");
    std::uint32_t length = 0;
    std::memcpy(&length, bytes.data() + 8, sizeof length);
    EXPECT_EQ(length, bytes.size());
    EXPECT_THAT(json, HasSubstr(name));
  }
}

TEST_F(MeshWriters, TheSameBytesAtAnyNumberOfThreads) {
  write_map(map_path, ground());
  const MapReader map(map_path);
  std::vector<std::map<std::string, std::string>> tilesets;
  std::vector<std::string> single;
  for (const int threads : {1, 2, 4}) {
    const ThreadLimit limit(threads);
    write_mesh_tileset(map, folder / "mesh", {.voxel = 0.2, .force = true});
    write_mesh_file(map, folder / "mesh.glb", {.voxel = 0.2, .force = true});
    tilesets.push_back(contents(folder / "mesh"));
    single.push_back(content(folder / "mesh.glb"));
  }
  EXPECT_TRUE(tilesets[0] == tilesets[1] && tilesets[0] == tilesets[2]);
  EXPECT_TRUE(single[0] == single[1] && single[0] == single[2]);
  EXPECT_GT(single[0].size(), 100'000u);
}

TEST_F(MeshWriters, LargerVoxelsMakeASmallerFile) {
  write_map(map_path, ground());
  const MapReader map(map_path);
  const MeshFigures fine = write_mesh_file(map, folder / "fine.glb", {.voxel = 0.1});
  const MeshFigures coarse = write_mesh_file(map, folder / "coarse.glb", {.voxel = 0.4});
  EXPECT_GT(fine.triangles, 10 * coarse.triangles);
  EXPECT_GT(content(folder / "fine.glb").size(), 10 * content(folder / "coarse.glb").size());
}

TEST_F(MeshWriters, MapsWithoutASurface) {
  const std::vector<std::vector<Eigen::Vector3f>> maps = {{}, {{1, 2, 3}}};
  for (const auto& positions : maps) {
    write_map(map_path, points_at(positions));
    const MapReader map(map_path);
    const MeshTilesetFigures figures = write_mesh_tileset(map, folder / "mesh", {.force = true});
    EXPECT_EQ(figures.tiles, 0u);
    EXPECT_EQ(figures.lonely_cells, positions.size());
    EXPECT_THAT(content(folder / "mesh/tileset.json"), ::testing::Not(HasSubstr("content")));
    write_mesh_file(map, folder / "mesh.glb", {.force = true});
    EXPECT_THAT(content(folder / "mesh.glb"), HasSubstr(R"("scenes":[{}])"));
  }
}

TEST_F(MeshWriters, PointsWithoutColourAreGreyOrLeftOut) {
  PointCloud points = ground();
  points.camera.assign(points.size(), kNoCamera);
  write_map(map_path, points);
  const MapReader map(map_path);
  const MeshFigures without = write_mesh_file(map, folder / "without.glb");
  EXPECT_EQ(without.triangles, 0u);
  EXPECT_EQ(without.uncolored_left_out, 75'000u);
  const MeshFigures with = write_mesh_file(map, folder / "with.glb",
                                           {.points = {.include_uncolored = true}, .voxel = 0.1});
  EXPECT_GT(with.triangles, 20'000u);
  EXPECT_GT(with.uncolored_vertices, 10'000u);
}

TEST_F(MeshWriters, PointsOfUnknownFramesAreCounted) {
  PointCloud points = ground();
  for (std::size_t i = 0; i < 1000; ++i) points.frame[i] = 77;
  write_map(map_path, points);
  EXPECT_EQ(write_mesh_file(MapReader(map_path), folder / "mesh.glb").without_frame, 1000u);
}

TEST_F(MeshWriters, OnlyPointsThatAreAskedFor) {
  write_map(map_path, ground());
  const MeshFigures figures =
      write_mesh_file(MapReader(map_path), folder / "mesh.glb",
                      {.points = {.where = PointFilter::parse("views > 5")}});
  EXPECT_EQ(figures.points, 0u);
  EXPECT_EQ(figures.filtered_out, 75'000u);
  EXPECT_EQ(figures.triangles, 0u);
}

TEST_F(MeshWriters, AnySampleMapIsSound) {
  write_sample_map(map_path);  // noise, most of it of frames that the map does not have
  const MeshTilesetFigures figures = write_mesh_tileset(
      MapReader(map_path), folder / "mesh", {.points = {.include_uncolored = true}, .voxel = 2});
  EXPECT_EQ(figures.points, 4000u);
  EXPECT_EQ(figures.without_frame, 4000u - 6);
}

TEST_F(MeshWriters, WhatIsThereStaysAndNothingIsHalfWritten) {
  write_map(map_path, ground());
  const MapReader map(map_path);
  std::ofstream(folder / "mesh.glb") << "mine";
  EXPECT_THROW(write_mesh_file(map, folder / "mesh.glb"), OutputError);
  EXPECT_EQ(content(folder / "mesh.glb"), "mine");
  std::filesystem::create_directory(folder / "mesh");
  std::ofstream(folder / "mesh/diary.txt") << "mine";
  EXPECT_THROW(write_mesh_tileset(map, folder / "mesh", {.force = true}), OutputError);
  EXPECT_THROW(write_mesh_file(map, folder / "other.glb", {.voxel = 0}), ConfigError);
  EXPECT_THROW(write_mesh_tileset(map, folder / "other", {.voxel = 1e9}), ConfigError);
  EXPECT_THAT(folder.names(), ElementsAre("map.fovea", "mesh", "mesh.glb"));
}

TEST_F(MeshWriters, AFullDiskLeavesNoFile) {
  write_map(map_path, ground());
  const MapReader map(map_path);
  {
    const FileSizeLimit limit(10'000);
    EXPECT_THROW(write_mesh_file(map, folder / "mesh.glb"), OutputError);
    EXPECT_THROW(write_mesh_tileset(map, folder / "mesh"), OutputError);
  }
  EXPECT_THAT(folder.names(), ElementsAre("map.fovea"));
}

}  // namespace fovea::mesh_writers_test
