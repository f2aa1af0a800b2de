// Where a simulated drive goes: its sensors' data in some format, its truth (docs/simulator.md) in
// every format alike.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "fovea/image.h"
#include "fovea/simulation/imu_model.h"
#include "fovea/simulation/lidar_model.h"
#include "fovea/simulation/navigation_model.h"
#include "fovea/simulation/simulation_options.h"
#include "fovea/time.h"

namespace fovea {

/// Every function throws OutputError where the disk is full or refuses. Files of different frames
/// and cameras may be written at once, from several threads.
class SimulationWriter {
 public:
  virtual ~SimulationWriter() = default;

  virtual void write_scan(int frame, const SimulatedScan& scan) = 0;
  /// @param lidar  place in SimulationOptions::further_lidars. KITTI's drives have none.
  virtual void write_further_scan(std::size_t lidar, int frame, const SimulatedScan& scan) = 0;
  /// @param stamp  of the image; KITTI's drives have that of its scan
  virtual void write_image(int camera, int number, TimeNs stamp, const Image& image) = 0;
  /// Exposure of an image that write_image() writes, relative to the usual one. KITTI's drives have
  /// no place for it.
  virtual void write_exposure(int /*camera*/, int /*number*/, double /*exposure*/) {}
  /// The calibration, all time stamps and the records of GPS/INS.
  virtual void write_texts(const Rig& rig, const std::vector<NavigationRecord>& records,
                           const SimulationOptions& options) = 0;
  /// KITTI's drives have neither.
  virtual void write_imu(const std::vector<ImuRecord>& /*records*/) {}
  virtual void write_wheels(const std::vector<WheelRecord>& /*records*/) {}
  /// Folder of the truth, for what writes its files itself (write_world).
  virtual std::filesystem::path truth_folder() const = 0;
  /// A file of the drive's own, by its name below the drive's folder ("truth/poses.txt").
  virtual void write_file(const std::filesystem::path& name, std::string_view bytes) = 0;
  /// Makes everything durable and gives the output its name. Returns the drive's folder.
  virtual std::filesystem::path finish() = 0;

  void write_truth(int frame, const std::vector<TruthPoint>& points);
  void write_perfect_image(int camera, int frame, const Image& image);
  /// @param depth  m, row by row; 0 for sky
  void write_depth(int camera, int frame, int width, int height, const std::vector<float>& depth);
};

/// A frame's file in KITTI's drives: "0000000012.png".
std::string numbered(int frame, std::string_view extension);

/// The format that the options name, at `root`. OutputError as OutputFolder's; what is there is
/// never replaced.
std::unique_ptr<SimulationWriter> make_simulation_writer(const SimulationOptions& options,
                                                         const std::filesystem::path& root);

/// What a drive takes on disk, about (bytes): scans and their truth, images with perfect image and
/// depth.
std::uintmax_t expected_size(const SimulationOptions& options);

/// OutputError if the disk on which `path` is to be made has less than `bytes` left.
void check_free_space(const std::filesystem::path& path, std::uintmax_t bytes);

}  // namespace fovea
