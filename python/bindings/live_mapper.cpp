#include "python/bindings/live_mapper.h"

#include <cmath>
#include <stdexcept>

#include "python/bindings/json_object.h"

namespace fovea::python {
namespace py = pybind11;
namespace {

using Vector = Eigen::Vector3d;

PointCloud scan_of(const Floats& points, const std::optional<Floats>& intensity,
                   const std::optional<Floats>& times, const std::optional<Rings>& rings) {
  PointCloud cloud;
  if (points.ndim() == 2 && points.shape(1) == 4) {
    if (intensity) throw std::invalid_argument("points N x 4 have an intensity already");
    const auto column = [&](py::ssize_t begin, py::ssize_t end) {
      return points[py::make_tuple(py::ellipsis(), py::slice(begin, end, 1))];
    };
    cloud = cloud_from(Floats::ensure(column(0, 3)), Floats::ensure(column(3, 4).attr("ravel")()),
                       times, rings);
  } else {
    cloud = cloud_from(points, intensity, times, rings);
  }
  const auto fits = [&](const auto& column) {
    return column.empty() || column.size() == cloud.size();
  };
  if (!fits(cloud.intensity) || !fits(cloud.time) || !fits(cloud.ring)) {
    throw std::invalid_argument("intensity, times and rings need one number for each point");
  }
  return cloud;
}

template <class... Vectors>
void require_finite(const Vectors&... vectors) {
  if (!(... && vectors.allFinite())) throw std::invalid_argument("a number is not finite");
}

}  // namespace

PythonLiveMapper::~PythonLiveMapper() {
  const bool was_closed = run_->was_closed();
  const std::string failure = run_->failure();
  LiveRun::end(run_);
  if (was_closed) return;
  if (PyErr_WarnEx(PyExc_ResourceWarning, "a LiveMapper was not closed", 1) != 0) {
    PyErr_WriteUnraisable(nullptr);
  }
  if (failure.empty()) return;
  PyErr_SetString(PyExc_RuntimeError, ("a map has ended: " + failure).c_str());
  PyErr_WriteUnraisable(nullptr);
}

void PythonLiveMapper::add_scan(TimeNs stamp, const Floats& points,
                                const std::optional<Floats>& intensity,
                                const std::optional<Floats>& times,
                                const std::optional<Rings>& rings, const std::string& lidar) {
  PointCloud scan = scan_of(points, intensity, times, rings);
  run_->add([&](LiveMapper& mapper) { mapper.add_scan(stamp, std::move(scan), lidar); });
}

void PythonLiveMapper::add_image(const std::string& camera, TimeNs stamp, const py::object& image,
                                 std::optional<double> exposure) {
  std::variant<Image, std::string> content;
  if (py::isinstance<py::bytes>(image)) {
    content = image.cast<std::string>();
  } else {
    content = image_from(image);
  }
  run_->add(
      [&](LiveMapper& mapper) { mapper.add_image(camera, stamp, std::move(content), exposure); });
}

void PythonLiveMapper::add_pose(TimeNs stamp, const Doubles& T_world_body) {
  const RigidMotion pose = motion_from(T_world_body);
  run_->add([&](LiveMapper& mapper) { mapper.add_pose(stamp, pose); });
}

void PythonLiveMapper::add_position(TimeNs stamp, double latitude, double longitude,
                                    double altitude, double accuracy,
                                    const std::optional<Vector>& roll_pitch_yaw) {
  require_finite(Vector(latitude, longitude, altitude));
  if (roll_pitch_yaw) require_finite(*roll_pitch_yaw);
  if (!(accuracy >= 0)) throw std::invalid_argument("accuracy is not 0 or more");
  const GnssPosition position{latitude, longitude, altitude, accuracy, roll_pitch_yaw};
  run_->add([&](LiveMapper& mapper) { mapper.add_position(stamp, position); });
}

void PythonLiveMapper::add_imu(TimeNs stamp, const Vector& angular_velocity,
                               const Vector& acceleration,
                               const std::optional<Eigen::Matrix3d>& R_enu_imu) {
  require_finite(angular_velocity, acceleration);
  run_->add([&](LiveMapper& mapper) {
    mapper.add_imu(stamp, angular_velocity, acceleration, R_enu_imu);
  });
}

void PythonLiveMapper::add_wheel_speed(TimeNs stamp, double speed) {
  if (!std::isfinite(speed)) throw std::invalid_argument("a number is not finite");
  run_->add([&](LiveMapper& mapper) { mapper.add_wheel_speed(stamp, speed); });
}

py::object PythonLiveMapper::close() { return json_object(run_->close()); }

void PythonLiveMapper::exit(const py::object& raised) {
  if (raised.is_none()) {
    run_->close();
    return;
  }
  const std::string failure = run_->failure();
  LiveRun::end(run_);
  if (!failure.empty() && py::hasattr(raised, "add_note")) {
    raised.attr("add_note")("The map has ended: " + failure);
  }
}

}  // namespace fovea::python
