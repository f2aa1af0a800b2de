// For tests: small synthetic drives in KITTI's forms, in a temporary folder.
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <png.h>
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

#include "fovea/image.h"
#include "temporary_folder.h"

namespace fovea::test {

namespace fs = std::filesystem;

using fovea::TemporaryFolder;

inline void write_text(const fs::path& file, std::string_view text) {
  fs::create_directories(file.parent_path());
  std::ofstream(file, std::ios::binary) << text;
}

inline std::string read_text(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

inline void truncate(const fs::path& file, double share) {
  fs::resize_file(file, static_cast<std::uintmax_t>(share * double(fs::file_size(file))));
}

/// Replaces the only `from` of a file by `to`.
inline void edit(const fs::path& file, const std::string& from, const std::string& to) {
  std::string text = read_text(file);
  const std::size_t at = text.find(from);
  ASSERT_NE(at, std::string::npos) << from;
  ASSERT_EQ(text.find(from, at + 1), std::string::npos) << from << " is there twice";
  write_text(file, text.replace(at, from.size(), to));
}

/// An image whose every pixel is different from its neighbours.
inline Image pattern(int width, int height, int channels) {
  Image image(width, height, channels);
  for (std::size_t i = 0; i < image.data.size(); ++i) {
    image.data[i] = static_cast<std::uint8_t>(i * 37 + i / 11);
  }
  return image;
}

/// Writes samples in one of libpng's formats (PNG_FORMAT_RGB, ...).
inline void write_png(const fs::path& file, int width, int height, png_uint_32 format,
                      const void* samples, const void* colors = nullptr, int color_count = 0) {
  fs::create_directories(file.parent_path());
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  png.width = static_cast<png_uint_32>(width);
  png.height = static_cast<png_uint_32>(height);
  png.format = format;
  png.colormap_entries = static_cast<png_uint_32>(color_count);
  ASSERT_TRUE(png_image_write_to_file(&png, file.c_str(), 0, samples, 0, colors)) << png.message;
}

inline void write_png(const fs::path& file, const Image& image) {
  write_png(file, image.width, image.height, image.channels == 3 ? PNG_FORMAT_RGB : PNG_FORMAT_GRAY,
            image.data.data());
}

inline void write_scan(const fs::path& file, const std::vector<std::array<float, 4>>& points) {
  fs::create_directories(file.parent_path());
  std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char*>(points.data()),
             static_cast<std::streamsize>(points.size() * sizeof(points[0])));
}

inline constexpr int kWidth = 24, kHeight = 10;  // of the drives' images

/// Camera k stands 0.5 m * k to the right of camera 0; every rotation is the plain change of axes.
inline std::string projection(int k) {
  return fmt::format("20 0 11.5 {} 0 20 4.5 0 0 0 1 0", -20 * 0.5 * k);
}
inline constexpr const char* kAxes = "0 -1 0 0 0 -1 1 0 0";  // R_cam0_lidar

/// Record of a car that drives north at 10 m/s, at time t (s).
inline std::string oxts_record(double t) {
  constexpr double kDegreesPerMetre = 1 / 111'219.7;  // at latitude 49.0, 100 m up
  return fmt::format("{:.12f} 8.4 100 0 0 1.5707963267948966{}\n", 49 + 10 * t * kDegreesPerMetre,
                     " 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0");
}

inline std::string stamp(int frame, int delay_ms = 0) {
  return fmt::format("2011-09-26 13:00:{:02}.{:03}000000", frame / 10, frame % 10 * 100 + delay_ms);
}

/// A KITTI raw drive of `frames` frames (cameras 2 and 3; stamps and oxts records of 5 more;
/// records 20 ms after the scans). Its folder is `date`/drive.
inline fs::path write_raw_drive(const fs::path& date, int frames) {
  std::string cameras = "calib_time: 09-Jan-2012 13:57:47\nR_rect_00: 1 0 0 0 1 0 0 0 1\n";
  for (int k = 0; k < 4; ++k) {
    cameras +=
        fmt::format("S_rect_0{0}: {1} {2}\nP_rect_0{0}: {3}\n", k, kWidth, kHeight, projection(k));
  }
  write_text(date / "calib_cam_to_cam.txt", cameras);
  write_text(date / "calib_velo_to_cam.txt", fmt::format("R: {}\nT: 0 0 -0.25\n", kAxes));
  write_text(date / "calib_imu_to_velo.txt", "R: 1 0 0 0 1 0 0 0 1\nT: -0.8 0.3 -0.9\n");

  const fs::path drive = date / "drive";
  std::string scan_stamps, oxts_stamps;
  for (int i = 0; i < frames + 5; ++i) {
    scan_stamps += stamp(i) + "\n";
    oxts_stamps += stamp(i, 20) + "\n";
    write_text(drive / fmt::format("oxts/data/{:010}.txt", i), oxts_record(0.1 * i + 0.02));
  }
  write_text(drive / "velodyne_points/timestamps.txt", scan_stamps);
  write_text(drive / "oxts/timestamps.txt", oxts_stamps);
  for (int i = 0; i < frames; ++i) {
    write_scan(drive / fmt::format("velodyne_points/data/{:010}.bin", i),
               {{5, 0, 0, 0.5f}, {float(i), 1, 0, 0.25f}});
    for (const int camera : {2, 3}) {
      write_png(drive / fmt::format("image_0{}/data/{:010}.png", camera, i),
                pattern(kWidth, kHeight, 3));
    }
  }
  return drive;
}

/// A KITTI odometry sequence with grey cameras 0 and 1 and poses of a car that drives 1 m a frame.
inline fs::path write_odometry_sequence(const fs::path& root, int frames) {
  const fs::path sequence = root / "sequences" / "07";
  std::string calibration, times, poses;
  for (int k = 0; k < 4; ++k) calibration += fmt::format("P{}: {}\n", k, projection(k));
  calibration += "Tr: 0 -1 0 0 0 0 -1 0 1 0 0 -0.25\n";
  for (int i = 0; i < frames; ++i) {
    times += fmt::format("{:e}\n", 0.1 * i);
    poses += fmt::format("1 0 0 0 0 1 0 0 0 0 1 {}\n", i);
    write_scan(sequence / fmt::format("velodyne/{:06}.bin", i), {{5, 0, 0, 0.5f}});
    for (const int camera : {0, 1}) {
      write_png(sequence / fmt::format("image_{}/{:06}.png", camera, i),
                pattern(kWidth, kHeight, 1));
    }
  }
  write_text(sequence / "calib.txt", calibration);
  write_text(sequence / "times.txt", times);
  write_text(root / "poses" / "07.txt", poses);
  return sequence;
}

/// Text of the error of type E that `f` throws.
template <class E, class F>
std::string error_of(F&& f) {
  try {
    f();
  } catch (const E& error) {
    return error.what();
  }
  ADD_FAILURE() << "no such error";
  return {};
}

}  // namespace fovea::test
