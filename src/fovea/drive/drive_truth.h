// The truth of a simulated drive (docs/simulator.md), but for its world: poses, perfect images,
// where each LiDAR return came from.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "fovea/drive/images/image_decode.h"
#include "fovea/geometry/geodesy.h"
#include "fovea/image.h"
#include "fovea/rigid_motion.h"

namespace fovea {

/// What is true of one return of a scan.
struct TrueReturn {
  Eigen::Vector3f hit_lidar =
      Eigen::Vector3f::Zero();  ///< exact, in the LiDAR's frame at the scan's stamp (m)
  float time = 0;               ///< s from the stamp
  std::uint32_t surface = 0;    ///< id of the thing hit
  Rgb albedo = {};              ///< there, sRGB
  std::uint8_t ring = 0;        ///< 0 is the highest beam
  bool moving = false;
};

/// What is true of one camera, an entry a frame.
struct TrueCamera {
  std::vector<RigidMotion> T_local_cam;  ///< rectified
  std::vector<double> exposure;          ///< factor on linear light
};

/// The files of DRIVE/truth; a calibrated drive has those of the drive that it corrects. Frame
/// numbers are those of the drive's files, from 0 on. Every reading method is thread-safe and
/// throws InputError that names the file where it is missing or damaged.
class DriveTruth {
 public:
  /// Reads what is small: truth.json, poses, exposures. InputError if the drive has no truth.
  /// @param drive  the drive's folder (DriveInfo::path)
  explicit DriveTruth(const std::filesystem::path& drive);

  const std::filesystem::path& folder() const { return folder_; }
  const std::string& scene() const { return scene_; }
  int frames() const { return static_cast<int>(T_local_lidar_.size()); }
  double sweep_period() const { return sweep_period_; }    ///< s
  const GeodeticPoint& origin() const { return origin_; }  ///< of the local frame
  const std::vector<int>& camera_numbers() const { return camera_numbers_; }

  /// By frame, at the scans' stamps.
  const std::vector<RigidMotion>& T_local_lidar() const { return T_local_lidar_; }
  /// InputError for a camera without truth.
  const TrueCamera& camera(int number) const;

  /// What the scan's returns hit, in the order of the drive's scan file.
  std::vector<TrueReturn> returns(int frame) const;
  /// What a camera without noise, vignetting and changes of exposure would have taken.
  Image perfect_image(int camera, int frame) const;
  DepthImage depth(int camera, int frame) const;

 private:
  void read_description();
  void read_camera(int number);
  void require_frames(std::size_t found, const std::filesystem::path& file) const;

  std::filesystem::path folder_;
  std::string scene_;
  std::size_t described_frames_ = 0;
  double sweep_period_ = 0;
  GeodeticPoint origin_;
  std::vector<int> camera_numbers_;
  std::vector<RigidMotion> T_local_lidar_;
  std::map<int, TrueCamera> cameras_;
};

}  // namespace fovea
