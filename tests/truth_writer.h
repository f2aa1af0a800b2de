// For tests: a drive's truth folder, written field by field as docs/simulator.md describes it,
// without the simulator's own writer.
#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <png.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "fovea/camera.h"
#include "fovea/drive/drive_truth.h"
#include "fovea/geometry/pose_file.h"

namespace fovea::test {

inline void write_file(const std::filesystem::path& file, const std::string& text) {
  std::filesystem::create_directories(file.parent_path());
  std::ofstream(file, std::ios::binary) << text;
}

/// `samples` of one of libpng's simplified formats whose samples are stored as they are.
inline void write_png_file(const std::filesystem::path& file, const Image& image) {
  std::filesystem::create_directories(file.parent_path());
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  png.width = static_cast<png_uint_32>(image.width);
  png.height = static_cast<png_uint_32>(image.height);
  png.format = image.channels == 3 ? PNG_FORMAT_RGB : PNG_FORMAT_GRAY;
  if (png_image_write_to_file(&png, file.c_str(), 0, image.data.data(), 0, nullptr) == 0) {
    throw std::runtime_error("cannot write a PNG");
  }
}

/// A PNG of one 16-bit channel, depth x 256. (libpng's simplified writer would add a gamma curve.)
inline void write_depth_png(const std::filesystem::path& file, const DepthImage& depth) {
  std::filesystem::create_directories(file.parent_path());
  std::FILE* stream = std::fopen(file.c_str(), "wb");
  if (stream == nullptr) throw std::runtime_error("cannot write a PNG");
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  png_init_io(png, stream);
  png_set_IHDR(png, info, png_uint_32(depth.width), png_uint_32(depth.height), 16,
               PNG_COLOR_TYPE_GRAY, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
               PNG_FILTER_TYPE_DEFAULT);
  png_write_info(png, info);
  std::vector<png_byte> row(2 * static_cast<std::size_t>(depth.width));
  for (int y = 0; y < depth.height; ++y) {
    for (int x = 0; x < depth.width; ++x) {
      const auto sample = static_cast<unsigned>(std::lround(256 * depth.at(x, y)));
      row[2 * std::size_t(x)] = static_cast<png_byte>(sample >> 8);
      row[2 * std::size_t(x) + 1] = static_cast<png_byte>(sample & 255);
    }
    png_write_row(png, row.data());
  }
  png_write_end(png, info);
  png_destroy_write_struct(&png, &info);
  std::fclose(stream);
}

inline std::string pose_lines(const std::vector<RigidMotion>& poses) {
  std::string text;
  for (const RigidMotion& pose : poses) text += format_pose(pose) + "\n";
  return text;
}

inline std::string return_records(const std::vector<TrueReturn>& returns) {
  std::string bytes(28 * returns.size(), '\0');
  char* record = bytes.data();
  for (const TrueReturn& r : returns) {
    std::memcpy(record, r.hit_lidar.data(), 12);
    std::memcpy(record + 12, &r.time, 4);
    std::memcpy(record + 16, &r.surface, 4);
    const std::uint8_t rest[5] = {r.albedo.r, r.albedo.g, r.albedo.b, r.ring, r.moving};
    std::memcpy(record + 20, rest, 5);
    record += 28;
  }
  return bytes;
}

inline std::string frame_file(int frame, const char* ending) {
  return fmt::format("{:010d}.{}", frame, ending);
}

/// truth.json, poses.txt and each camera's poses.txt and exposure.txt (all 1).
inline void write_truth_poses(const std::filesystem::path& truth, const GeodeticPoint& origin,
                              const std::vector<RigidMotion>& T_local_lidar,
                              const std::vector<Camera>& cameras) {
  std::vector<int> numbers;
  for (const Camera& camera : cameras) {
    numbers.push_back(camera.index);
    std::vector<RigidMotion> T_local_cam;
    std::string exposures;
    for (const RigidMotion& T : T_local_lidar) {
      T_local_cam.push_back(T * camera.T_cam_lidar.inverse());
      exposures += "1\n";
    }
    const auto folder = truth / fmt::format("image_{:02d}", camera.index);
    write_file(folder / "poses.txt", pose_lines(T_local_cam));
    write_file(folder / "exposure.txt", exposures);
  }
  write_file(truth / "poses.txt", pose_lines(T_local_lidar));
  write_file(
      truth / "truth.json",
      fmt::format(R"({{"version": 1, "scene": "street", "seed": 1, "frames": {}, "cameras": [{}], )"
                  R"("sweep_period": 0.1, "origin": {{"latitude": {}, "longitude": {}, )"
                  R"("altitude": {}}}, "config": ""}})",
                  T_local_lidar.size(), fmt::join(numbers, ", "), origin.latitude, origin.longitude,
                  origin.altitude));
}

}  // namespace fovea::test
