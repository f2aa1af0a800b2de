#include "fovea/simulation/drive_writer.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <system_error>

#include "fovea/base/errors.h"
#include "fovea/base/output_file.h"
#include "fovea/simulation/drive_texts.h"
#include "fovea/simulation/png_encode.h"

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

DriveWriter::DriveWriter(const fs::path& root)
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

DriveWriter::~DriveWriter() {
  if (lock_ < 0) return;  // finished
  std::error_code ignored;
  fs::remove_all(partial_, ignored);
  ::close(lock_);
}

void DriveWriter::write_scan(int frame, const std::vector<std::array<float, 4>>& points) {
  write_file(drive_folder("") / "velodyne_points/data" / numbered(frame, ".bin"), points.data(),
             points.size() * sizeof(points[0]));
}

void DriveWriter::write_truth(int frame, const std::vector<TruthPoint>& points) {
  constexpr std::size_t kRecord = 28;
  std::vector<std::uint8_t> bytes(points.size() * kRecord);
  std::uint8_t* record = bytes.data();
  for (const TruthPoint& point : points) {
    std::memcpy(record, point.hit_lidar.data(), 12);
    std::memcpy(record + 12, &point.time, 4);
    std::memcpy(record + 16, &point.surface, 4);
    record[20] = point.albedo.r;
    record[21] = point.albedo.g;
    record[22] = point.albedo.b;
    record[23] = point.ring;
    record[24] = point.moving ? 1 : 0;
    record += kRecord;  // three bytes stay 0
  }
  write_file(drive_folder("") / "truth/velodyne_points" / numbered(frame, ".bin"), bytes.data(),
             bytes.size());
}

void DriveWriter::write_image(int camera, int frame, const Image& image) {
  const std::vector<std::uint8_t> bytes = encode_png(image);
  write_file(drive_folder("") / image_folder(camera) / "data" / numbered(frame, ".png"),
             bytes.data(), bytes.size());
}

void DriveWriter::write_perfect_image(int camera, int frame, const Image& image) {
  const std::vector<std::uint8_t> bytes = encode_png(image);
  write_file(
      drive_folder("") / "truth" / image_folder(camera) / "perfect" / numbered(frame, ".png"),
      bytes.data(), bytes.size());
}

void DriveWriter::write_depth(int camera, int frame, int width, int height,
                              const std::vector<float>& depth) {
  std::vector<std::uint16_t> values(depth.size());
  std::transform(depth.begin(), depth.end(), values.begin(), [](float metres) {
    constexpr float kUnits = 256, kFarthest = 65'535;
    if (!(metres > 0)) return std::uint16_t{0};
    // 0 would mean sky.
    return static_cast<std::uint16_t>(std::lround(std::clamp(metres * kUnits, 1.0f, kFarthest)));
  });
  const std::vector<std::uint8_t> bytes = encode_png_16(width, height, values);
  write_file(drive_folder("") / "truth" / image_folder(camera) / "depth" / numbered(frame, ".png"),
             bytes.data(), bytes.size());
}

void DriveWriter::write_text(const std::string& name, const std::string& text, bool in_date) {
  write_file(in_date ? fs::path(kDate) / name : drive_folder("") / name, text.data(), text.size());
}

fs::path DriveWriter::truth_folder() const {
  fs::path folder = drive_folder(partial_) / "truth";
  make_folders(folder);
  return folder;
}

fs::path DriveWriter::finish() {
  if (lock_ < 0) throw std::logic_error("a drive was finished twice");
  check_root(root_);  // another program may have made it meanwhile
  if (::syncfs(lock_) != 0) throw_output_error(root_, errno);
  if (::rename(partial_.c_str(), root_.c_str()) != 0) throw_output_error(root_, errno);
  ::unlink((root_ / kMarker).c_str());
  ::close(lock_);
  lock_ = -1;
  return drive_folder(root_);
}

void DriveWriter::write_file(const fs::path& name, const void* data, std::size_t size) {
  if (lock_ < 0) throw std::logic_error("a drive was written to after it was finished");
  const fs::path file = partial_ / name;
  make_folders(file.parent_path());
  const int fd = ::open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (fd < 0) throw_output_error(file, errno);
  const auto* bytes = static_cast<const char*>(data);
  int error = 0;
  while (size > 0 && error == 0) {
    const ssize_t written = ::write(fd, bytes, size);
    if (written < 0) {
      if (errno != EINTR) error = errno;
      continue;
    }
    bytes += written;
    size -= static_cast<std::size_t>(written);
  }
  // Some file systems only say here that the disk is full.
  if (::close(fd) != 0 && error == 0) error = errno;
  if (error != 0) throw_output_error(file, error);
}

void write_drive_texts(const Rig& rig, const std::vector<NavigationRecord>& records,
                       const SimulationOptions& options, DriveWriter& writer) {
  const CalibrationTexts calibration = calibration_texts(rig, options);
  writer.write_text("calib_cam_to_cam.txt", calibration.cam_to_cam, /*in_date=*/true);
  writer.write_text("calib_velo_to_cam.txt", calibration.velo_to_cam, /*in_date=*/true);
  writer.write_text("calib_imu_to_velo.txt", calibration.imu_to_velo, /*in_date=*/true);

  writer.write_text("velodyne_points/timestamps.txt", stamps_text(options));
  writer.write_text("velodyne_points/timestamps_start.txt", stamps_text(options, -0.5));
  writer.write_text("velodyne_points/timestamps_end.txt", stamps_text(options, 0.5));
  for (const Camera& camera : rig.cameras) {
    writer.write_text(image_folder(camera.index) + "/timestamps.txt", stamps_text(options));
  }
  std::string stamps;
  for (std::size_t i = 0; i < records.size(); ++i) {
    stamps += date_time_text(records[i].time) + "\n";
    writer.write_text("oxts/data/" + numbered(static_cast<int>(i), ".txt"), records[i].text);
  }
  writer.write_text("oxts/timestamps.txt", stamps);
  writer.write_text("oxts/dataformat.txt", navigation_format_text());
}

void check_free_space(const fs::path& path, std::uintmax_t bytes) {
  std::error_code failed;
  const fs::space_info space = fs::space(parent_of(without_slash(path)), failed);
  if (failed) throw_output_error(path, failed.value());
  if (space.available >= bytes) return;
  throw OutputError(fmt::format("the disk has {:.1f} GB left and {:.1f} GB are needed",
                                double(space.available) * 1e-9, double(bytes) * 1e-9),
                    path.string(), "free some space, write to another disk or simulate less");
}

}  // namespace fovea
