#include "fovea/drive/kitti/kitti_calibration.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <string>

#include "fovea/core/read_file.h"
#include "fovea/drive/images/image_decode.h"
#include "fovea/drive/plausible.h"
#include "fovea/drive/plausible_lens.h"
#include "fovea/errors.h"

namespace fovea {
namespace {

constexpr int kCameras = 10;  // KITTI has four; simulated drives may have more
constexpr const char* kRemedy = "restore the file from the KITTI archive's calibration";

/// "key: numbers" lines of one file.
class CalibrationFile {
 public:
  explicit CalibrationFile(std::filesystem::path file) : file_(std::move(file)) {
    if (!std::filesystem::exists(file_)) {
      throw InputError("the calibration file is missing", file_.string(),
                       "put the KITTI archive's calibration there");
    }
    int number = 0;
    for (const std::string& text : read_lines(file_)) {
      ++number;
      const std::size_t colon = text.find(':');
      if (colon == std::string::npos) continue;
      lines_[text.substr(0, colon)] = {number, text.substr(colon + 1)};
    }
  }

  bool has(const std::string& key) const { return lines_.contains(key); }

  template <std::size_t N>
  std::array<double, N> numbers(const std::string& key) const {
    if (!has(key)) throw InputError(key + " is missing", file_.string(), kRemedy);
    const auto values = parse_numbers(lines_.at(key).text);
    if (!values) fail(key, "has an entry that is no number");
    if (values->size() != N) {
      fail(key, "has " + std::to_string(values->size()) + " numbers, not " + std::to_string(N));
    }
    std::array<double, N> result;
    for (std::size_t i = 0; i < N; ++i) {
      if (!std::isfinite((*values)[i])) fail(key, "has an entry that is not finite");
      result[i] = (*values)[i];
    }
    return result;
  }

  Eigen::Matrix3d rotation(const std::string& key) const {
    return checked_rotation(key, Eigen::Map<const RowMajor<3>>(numbers<9>(key).data()));
  }

  /// Rotation "R" and translation "T" of a file that holds one motion.
  RigidMotion motion() const {
    RigidMotion T = RigidMotion::Identity();
    T.linear() = rotation("R");
    T.translation() =
        checked_translation("T", Eigen::Map<const Eigen::Vector3d>(numbers<3>("T").data()));
    return T;
  }

  /// Motion of a 3 x 4 matrix.
  RigidMotion motion(const std::string& key) const {
    const Eigen::Matrix<double, 3, 4> matrix =
        Eigen::Map<const RowMajor<4>>(numbers<12>(key).data());
    RigidMotion T = RigidMotion::Identity();
    T.linear() = checked_rotation(key, matrix.leftCols<3>());
    T.translation() = checked_translation(key, matrix.col(3));
    return T;
  }

  /// Intrinsics of a 3 x 4 projection K * [I | t]; T_cam_lidar becomes the translation by t.
  Camera projection(const std::string& key, int index) const {
    const Eigen::Matrix<double, 3, 4> P = Eigen::Map<const RowMajor<4>>(numbers<12>(key).data());
    const bool pinhole = P(0, 0) > 0 && P(1, 1) > 0 && P(0, 1) == 0 && P(1, 0) == 0 &&
                         P(2, 0) == 0 && P(2, 1) == 0 && P(2, 2) == 1;
    if (!pinhole) fail(key, "is not the projection of a rectified camera");
    Camera camera;
    camera.index = index;
    camera.fx = P(0, 0);
    camera.fy = P(1, 1);
    camera.cx = P(0, 2);
    camera.cy = P(1, 2);
    const Eigen::Matrix3d K = P.leftCols<3>();
    camera.T_cam_lidar.translation() = checked_translation(key, K.inverse() * P.col(3));
    return camera;
  }

  /// @param key         of the size
  /// @param projection  key of the camera's projection
  void read_size(const std::string& key, const std::string& projection, Camera& camera) const {
    const std::array<double, 2> size = numbers<2>(key);
    for (const double side : size) {
      if (side < 1 || side > kMaxImageSide || side != std::floor(side))
        fail(key, "is no image size");
    }
    camera.width = static_cast<int>(size[0]);
    camera.height = static_cast<int>(size[1]);
    if (const auto problem = lens_problem(camera)) {
      fail(projection, "is wrong: " + problem->what, problem->remedy);
    }
  }

 private:
  template <int Columns>
  using RowMajor = Eigen::Matrix<double, 3, Columns, Eigen::RowMajor>;
  struct Line {
    int number = 0;
    std::string text;
  };

  [[noreturn]] void fail(const std::string& key, const std::string& what,
                         std::string_view remedy = kRemedy) const {
    throw InputError(key + " " + what, file_.string() + ":" + std::to_string(lines_.at(key).number),
                     remedy);
  }

  Eigen::Matrix3d checked_rotation(const std::string& key, const Eigen::Matrix3d& R) const {
    if (!is_rotation(R, kRotationTolerance)) fail(key, "is not a rotation");
    return nearest_rotation(R);
  }

  /// Written so that NaN fails, too: the inverse of a tiny focal length has it.
  Eigen::Vector3d checked_translation(const std::string& key, const Eigen::Vector3d& t) const {
    if (!(t.norm() <= kMaxLever)) {
      const bool like_millimeters = t.norm() <= 1000 * kMaxLever;
      fail(key, fmt::format("has a translation of {:.6g} m, over {:g} m", t.norm(), kMaxLever),
           like_millimeters ? "give it in meters: these are likely millimeters" : kRemedy);
    }
    return t;
  }

  std::filesystem::path file_;
  std::map<std::string, Line> lines_;
};

}  // namespace

KittiCalibration read_kitti_raw_calibration(const std::filesystem::path& date_folder) {
  const CalibrationFile cameras(date_folder / "calib_cam_to_cam.txt");
  KittiCalibration calibration;
  RigidMotion R_rect = RigidMotion::Identity();
  R_rect.linear() = cameras.rotation("R_rect_00");
  calibration.T_cam0_lidar =
      R_rect * CalibrationFile(date_folder / "calib_velo_to_cam.txt").motion();
  for (int k = 0; k < kCameras; ++k) {
    const std::string suffix = fmt::format("_0{}", k);
    if (!cameras.has("P_rect" + suffix)) continue;
    Camera camera = cameras.projection("P_rect" + suffix, k);
    cameras.read_size("S_rect" + suffix, "P_rect" + suffix, camera);
    camera.T_cam_lidar = camera.T_cam_lidar * calibration.T_cam0_lidar;
    calibration.cameras.emplace(k, camera);
  }
  const std::filesystem::path imu = date_folder / "calib_imu_to_velo.txt";
  if (std::filesystem::exists(imu)) {
    calibration.T_imu_lidar = CalibrationFile(imu).motion().inverse();
  }
  return calibration;
}

KittiCalibration read_kitti_odometry_calibration(const std::filesystem::path& file) {
  const CalibrationFile lines(file);
  KittiCalibration calibration;
  calibration.T_cam0_lidar = lines.motion("Tr");
  for (int k = 0; k < kCameras; ++k) {
    const std::string key = fmt::format("P{}", k);
    if (!lines.has(key)) continue;
    Camera camera = lines.projection(key, k);
    camera.T_cam_lidar = camera.T_cam_lidar * calibration.T_cam0_lidar;
    calibration.cameras.emplace(k, camera);
  }
  return calibration;
}

}  // namespace fovea
