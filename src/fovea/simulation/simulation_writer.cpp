#include "fovea/simulation/simulation_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "fovea/core/output_file.h"
#include "fovea/drive/writers/png_encode.h"
#include "fovea/errors.h"
#include "fovea/simulation/generic_simulation_writer.h"
#include "fovea/simulation/image_schedule.h"
#include "fovea/simulation/kitti_drive_writer.h"

namespace fovea {
namespace fs = std::filesystem;

static_assert(std::endian::native == std::endian::little, "the truth's files are little endian");

namespace {

fs::path camera_folder(int camera) {
  return fs::path("truth") / fmt::format("image_{:02d}", camera);
}

std::string_view text_of(const std::vector<std::uint8_t>& bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// The folder in which `path` lies, with a slash behind it or without.
fs::path folder_of(const fs::path& path) {
  const fs::path folder =
      path.has_filename() ? path.parent_path() : path.parent_path().parent_path();
  return folder.empty() ? fs::path(".") : folder;
}

/// `fovea simulate` has no --force, which the folder's own error would name.
void refuse_existing(const fs::path& root) {
  std::error_code ignored;
  if (!fs::exists(fs::symlink_status(root, ignored))) return;
  throw OutputError("the output exists already", root.string(), "remove it or give another name");
}

}  // namespace

std::string numbered(int frame, std::string_view extension) {
  return fmt::format("{:010d}{}", frame, extension);
}

void SimulationWriter::write_truth(int frame, const std::vector<TruthPoint>& points) {
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
  write_file(fs::path("truth/velodyne_points") / numbered(frame, ".bin"), text_of(bytes));
}

void SimulationWriter::write_perfect_image(int camera, int frame, const Image& image) {
  const std::vector<std::uint8_t> bytes = encode_png(image);
  write_file(camera_folder(camera) / "perfect" / numbered(frame, ".png"), text_of(bytes));
}

void SimulationWriter::write_depth(int camera, int frame, int width, int height,
                                   const std::vector<float>& depth) {
  std::vector<std::uint16_t> values(depth.size());
  std::transform(depth.begin(), depth.end(), values.begin(), [](float metres) {
    constexpr float kUnits = 256, kFarthest = 65'535;
    if (!(metres > 0)) return std::uint16_t{0};
    // 0 would mean sky.
    return static_cast<std::uint16_t>(std::lround(std::clamp(metres * kUnits, 1.0f, kFarthest)));
  });
  const std::vector<std::uint8_t> bytes = encode_png_16(width, height, values);
  write_file(camera_folder(camera) / "depth" / numbered(frame, ".png"), text_of(bytes));
}

std::unique_ptr<SimulationWriter> make_simulation_writer(const SimulationOptions& options,
                                                         const fs::path& root) {
  refuse_existing(root);
  if (options.format == DriveFormat::kGeneric) {
    return std::make_unique<GenericSimulationWriter>(options, root);
  }
  return std::make_unique<KittiDriveWriter>(root);
}

std::uintmax_t expected_size(const SimulationOptions& options) {
  constexpr double kReturn = 44, kPixel = 4, kWorld = 60e6;  // bytes
  double images = 0;                                         // a frame
  for (const SimulatedCamera& camera : options.camera.cameras) {
    images += std::max(1.0, image_rate(options.camera, camera) * options.lidar.period);
  }
  const double beams = double(ring_elevations(options.lidar).size()) * sweep_columns(options.lidar);
  double further = 0;
  for (const FurtherLidarOptions& lidar : options.further_lidars) {
    further += double(ring_elevations(lidar.lidar).size()) * sweep_columns(lidar.lidar);
  }
  const double frame =
      kReturn * (beams + further) + kPixel * images * options.camera.width * options.camera.height;
  return static_cast<std::uintmax_t>(kWorld + frame * options.frames);
}

void check_free_space(const fs::path& path, std::uintmax_t bytes) {
  std::error_code failed;
  const fs::space_info space = fs::space(folder_of(path), failed);
  if (failed) throw_output_error(path, failed.value());
  if (space.available >= bytes) return;
  throw OutputError(fmt::format("the disk has {:.1f} GB left and {:.1f} GB are needed",
                                double(space.available) * 1e-9, double(bytes) * 1e-9),
                    path.string(), "free some space, write to another disk or simulate less");
}

}  // namespace fovea
