#include "fovea/drive/live/live_recorder.h"

#include <fmt/format.h>

#include <exception>
#include <utility>

#include "fovea/core/file_format.h"
#include "fovea/core/read_file.h"
#include "fovea/core/thread.h"
#include "fovea/drive/writers/motion_tables.h"
#include "fovea/errors.h"

namespace fovea {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kFramesAhead = 4;      // of the writer
constexpr std::size_t kFramesOfTables = 16;  // whose stamps are in memory

/// ConfigError for sensors whose folder is not the default one: the writer uses that.
void require_default_folders(const DriveDescription& description) {
  const auto require = [](const fs::path& folder, const fs::path& usual, const std::string& table) {
    if (folder.lexically_normal() == usual) return;
    throw ConfigError("a recording has the default folders", "drive.toml: " + table + ".folder",
                      "leave the key out");
  };
  const auto require_of = [&](const LidarDescription& lidar) {
    require(lidar.folder, fs::path("lidar") / lidar.name, lidar.table());
  };
  const LidarDescription& first = description.lidar;
  if (first.name.empty()) {
    require(first.folder, "lidar", first.table());
  } else {
    require_of(first);
  }
  for (const LidarDescription& lidar : description.further_lidars) require_of(lidar);
  for (const CameraDescription& camera : description.cameras) {
    require(camera.folder, fs::path("images") / camera.name, "camera." + camera.name);
  }
}

/// Whether the columns of a scan can be written.
bool is_whole(const PointCloud& scan) {
  const auto fits = [&](const auto& column) {
    return column.empty() || column.size() == scan.size();
  };
  return fits(scan.intensity) && fits(scan.time) && fits(scan.ring);
}

bool is_whole(const Image& image) {
  return image.width > 0 && image.height > 0 && (image.channels == 1 || image.channels == 3) &&
         image.data.size() ==
             std::size_t(image.width) * std::size_t(image.height) * std::size_t(image.channels);
}

}  // namespace

LiveRecorder::LiveRecorder(const fs::path& root, std::string drive_toml,
                           const DriveDescription& description)
    : drive_toml_(std::move(drive_toml)),
      description_(description),
      writer_(root),
      queue_(kFramesAhead) {
  require_default_folders(description);
  copy_masks();
  writer_.write_file("drive.toml", drive_toml_);
  // A calibration file that it names is not there.
  read_drive_description(writer_.folder() / "drive.toml");
  thread_ = start_thread("fovea-record", [this](const std::stop_token&) { run(); });
}

LiveRecorder::~LiveRecorder() { queue_.close_and_take(); }

void LiveRecorder::copy_masks() const {
  for (const CameraDescription& camera : description_.cameras) {
    if (camera.mask.empty() || camera.mask.is_absolute()) continue;
    const fs::path mask = camera.mask.lexically_normal();
    if (*mask.begin() == "..") {
      throw ConfigError("the mask of a camera lies outside of the recording", mask.string(),
                        "name it by its absolute path");
    }
    const std::vector<std::uint8_t> bytes = read_bytes(mask, kImageFile);
    writer_.write_file(mask, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  }
}

void LiveRecorder::add(RawFrame frame, RawMotion motion) {
  // After an error the queue is closed.
  static_cast<void>(queue_.push({std::move(frame), std::move(motion)}));
}

void LiveRecorder::set_stamp_delay(const std::string& camera, double delay) {
  for (const CameraDescription& described : description_.cameras) {
    if (described.name == camera && described.stamp_delay) return;  // drive.toml states it
  }
  const std::string table = fmt::format("[camera.{}]\n", camera);
  const std::size_t place = drive_toml_.find(table);
  if (place == std::string::npos) return;  // another way of writing: the median counts
  drive_toml_.insert(place + table.size(), fmt::format("stamp_delay = {}\n", delay));
}

void LiveRecorder::finish(RawMotion motion) {
  static_cast<void>(queue_.push({std::nullopt, std::move(motion)}));
  queue_.close();
  std::exception_ptr failure;
  try {
    result_.get();
  } catch (const OutputError&) {
    failure = std::current_exception();
  }
  writer_.finish(drive_toml_);  // the frames before it are a drive
  if (failure) std::rethrow_exception(failure);
}

void LiveRecorder::run() {
  try {
    while (const std::optional<Item> item = queue_.pop()) write(*item);
    written_.set_value();
  } catch (...) {
    queue_.close();
    written_.set_exception(std::current_exception());
  }
}

void LiveRecorder::write(const Item& item) {
  write_motion(item.motion);
  if (!item.frame) return;
  const RawFrame& frame = *item.frame;
  write_scan(frame.index, description_.lidar.name, *frame.scan);
  for (const auto& scan : frame.further_scans) {
    if (scan) write_scan(frame.index, scan->lidar, *scan);
  }
  for (const auto& image : frame.images) {
    if (image) write_image(frame.index, *image);
  }
  if (++frames_ % kFramesOfTables == 0) writer_.flush_stamps();
}

void LiveRecorder::write_scan(int number, const std::string& lidar, const LiveScan& scan) {
  if (is_whole(scan.points)) {
    writer_.write_scan(number, scan.stamp, scan.points, ScanFile::kPcd, lidar);
  }
}

void LiveRecorder::write_image(int number, const LiveImage& image) {
  if (const auto* bytes = std::get_if<std::string>(&image.content)) {
    const bool is_jpeg = sniff_format(*bytes).format == FileFormat::kJpeg;
    writer_.write_encoded_image(image.camera, number, image.stamp, *bytes,
                                is_jpeg ? ".jpg" : ".png");
  } else if (const Image& pixels = std::get<Image>(image.content); is_whole(pixels)) {
    writer_.write_image(image.camera, number, image.stamp, pixels);
  } else {
    return;
  }
  if (image.exposure) writer_.set_exposure(image.camera, number, *image.exposure);
}

void LiveRecorder::write_motion(const RawMotion& motion) {
  const auto append = [&](const char* table, const char* header, const auto& records,
                          auto&& row_of) {
    std::string rows;
    for (const auto& record : records) rows += row_of(record);
    if (!rows.empty()) writer_.append_rows(table, header, rows);
  };
  const auto plain = [](const auto& record) { return table_row(record); };
  append("poses.csv", kPosesHeader, motion.poses, plain);
  append("imu.csv", kInertiaHeader, motion.inertia, plain);
  append("wheels.csv", kWheelsHeader, motion.wheels, plain);
  append("gnss.csv", kMovingPositionsHeader, motion.positions,
         [](const RecordedPosition& position) {
           return table_row(position, /*has_velocities=*/true);
         });
}

}  // namespace fovea
