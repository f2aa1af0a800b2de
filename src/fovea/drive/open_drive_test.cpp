#include <gmock/gmock.h>

#include "../../../tests/kitti_test_drive.h"
#include "fovea/drive/frame_source.h"
#include "fovea/errors.h"

namespace fovea::open_drive_test {

using test::error_of;
using test::fs::path;
using testing::AllOf;
using testing::HasSubstr;

/// ROOT/DATE/DATE_drive_NUMBER_sync with two frames.
path write_synced_drive(const path& root, const std::string& date, const std::string& number) {
  const path drive = root / date / (date + "_drive_" + number + "_sync");
  test::fs::rename(test::write_raw_drive(root / date, 2), drive);
  return drive;
}

TEST(OpenDrive, FindsTheOnlyDriveBelowARoot) {
  const TemporaryFolder root;
  const path drive = write_synced_drive(root.path(), "2026_01_01", "0001");
  test::write_text(root / "2026_01_01/notes/readme.txt", "no drive");
  test::write_text(root / "other/velodyne_points/readme.txt", "no drive");
  const auto opened = open_drive(root.path(), {});
  EXPECT_EQ(opened->info().path, drive);
  EXPECT_EQ(opened->info().end, 2);
  EXPECT_TRUE(std::holds_alternative<Frame>(opened->load(0)));
}

TEST(OpenDrive, DoesNotChooseAmongSeveralDrives) {
  const TemporaryFolder root;
  write_synced_drive(root.path(), "2026_01_01", "0002");
  write_synced_drive(root.path(), "2026_01_01", "0001");
  write_synced_drive(root.path(), "2026_01_02", "0001");
  EXPECT_THAT(error_of<InputError>([&] { open_drive(root.path(), {}); }),
              AllOf(HasSubstr("3 drives: 2026_01_01/2026_01_01_drive_0001_sync, "
                              "2026_01_01/2026_01_01_drive_0002_sync, "
                              "2026_01_02/2026_01_02_drive_0001_sync, "),
                    HasSubstr(root.path().string())));
}

TEST(OpenDrive, AFolderWithoutADriveIsRefused) {
  const TemporaryFolder root;
  test::write_text(root / "2026_01_01/2026_01_01_drive_0001_sync/image_02/a.txt", "");
  EXPECT_THAT(error_of<InputError>([&] { open_drive(root.path(), {}); }),
              HasSubstr("neither drive.toml"));
}

TEST(OpenDrive, ADataSetWithoutDrivesIsNamed) {
  const auto message = [](const path& folder) {
    return error_of<InputError>([&] { open_drive(folder, {}); });
  };
  const TemporaryFolder root;
  test::write_scan(root / "object/training/velodyne/000000.bin", {{1, 2, 3, 0.5f}});
  test::write_text(root / "object/training/calib/000000.txt", "P0: 1\n");
  test::write_text(root / "object/training/image_2/000000.png", "");
  EXPECT_THAT(message(root / "object/training"), HasSubstr("KITTI's object data set"));
  EXPECT_THAT(message(root / "object"), HasSubstr("KITTI's object data set"));
  test::write_scan(root / "labels/velodyne/000000.bin", {{1, 2, 3, 0.5f}});
  test::write_text(root / "labels/label_2/000000.txt", "Car 0 0 0\n");
  EXPECT_THAT(message(root / "labels"), HasSubstr("KITTI's object data set"));
  test::write_text(root / "nuscenes/samples/LIDAR_TOP/a.pcd.bin", "");
  EXPECT_THAT(message(root / "nuscenes"), HasSubstr("the nuScenes data set"));
}

}  // namespace fovea::open_drive_test
