#include "fovea/simulation/kitti_drive_writer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <png.h>

#include <cstring>
#include <fstream>

#include "../../../tests/file_content.h"
#include "../../../tests/file_size_limit.h"
#include "../../../tests/temporary_folder.h"
#include "fovea/core/parallel.h"
#include "fovea/core/random.h"
#include "fovea/drive/frame_source.h"
#include "fovea/drive/images/image_decode.h"
#include "fovea/errors.h"
#include "fovea/simulation/drive_texts.h"

namespace fovea::kitti_drive_writer_test {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
namespace fs = std::filesystem;

/// Message of the OutputError that `f` throws.
template <class F>
std::string output_error(F&& f) {
  try {
    f();
  } catch (const OutputError& error) {
    return error.what();
  }
  return "no OutputError";
}

/// Smooth with some noise, as photographs are.
Image test_image(int width, int height, int channels) {
  Image image(width, height, channels);
  Random random(1);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      for (int c = 0; c < channels; ++c) {
        const double value =
            100 + 60 * std::sin(x * 0.02 + c) + 40 * std::cos(y * 0.03) + 3 * random.normal();
        image.pixel(x, y)[c] = static_cast<std::uint8_t>(std::clamp(value, 0.0, 255.0));
      }
    }
  }
  return image;
}

/// A drive with little in it, by way of everything that writes one.
fs::path write_drive(const fs::path& root, const SimulationOptions& options) {
  const Path path([](double) { return 0.2; }, [](double) { return 0.0; }, -10, 100);
  const VehicleMotion motion(path, 0, options.vehicle, options.seed);
  const Rig rig = make_rig(options);
  RigidMotion T_world_local = RigidMotion::Identity();
  T_world_local.translation() = (motion.T_world_vehicle(0) * rig.T_vehicle_lidar).translation();
  KittiDriveWriter writer(root);
  writer.write_texts(rig, simulate_navigation(motion, rig, T_world_local, options), options);
  parallel_for(std::size_t(options.frames), 1, [&](std::size_t i) {
    const int frame = int(i);
    writer.write_scan(frame, {{{1, 2, 3, 0.5f}, {4, 5, 6, 0.25f}, {float(frame), 0, 0, 1}}, {}});
    for (const SimulatedCamera& camera : options.camera.cameras) {
      writer.write_image(
          camera.number, frame, stamp_of(frame, options),
          test_image(options.camera.width, options.camera.height, camera.grey ? 1 : 3));
    }
  });
  return writer.finish();
}

TEST(KittiDriveWriter, TheProductsReaderOpensTheDrive) {
  const TemporaryFolder folder;
  SimulationOptions options;
  options.frames = 12;
  options.camera.width = 90;
  options.camera.height = 40;
  options.camera.cx = 44.5;
  options.camera.cy = 19.5;
  options.camera.cameras = {{0, 0, true}, {2, -0.06, false}, {7, 0.2, false}};
  const fs::path drive = write_drive(folder / "drive", options);
  EXPECT_EQ(drive, folder.path() / "drive/2026_01_01/2026_01_01_drive_0001_sync");
  EXPECT_THAT(folder.names(), ElementsAre("drive"));
  EXPECT_THAT(content(drive.parent_path() / "calib_cam_to_cam.txt"), HasSubstr("R_rect_00"));

  DriveOptions open;
  open.cameras = {0, 2, 7};
  const auto source = open_drive(drive, open);
  EXPECT_EQ(source->info().begin, 0);
  EXPECT_EQ(source->info().end, 12);
  EXPECT_THAT(source->info().notes, IsEmpty());
  EXPECT_NEAR(source->info().sweep.period, options.lidar.period, 1e-9);
  ASSERT_TRUE(source->info().navigation);
  const Frame frame = std::get<Frame>(source->load(11));
  ASSERT_EQ(frame.scan.size(), 3u);
  EXPECT_EQ(frame.scan.position[2].x(), 11);
  EXPECT_EQ(frame.images[0].channels, 1);
  EXPECT_EQ(frame.images[0].data, test_image(90, 40, 1).data);
  EXPECT_EQ(frame.images[2].data, test_image(90, 40, 3).data);
}

TEST(KittiDriveWriter, TruthRecordsAreAsDocumented) {
  const TemporaryFolder folder;
  KittiDriveWriter writer(folder / "d");
  TruthPoint point;
  point.hit_lidar = {1.5f, -2, 3};
  point.time = -0.04f;
  point.surface = 70'000;
  point.albedo = {10, 20, 30};
  point.ring = 63;
  point.moving = true;
  writer.write_truth(3, {TruthPoint{}, point});
  const std::string bytes = content(writer.finish() / "truth/velodyne_points/0000000003.bin");
  ASSERT_EQ(bytes.size(), 56u);
  const char* record = bytes.data() + 28;
  float numbers[4];
  std::memcpy(numbers, record, 16);
  EXPECT_THAT(numbers, ElementsAre(1.5f, -2, 3, -0.04f));
  std::uint32_t surface = 0;
  std::memcpy(&surface, record + 16, 4);
  EXPECT_EQ(surface, 70'000u);
  EXPECT_EQ(bytes.substr(28 + 20), std::string("\x0a\x14\x1e\x3f\x01\0\0\0", 8));
}

TEST(KittiDriveWriter, DepthIsIn256thsOfAMetre) {
  const TemporaryFolder folder;
  KittiDriveWriter writer(folder / "d");
  writer.write_depth(2, 0, 3, 2, {0, 1, 2.5f, 1e-4f, 100, 1e6f});
  EXPECT_THROW(writer.write_depth(2, 0, 3, 3, {0, 1}), std::invalid_argument);
  const fs::path file = writer.finish() / "truth/image_02/depth/0000000000.png";
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  ASSERT_NE(png_image_begin_read_from_file(&png, file.c_str()), 0);
  ASSERT_EQ(png.width, 3u);
  ASSERT_EQ(png.height, 2u);
  png_image_free(&png);
  // The simplified interface would undo a gamma; the raw bits are what counts.
  FILE* stream = fopen(file.c_str(), "rb");
  png_structp reader = png_create_read_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(reader);
  png_init_io(reader, stream);
  png_read_png(reader, info, PNG_TRANSFORM_SWAP_ENDIAN, nullptr);
  EXPECT_EQ(png_get_bit_depth(reader, info), 16);
  EXPECT_EQ(png_get_color_type(reader, info), PNG_COLOR_TYPE_GRAY);
  std::vector<std::uint16_t> values(6);
  for (int y = 0; y < 2; ++y) std::memcpy(&values[3 * y], png_get_rows(reader, info)[y], 6);
  EXPECT_THAT(values, ElementsAre(0, 256, 640, 1, 25'600, 65'535));
  png_destroy_read_struct(&reader, &info, nullptr);
  fclose(stream);
}

TEST(KittiDriveWriter, RefusesWhatIsInTheWay) {
  const TemporaryFolder folder;
  fs::create_directory(folder / "there");
  EXPECT_THAT(output_error([&] { KittiDriveWriter writer(folder / "there"); }),
              AllOf(HasSubstr("exists already"), HasSubstr("there"), HasSubstr("another name")));
  EXPECT_THAT(output_error([&] { KittiDriveWriter writer(folder / "none/d"); }),
              AllOf(HasSubstr("does not exist"), HasSubstr("none")));
  EXPECT_THAT(output_error([&] { KittiDriveWriter writer(""); }),
              HasSubstr("not the name of a folder"));
  // A folder of a user, whatever its name, is not ours to remove.
  fs::create_directory(folder / "d.partial");
  std::ofstream(folder / "d.partial/precious") << "x";
  EXPECT_THAT(output_error([&] { KittiDriveWriter writer(folder / "d"); }),
              HasSubstr("in the way"));
  EXPECT_TRUE(fs::exists(folder / "d.partial/precious"));
}

TEST(KittiDriveWriter, TakesATrailingSlash) {
  const TemporaryFolder folder;
  KittiDriveWriter writer(folder / "d/");
  writer.finish();
  EXPECT_THAT(folder.names(), ElementsAre("d"));
}

TEST(KittiDriveWriter, LeavesNothingUnfinished) {
  const TemporaryFolder folder;
  {
    KittiDriveWriter writer(folder / "d");
    writer.write_scan(0, {{{1, 2, 3, 4}}, {}});
    EXPECT_THAT(folder.names(), ElementsAre("d.partial"));
    EXPECT_THAT(output_error([&] { KittiDriveWriter second(folder / "d"); }),
                HasSubstr("another program"));
  }
  EXPECT_THAT(folder.names(), IsEmpty());
}

TEST(KittiDriveWriter, ReplacesWhatAKilledProgramLeft) {
  const TemporaryFolder folder;
  fs::create_directories(folder / "d.partial/2026_01_01");
  std::ofstream(folder / "d.partial/2026_01_01/half").flush();
  KittiDriveWriter writer(folder / "d");
  writer.write_scan(0, {});
  const fs::path drive = writer.finish();
  EXPECT_EQ(fs::file_size(drive / "velodyne_points/data/0000000000.bin"), 0u);
  EXPECT_THAT(folder.names(), ElementsAre("d"));
}

TEST(KittiDriveWriter, KeepsWhatAppearedMeanwhile) {
  const TemporaryFolder folder;
  {
    KittiDriveWriter writer(folder / "d");
    std::ofstream(folder / "d") << "mine";
    EXPECT_THAT(output_error([&] { writer.finish(); }), HasSubstr("this is a file"));
  }
  EXPECT_EQ(content(folder / "d"), "mine");
  EXPECT_THAT(folder.names(), ElementsAre("d"));
}

TEST(KittiDriveWriter, AFullDiskIsSaidAndLeavesNothing) {
  const TemporaryFolder folder;
  const FileSizeLimit limit(1000);
  EXPECT_THAT(output_error([&] {
                KittiDriveWriter writer(folder / "d");
                writer.write_scan(0, {std::vector<std::array<float, 4>>(62), {}});
                writer.write_scan(1, {std::vector<std::array<float, 4>>(63), {}});
              }),
              AllOf(HasSubstr("the disk is full"), HasSubstr((folder / "d").string()),
                    HasSubstr("free some space")));
  EXPECT_THAT(folder.names(), IsEmpty());
}

TEST(KittiDriveWriter, FreeSpaceIsCheckedByNeed) {
  const TemporaryFolder folder;
  EXPECT_NO_THROW(check_free_space(folder / "d", 1000));
  EXPECT_THAT(output_error([&] { check_free_space(folder / "d", std::uintmax_t{1} << 60); }),
              AllOf(HasSubstr("GB are needed"), HasSubstr("free some space")));
  EXPECT_THAT(output_error([&] { check_free_space(folder / "none/d", 1); }),
              Not(HasSubstr("no OutputError")));
}

TEST(KittiDriveWriter, ImagesOfKittisSizeArePacked) {
  const TemporaryFolder folder;
  const Image image = test_image(1242, 375, 3);
  KittiDriveWriter writer(folder / "d");
  for (int i = 0; i < 5; ++i) writer.write_image(2, i, 0, image);
  const fs::path file = writer.finish() / "image_02/data/0000000004.png";
  EXPECT_EQ(read_image(file).data, image.data);
  EXPECT_LT(double(fs::file_size(file)), 0.8 * double(image.data.size()));
}

}  // namespace fovea::kitti_drive_writer_test
