// fovea export --format colmap and nerf, from a simulated drive to what COLMAP reads.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>

#include "fovea/drive/images/image_decode.h"
#include "fovea/drive/writers/png_encode.h"
#include "fovea/map/map_store.h"
#include "fovea/simulation/simulate.h"
#include "tests/half_size_street.h"
#include "tests/program.h"

namespace fovea::view_synthesis_program_test {

using testing::HasSubstr;
namespace fs = std::filesystem;

constexpr int kFrames = 12;

class ViewSynthesisProgram : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    scratch_ = std::make_unique<TemporaryFolder>();
    simulate(half_size_street(kFrames), *scratch_ / "street");
    succeed(
        fmt::format("map '{}' -o '{}' --hold-out 8:4 --quiet", path("street"), path("m.fovea")));
  }
  static void TearDownTestSuite() { scratch_.reset(); }

  static std::string path(const std::string& name) { return (*scratch_ / name).string(); }
  static ProgramRun export_map(const std::string& format, const std::string& output,
                               const std::string& more) {
    return run_fovea(fmt::format("export '{}' '{}' --format {} --force {}", path("m.fovea"),
                                 path(output), format, more));
  }
  static std::string with_drive() { return fmt::format("--drive '{}'", path("street")); }
  static void succeed(const std::string& command) {
    const ProgramRun run = run_fovea(command);
    ASSERT_EQ(run.exit_code, 0) << command << "\n" << run.err;
  }

  static inline std::unique_ptr<TemporaryFolder> scratch_;
};

namespace {

/// Runs COLMAP with its output in a file; the exit code.
int run_colmap(const std::string& arguments, const std::string& output) {
  const std::string command =
      fmt::format("QT_QPA_PLATFORM=offscreen colmap {} >'{}' 2>&1", arguments, output);
  return std::system(command.c_str());
}

bool has_colmap() { return std::system("command -v colmap >/dev/null 2>&1") == 0; }

/// The number after a label of a report, such as "Images: 12"; NaN without it.
double number_after(const std::string& text, const std::string& label) {
  const auto at = text.find(label);
  return at == std::string::npos ? NAN : std::strtod(text.c_str() + at + label.size(), nullptr);
}

}  // namespace

#define FOVEA_COLMAP_OR_SKIP()                                                                 \
  if (!has_colmap()) {                                                                         \
    GTEST_SKIP() << "COLMAP is not installed: apt-get install --no-install-recommends colmap"; \
  }

TEST_F(ViewSynthesisProgram, TheImagesOfTheDriveAreWritten) {
  const ProgramRun run = export_map("colmap", "colmap", with_drive());
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("12 images, 1 of them held out to test"));
  std::size_t images = 0;
  for (const auto& entry : fs::directory_iterator(path("colmap/images"))) {
    const Image image = read_image(entry.path());
    EXPECT_EQ(image.width, 620);
    EXPECT_EQ(image.channels, 3);
    ++images;
  }
  EXPECT_EQ(images, std::size_t{kFrames});
  EXPECT_EQ(read_text(path("colmap/sparse/0/test.txt")), "camera_2_0000000004.png\n");
}

TEST_F(ViewSynthesisProgram, MasksOfTheDriveAreWrittenForNerf) {
  Image mask(620, 188, 1);
  std::fill(mask.data.begin(), mask.data.end(), std::uint8_t{255});
  std::fill(mask.pixel(0, 180), mask.pixel(0, 187) + 620, std::uint8_t{0});  // the hood
  const std::vector<std::uint8_t> png = encode_png(mask);
  std::ofstream(path("street/mask.png"), std::ios::binary)
      .write(reinterpret_cast<const char*>(png.data()), std::streamsize(png.size()));
  std::string description = read_text(path("street/drive.toml"));
  const std::string before = "index = 2\n";
  ASSERT_NE(description.find(before), std::string::npos);
  description.insert(description.find(before), "mask = \"mask.png\"\n");
  std::ofstream(path("street/drive.toml")) << description;

  const ProgramRun run = export_map("nerf", "masked", with_drive());
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const nlohmann::json json = nlohmann::json::parse(read_text(path("masked/transforms.json")));
  for (const nlohmann::json& frame : json["frames"]) {
    EXPECT_EQ(frame["mask_path"], "masks/camera_2.png");
  }
  EXPECT_EQ(read_image(path("masked/masks/camera_2.png")).data, mask.data);
}

/// Half a pixel to the side, the colors of the points and of a held-out image differ more.
TEST_F(ViewSynthesisProgram, ThePointsHaveTheColorsOfTheImagesWhereTheyProject) {
  const ProgramRun run = export_map("nerf", "nerf", with_drive());
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const nlohmann::json json = nlohmann::json::parse(read_text(path("nerf/transforms.json")));
  ASSERT_EQ(json["frames"].size(), std::size_t{kFrames});
  const nlohmann::json& frame = json["frames"][4];  // held out
  EXPECT_EQ(json["test_filenames"][0], frame["file_path"]);
  const Image image = read_image(path("nerf/" + std::string(frame["file_path"])));
  Eigen::Matrix4d T_local_cam;
  for (int i = 0; i < 16; ++i) T_local_cam(i / 4, i % 4) = frame["transform_matrix"][i / 4][i % 4];
  const Eigen::Matrix4d T_cam_local = T_local_cam.inverse();

  const PointCloud points = MapReader(path("m.fovea")).all_points_local();
  const auto mean_difference = [&](double shift) {
    double sum = 0;
    int count = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (points.camera[i] == kNoCamera || points.frame[i] < 4) continue;
      const Eigen::Vector4d p = T_cam_local * points.position[i].cast<double>().homogeneous();
      if (p.z() > -2) continue;
      // From pixel centers at 0.5 to those at integers.
      const double u = double(json["fl_x"]) * p.x() / -p.z() + double(json["cx"]) - 0.5 + shift,
                   v = double(json["fl_y"]) * p.y() / p.z() + double(json["cy"]) - 0.5;
      if (u < 1 || v < 1 || u > image.width - 2 || v > image.height - 2) continue;
      sum += std::abs(luma(to_float(to_rgb(points.color[i]))) - luma(bilinear(image, u, v)));
      ++count;
    }
    EXPECT_GT(count, 10'000);
    return sum / count;
  };
  for (const double shift : {-0.5, 0.5}) EXPECT_LT(mean_difference(0), mean_difference(shift));
}

TEST_F(ViewSynthesisProgram, ColmapReadsTheModel) {
  FOVEA_COLMAP_OR_SKIP();
  ASSERT_EQ(export_map("colmap", "colmap", "--max-points 20000").exit_code, 0);
  const std::string report = path("report.txt");
  ASSERT_EQ(run_colmap(fmt::format("model_analyzer --path '{}'", path("colmap/sparse/0")), report),
            0)
      << read_text(report);
  const std::string text = read_text(report);
  EXPECT_EQ(number_after(text, "Cameras: "), 1) << text;
  EXPECT_EQ(number_after(text, "Registered images: "), kFrames) << text;
  EXPECT_GT(number_after(text, "Points: "), 10'000) << text;
}

/// COLMAP finds features of its own and triangulates them. The cameras stay as exported, so that
/// its reprojection error shows how well they fit the images.
TEST_F(ViewSynthesisProgram, ColmapTriangulatesItsFeaturesWithTheExportedCameras) {
  FOVEA_COLMAP_OR_SKIP();
  ASSERT_EQ(export_map("colmap", "colmap", with_drive() + " --max-points 20000").exit_code, 0);
  fs::create_directories(path("triangulated"));
  const std::string database = fmt::format("--database_path '{}'", path("colmap.db")),
                    images = fmt::format("--image_path '{}'", path("colmap/images")),
                    report = path("report.txt");
  std::istringstream camera(read_text(path("colmap/sparse/0/cameras.txt")));
  std::string line;
  std::getline(camera, line);  // the comment
  double fx = 0, fy = 0, cx = 0, cy = 0;
  std::string model;
  int id = 0, width = 0, height = 0;
  camera >> id >> model >> width >> height >> fx >> fy >> cx >> cy;
  for (const std::string& arguments :
       {fmt::format("feature_extractor {} {} --ImageReader.single_camera 1 "
                    "--ImageReader.camera_model PINHOLE --ImageReader.camera_params {},{},{},{} "
                    "--SiftExtraction.use_gpu 0 --SiftExtraction.num_threads 1",  // images in order
                    database, images, fx, fy, cx, cy),
        fmt::format("sequential_matcher {} --SiftMatching.use_gpu 0 "
                    "--SequentialMatching.overlap 3 --SequentialMatching.quadratic_overlap 0",
                    database),
        fmt::format("point_triangulator {} {} --input_path '{}' --output_path '{}' "
                    "--Mapper.ba_refine_focal_length 0 --Mapper.ba_refine_extra_params 0",
                    database, images, path("colmap/sparse/0"), path("triangulated")),
        fmt::format("model_analyzer --path '{}'", path("triangulated"))}) {
    ASSERT_EQ(run_colmap(arguments, report), 0) << arguments << "\n" << read_text(report);
  }
  const std::string text = read_text(report);
  EXPECT_EQ(number_after(text, "Registered images: "), kFrames) << text;
  EXPECT_GT(number_after(text, "Observations: "), 500) << text;
  EXPECT_LT(number_after(text, "Mean reprojection error: "), 0.7) << text;
}

TEST_F(ViewSynthesisProgram, WhatCannotBeExportedIsOneClearLine) {
  const auto error = [&](const std::string& format, const std::string& more) {
    const ProgramRun run = export_map(format, "none", more);
    EXPECT_NE(run.exit_code, 0) << more;
    EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
    EXPECT_FALSE(fs::exists(path("none"))) << more;
    EXPECT_FALSE(fs::exists(path("none.partial"))) << more;
    return run.err;
  };
  EXPECT_THAT(error("colmap", fmt::format("--drive '{}'", path("missing"))), HasSubstr("missing"));
  EXPECT_THAT(error("nerf", "--where 'color > 3'"), HasSubstr("color"));
  EXPECT_THAT(error("colmap", "--crs utm"), HasSubstr("--crs"));
  EXPECT_THAT(error("ply", with_drive()), HasSubstr("--drive"));
  const std::string old = FOVEA_SOURCE_DIR "/tests/data/format_6.fovea";
  const ProgramRun run =
      run_fovea(fmt::format("export '{}' '{}' --format colmap", old, path("none")));
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.err, HasSubstr("--drive"));
}

}  // namespace fovea::view_synthesis_program_test
