#include "fovea/drive/lost_drive.h"

#include <gtest/gtest.h>

#include <fstream>

#include "../../../tests/temporary_folder.h"

namespace fovea::lost_drive_test {
namespace fs = std::filesystem;

class LostDrive : public testing::Test {
 protected:
  void SetUp() override {
    fs::create_directory(folder_ / "scans");
    for (int i = 0; i < 10; ++i) {
      const fs::path file = folder_ / "scans" / (std::to_string(i) + ".bin");
      std::ofstream(file) << "scan";
      files_[i] = file;
    }
  }
  void require(int index) { require_drive(files_, index, folder_.path()); }

  TemporaryFolder folder_;
  NumberedFiles files_;
};

TEST_F(LostDrive, FilesThatCanBeReadAreThere) {
  std::ofstream(files_[3], std::ios::trunc);  // empty: damaged, but not lost
  for (int i = 0; i < 10; ++i) EXPECT_NO_THROW(require(i)) << i;
}

TEST_F(LostDrive, OneOrTwoFilesAreLostAlone) {
  fs::remove(files_[4]);
  EXPECT_NO_THROW(require(4));
  fs::remove(files_[5]);
  EXPECT_NO_THROW(require(4));
  EXPECT_NO_THROW(require(5));
  fs::remove(files_[9]);
  EXPECT_NO_THROW(require(9));
}

TEST_F(LostDrive, AThirdFileMeansThatTheDriveIsLost) {
  for (const int i : {4, 5, 6}) fs::remove(files_[i]);
  EXPECT_THROW(require(4), DriveLostError);
  EXPECT_NO_THROW(require(5));
}

TEST_F(LostDrive, AFolderThatVanishesIsLostAtEveryFrame) {
  fs::rename(folder_ / "scans", folder_ / "gone");
  for (int i = 0; i < 10; ++i) {
    try {
      require(i);
      FAIL() << i;
    } catch (const DriveLostError& error) {
      EXPECT_NE(error.problem().find("from frame " + std::to_string(i) + " on"), std::string::npos);
      EXPECT_EQ(error.where(), folder_.path().string());
    }
  }
}

TEST_F(LostDrive, AFrameThatWasNeverThereIsNotLost) {
  files_.erase(4);
  fs::rename(folder_ / "scans", folder_ / "gone");
  EXPECT_NO_THROW(require(4));
}

TEST_F(LostDrive, TheOnlyFileOfADriveIsLostAlone) {
  files_.erase(files_.begin(), std::prev(files_.end()));
  fs::remove(files_[9]);
  EXPECT_NO_THROW(require(9));
}

}  // namespace fovea::lost_drive_test
