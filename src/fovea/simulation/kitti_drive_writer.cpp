#include "fovea/simulation/kitti_drive_writer.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <bit>
#include <cerrno>
#include <stdexcept>
#include <system_error>

#include "fovea/base/errors.h"
#include "fovea/base/output_file.h"
#include "fovea/recording/png_encode.h"
#include "fovea/simulation/drive_texts.h"

namespace fovea {
namespace fs = std::filesystem;

static_assert(std::endian::native == std::endian::little, "KITTI's files are little endian");

namespace {

constexpr const char* kDate = "2026_01_01";
constexpr const char* kDrive = "2026_01_01_drive_0001_sync";
/// In ROOT.partial: says that the folder is a simulation's, which may be removed.
constexpr const char* kMarker = ".fovea-simulate";

fs::path drive_folder(const fs::path& root) { return root / kDate / kDrive; }

std::string image_folder(int camera) { return fmt::format("image_{:02d}", camera); }

std::string numbered(int frame, const char* extension) {
  return fmt::format("{:010d}{}", frame, extension);
}

fs::path without_slash(const fs::path& path) {
  return path.has_filename() ? path : path.parent_path();
}

fs::path parent_of(const fs::path& path) {
  return path.has_parent_path() ? path.parent_path() : fs::path(".");
}

void check_root(const fs::path& root) {
  std::error_code ignored;
  if (root.empty() || root.filename() == "." || root.filename() == "..") {
    throw OutputError("the output is not a folder's name", fmt::format("'{}'", root.string()),
                      "give the name of the folder to make");
  }
  if (fs::exists(fs::symlink_status(root, ignored))) {
    throw OutputError("the output exists already", root.string(), "remove it or give another name");
  }
  if (!fs::is_directory(parent_of(root), ignored)) {
    throw OutputError("the output's folder does not exist", parent_of(root).string(),
                      "make it first");
  }
  if (::access(parent_of(root).c_str(), W_OK | X_OK) != 0) throw_output_error(root, errno);
}

/// Removes what a killed program left behind; OutputError if it is not that.
void remove_leftovers(const fs::path& partial) {
  if (!fs::exists(fs::symlink_status(partial))) return;
  const int lock = ::open((partial / kMarker).c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW);
  if (lock < 0) {
    throw OutputError("a folder of this name is in the way", partial.string(),
                      "remove it or give another output");
  }
  const bool unused = ::flock(lock, LOCK_EX | LOCK_NB) == 0;
  std::error_code failed;
  if (unused) fs::remove_all(partial, failed);
  ::close(lock);
  if (!unused) {
    throw OutputError("another program is writing this output", partial.string(),
                      "wait until it has ended or give another name");
  }
  if (failed) throw_output_error(partial, failed.value());
}

void make_folders(const fs::path& folder) {
  std::error_code failed;
  fs::create_directories(folder, failed);
  if (failed) throw_output_error(folder, failed.value());
}

}  // namespace

KittiDriveWriter::KittiDriveWriter(const fs::path& root)
    : root_(without_slash(root)), partial_(partial_path(root_)) {
  check_root(root_);
  remove_leftovers(partial_);
  if (::mkdir(partial_.c_str(), 0777) != 0) throw_output_error(root_, errno);
  lock_ = ::open((partial_ / kMarker).c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (lock_ < 0 || ::flock(lock_, LOCK_EX | LOCK_NB) != 0) {
    const int error = errno;
    if (lock_ >= 0) ::close(lock_);
    std::error_code ignored;
    fs::remove_all(partial_, ignored);
    throw_output_error(root_, error);
  }
}

KittiDriveWriter::~KittiDriveWriter() {
  if (lock_ < 0) return;  // finished
  std::error_code ignored;
  fs::remove_all(partial_, ignored);
  ::close(lock_);
}

void KittiDriveWriter::write_scan(int frame, const SimulatedScan& scan) {
  write_file(fs::path("velodyne_points/data") / numbered(frame, ".bin"),
             {reinterpret_cast<const char*>(scan.points.data()),
              scan.points.size() * sizeof(scan.points[0])});
}

void KittiDriveWriter::write_image(int camera, int frame, const Image& image) {
  const std::vector<std::uint8_t> bytes = encode_png(image);
  write_file(fs::path(image_folder(camera)) / "data" / numbered(frame, ".png"),
             {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

fs::path KittiDriveWriter::truth_folder() const {
  fs::path folder = drive_folder(partial_) / "truth";
  make_folders(folder);
  return folder;
}

fs::path KittiDriveWriter::finish() {
  if (lock_ < 0) throw std::logic_error("a drive was finished twice");
  check_root(root_);  // another program may have made it meanwhile
  if (::syncfs(lock_) != 0) throw_output_error(root_, errno);
  if (::rename(partial_.c_str(), root_.c_str()) != 0) throw_output_error(root_, errno);
  ::unlink((root_ / kMarker).c_str());
  ::close(lock_);
  lock_ = -1;
  return drive_folder(root_);
}

void KittiDriveWriter::write_file(const fs::path& name, std::string_view bytes) {
  write_below_root(drive_folder("") / name, bytes);
}

void KittiDriveWriter::write_below_root(const fs::path& name, std::string_view bytes) {
  if (lock_ < 0) throw std::logic_error("a drive was written to after it was finished");
  const fs::path file = partial_ / name;
  make_folders(file.parent_path());
  const int fd = ::open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (fd < 0) throw_output_error(file, errno);
  int error = 0;
  while (!bytes.empty() && error == 0) {
    const ssize_t written = ::write(fd, bytes.data(), bytes.size());
    if (written < 0) {
      if (errno != EINTR) error = errno;
      continue;
    }
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
  // Some file systems only say here that the disk is full.
  if (::close(fd) != 0 && error == 0) error = errno;
  if (error != 0) throw_output_error(file, error);
}

void KittiDriveWriter::write_texts(const Rig& rig, const std::vector<NavigationRecord>& records,
                                   const SimulationOptions& options) {
  const CalibrationTexts calibration = calibration_texts(rig, options);
  write_below_root(fs::path(kDate) / "calib_cam_to_cam.txt", calibration.cam_to_cam);
  write_below_root(fs::path(kDate) / "calib_velo_to_cam.txt", calibration.velo_to_cam);
  write_below_root(fs::path(kDate) / "calib_imu_to_velo.txt", calibration.imu_to_velo);

  write_file("velodyne_points/timestamps.txt", stamps_text(options));
  write_file("velodyne_points/timestamps_start.txt", stamps_text(options, -0.5));
  write_file("velodyne_points/timestamps_end.txt", stamps_text(options, 0.5));
  for (const Camera& camera : rig.cameras) {
    write_file(image_folder(camera.index) + "/timestamps.txt", stamps_text(options));
  }
  std::string stamps;
  for (std::size_t i = 0; i < records.size(); ++i) {
    stamps += date_time_text(records[i].time) + "\n";
    write_file("oxts/data/" + numbered(static_cast<int>(i), ".txt"), records[i].text);
  }
  write_file("oxts/timestamps.txt", stamps);
  write_file("oxts/dataformat.txt", navigation_format_text());
}

}  // namespace fovea
