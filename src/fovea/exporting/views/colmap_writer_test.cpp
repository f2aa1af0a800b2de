#include "fovea/exporting/views/colmap_writer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "../../../../tests/file_content.h"
#include "../../../../tests/temporary_folder.h"
#include "fovea/errors.h"
#include "fovea/exporting/views/view_test_map.h"

namespace fovea::colmap_writer_test {

using testing::ElementsAre;
using testing::HasSubstr;
using view_test::camera_of;

/// The lines of a file of COLMAP, without comments.
std::vector<std::string> lines_of(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) {
    if (line.empty() || line[0] != '#') lines.push_back(line);
  }
  return lines;
}

struct ColmapImage {
  int id = 0, camera = 0;
  double q[4] = {};  // w x y z
  Eigen::Vector3d t;
  std::string name;
};

ColmapImage image_of(const std::string& line) {
  std::istringstream in(line);
  ColmapImage image;
  in >> image.id;
  for (double& number : image.q) in >> number;
  in >> image.t.x() >> image.t.y() >> image.t.z() >> image.camera >> image.name;
  EXPECT_TRUE(in) << line;
  return image;
}

/// As COLMAP states it: x_cam = R(q) x_world + t, Hamilton's convention, w first.
Eigen::Vector3d to_camera(const ColmapImage& image, const Eigen::Vector3d& p) {
  const auto [w, x, y, z] = image.q;
  Eigen::Matrix3d R;
  R << 1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y),  //
      2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x),   //
      2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y);
  return R * p + image.t;
}

class ColmapWriter : public testing::Test {
 protected:
  ViewExportFigures write(const ViewExportOptions& options = {}) const {
    return write_colmap(MapReader(folder_ / "a.fovea"), folder_ / "a.fovea", folder_ / "out",
                        options);
  }
  std::filesystem::path model(const char* name) const {
    return folder_ / "out" / "sparse" / "0" / name;
  }
  TemporaryFolder folder_;
};

TEST_F(ColmapWriter, PointsProjectWhereTheCamerasOfTheMapShowThem) {
  const std::vector<Camera> cameras = {camera_of(2, 500), camera_of(3, 700)};
  view_test::write_map(folder_ / "a.fovea", cameras);
  const ViewExportFigures figures = write();
  EXPECT_EQ(figures.images, 6u);
  EXPECT_EQ(figures.held_out, 2u);

  const std::vector<std::string> camera_lines = lines_of(model("cameras.txt"));
  EXPECT_THAT(camera_lines, ElementsAre("1 PINHOLE 640 200 500 501 310.75 96.5",
                                        "2 PINHOLE 640 200 700 701 310.75 96.5"));
  const std::vector<std::string> lines = lines_of(model("images.txt"));
  ASSERT_EQ(lines.size(), 12u);  // each with an empty line of feature points
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_EQ(lines[2 * i + 1], "");
    const ColmapImage image = image_of(lines[2 * i]);
    const Camera& camera = cameras[i / 3];
    EXPECT_EQ(image.id, int(i) + 1);
    EXPECT_EQ(image.camera, int(i / 3) + 1);
    EXPECT_EQ(image.name, "camera_" + std::to_string(camera.index) + "_000000000" +
                              std::to_string(i % 3) + ".png");
    for (const Eigen::Vector3d& p : view_test::kPoints) {
      const Eigen::Vector3d p_cam = to_camera(image, p);
      const Eigen::Vector2d pixel(camera.fx * p_cam.x() / p_cam.z() + 310.75,
                                  camera.fy * p_cam.y() / p_cam.z() + 96.5);
      const Eigen::Vector2d expected = view_test::pixel_of(p, camera, int(i % 3));
      // COLMAP's pixel centers are at 0.5, ours at integers.
      EXPECT_LT((pixel - Eigen::Vector2d(0.5, 0.5) - expected).norm(), 1e-3);
    }
  }
}

TEST_F(ColmapWriter, HeldOutImagesAreListed) {
  view_test::write_map(folder_ / "a.fovea", {camera_of(2, 500)});
  write();
  EXPECT_THAT(lines_of(model("test.txt")), ElementsAre("camera_2_0000000001.png"));
}

TEST_F(ColmapWriter, OnePointOfEachCellIsKept) {
  view_test::write_map(folder_ / "a.fovea", {camera_of(2, 500)});
  const ViewExportFigures figures = write();
  EXPECT_EQ(figures.points, 3u);
  EXPECT_EQ(figures.thinned_out, 1u);
  EXPECT_THAT(lines_of(model("points3D.txt")),
              ElementsAre("1 1.0000 1.0000 1.0000 1 2 3 0", "2 2.0000 1.0000 1.0000 1 2 3 0",
                          "3 3.0000 3.0000 3.0000 1 2 3 0"));
}

TEST_F(ColmapWriter, WhatTheMapLacksIsAnErrorAndNothingIsWritten) {
  const auto error = [&](const std::vector<Camera>& cameras, bool states_cameras) -> std::string {
    view_test::write_map(folder_ / "a.fovea", cameras, states_cameras);
    try {
      write();
    } catch (const InputError& thrown) {
      EXPECT_FALSE(std::filesystem::exists(folder_ / "out"));
      EXPECT_FALSE(std::filesystem::exists(folder_ / "out.partial"));
      return thrown.what();
    }
    return "written";
  };
  EXPECT_THAT(error({camera_of(2, 500)}, false), HasSubstr("--drive"));
  EXPECT_THAT(error({}, true), HasSubstr("no frame with an image"));
  Camera unknown_size = camera_of(2, 500);
  unknown_size.width = 0;
  EXPECT_THAT(error({unknown_size}, true), HasSubstr("size of camera 2"));
}

TEST_F(ColmapWriter, AFolderIsReplacedByForceAlone) {
  view_test::write_map(folder_ / "a.fovea", {camera_of(2, 500)});
  write();
  EXPECT_THROW(write(), OutputError);
  EXPECT_NO_THROW(write({.force = true}));
  std::ofstream(folder_ / "out" / "notes.txt") << "mine";
  EXPECT_THROW(write({.force = true}), OutputError);
}

}  // namespace fovea::colmap_writer_test
