// A map of scans, images and poses that a Python program gives while it measures.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>

#include "python/bindings/live_run.h"
#include "python/bindings/sensor_arrays.h"

namespace fovea::python {

/// fovea.LiveMapper in Python, whose docstrings describe the functions.
class PythonLiveMapper {
 public:
  explicit PythonLiveMapper(LiveRunOptions options) : run_(LiveRun::start(std::move(options))) {}
  /// Ends the run, and reports if it was not closed.
  ~PythonLiveMapper();
  PythonLiveMapper(const PythonLiveMapper&) = delete;
  PythonLiveMapper& operator=(const PythonLiveMapper&) = delete;

  void add_scan(TimeNs stamp, const Floats& points, const std::optional<Floats>& intensity,
                const std::optional<Floats>& times, const std::optional<Rings>& rings,
                const std::string& lidar);
  void add_image(const std::string& camera, TimeNs stamp, const pybind11::object& image,
                 std::optional<double> exposure);
  void add_pose(TimeNs stamp, const Doubles& T_world_body);
  void add_position(TimeNs stamp, double latitude, double longitude, double altitude,
                    double accuracy, const std::optional<Eigen::Vector3d>& roll_pitch_yaw);
  void add_imu(TimeNs stamp, const Eigen::Vector3d& angular_velocity,
               const Eigen::Vector3d& acceleration,
               const std::optional<Eigen::Matrix3d>& R_enu_imu);
  void add_wheel_speed(TimeNs stamp, double speed);
  pybind11::object close();
  /// End of a `with` block.
  /// @param raised  the exception that ends it, or None
  void exit(const pybind11::object& raised);

  LiveRun& run() { return *run_; }

 private:
  std::shared_ptr<LiveRun> run_;
};

}  // namespace fovea::python
