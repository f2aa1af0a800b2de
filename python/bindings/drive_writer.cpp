// fovea.DriveWriter: the base of adapters for other data sets.
#include <pybind11/eigen.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <mutex>
#include <optional>
#include <stdexcept>

#include "fovea/api/recorded_camera.h"
#include "fovea/drive.h"
#include "python/bindings/bindings.h"
#include "python/bindings/sensor_arrays.h"

namespace fovea::python {
namespace py = pybind11;
namespace {

/// A camera without its name and number.
struct CameraModel {
  DriveCamera camera;
};

CameraModel make_camera(int width, int height, const Eigen::Matrix3d& K, const Doubles& T_lidar_cam,
                        const std::string& distortion_model, const std::vector<double>& D) {
  DriveCamera camera;
  camera.width = width;
  camera.height = height;
  camera.fx = K(0, 0);
  camera.fy = K(1, 1);
  camera.cx = K(0, 2);
  camera.cy = K(1, 2);
  camera.distortion_model = distortion_model;
  camera.distortion = D;
  camera.T_lidar_cam = motion_from(T_lidar_cam);
  recorded_camera(camera);  // an error for one that is none
  return {camera};
}

std::variant<Image, std::filesystem::path> content_of(const py::object& image) {
  if (!py::isinstance<py::array>(image)) return image.cast<std::filesystem::path>();
  return image_from(image);
}

/// A writer that Python's threads take turns with.
class PythonDriveWriter {
 public:
  PythonDriveWriter(const std::filesystem::path& path,
                    const std::map<std::string, CameraModel>& cameras, bool force, bool compensated,
                    const std::map<std::string, Doubles>& further_lidars,
                    const std::string& first_lidar, bool allow_dropped) {
    std::vector<DriveCamera> written;
    for (const auto& [name, model] : cameras) {
      DriveCamera& camera = written.emplace_back(model.camera);
      camera.name = name;
      camera.number = static_cast<int>(written.size()) - 1;
    }
    DriveWriterOptions options{force, compensated, {}, {}, first_lidar, allow_dropped};
    for (const auto& [name, T_lidar_sensor] : further_lidars) {
      options.further_lidars.emplace(name, motion_from(T_lidar_sensor));
    }
    writer_.emplace(path, written, options);
  }

  void add_scan(const std::string& lidar, const Floats& points, TimeNs stamp,
                const std::optional<Floats>& intensity, const std::optional<Floats>& times,
                const std::optional<Rings>& rings) {
    const DriveScan scan{stamp, cloud_from(points, intensity, times, rings)};
    write([&](DriveWriter& writer) { writer.add_scan(lidar, scan); });
  }

  void add(const Floats& points, TimeNs stamp, const std::optional<Floats>& intensity,
           const std::optional<Floats>& times, const std::optional<Rings>& rings,
           const std::map<std::string, py::object>& images,
           const std::map<std::string, TimeNs>& image_stamps,
           const std::optional<Doubles>& T_world_lidar) {
    for (const auto& [name, image_stamp] : image_stamps) {
      if (!images.contains(name))
        throw std::invalid_argument("there is no image of '" + name + "'");
    }
    std::vector<DriveImage> added;
    for (const auto& [name, image] : images) {
      const auto own = image_stamps.find(name);
      added.push_back({name, own == image_stamps.end() ? stamp : own->second, content_of(image)});
    }
    std::optional<RigidMotion> pose;
    if (T_world_lidar) pose = motion_from(*T_world_lidar);
    const DriveScan scan{stamp, cloud_from(points, intensity, times, rings)};
    write([&](DriveWriter& writer) { writer.add(scan, added, pose); });
  }

  py::dict close() {
    WrittenDrive figures;
    write([&](DriveWriter& writer) {
      figures = writer.close();
      writer_.reset();
    });
    py::dict result;
    result["scans"] = figures.scans;
    result["images"] = figures.images;
    result["poses"] = figures.poses;
    result["points_dropped"] = figures.points_dropped;
    return result;
  }
  void discard() {
    const py::gil_scoped_release others_run;
    const std::lock_guard one_at_a_time(mutex_);
    writer_.reset();
  }
  bool is_open() {
    const py::gil_scoped_release others_run;
    const std::lock_guard one_at_a_time(mutex_);
    return writer_.has_value();
  }

 private:
  template <class Write>
  void write(Write&& write) {
    const py::gil_scoped_release others_run;
    const std::lock_guard one_at_a_time(mutex_);
    if (!writer_) throw std::logic_error("the drive is closed");
    write(*writer_);
  }

  std::optional<DriveWriter> writer_;
  std::mutex mutex_;
};

}  // namespace

void bind_drive_writer(py::module_& module) {
  py::class_<CameraModel>(module, "CameraModel", "A camera of a DriveWriter.")
      .def(py::init(&make_camera), py::arg("width"), py::arg("height"), py::arg("K"),
           py::arg("T_lidar_cam"), py::arg("distortion_model") = "none",
           py::arg("D") = std::vector<double>(),
           "K: 3x3, pixels, pixel centers at integers; T_lidar_cam: 4x4, optical frame (z ahead); "
           "distortion_model: none, plumb_bob, rational_polynomial or equidistant, as in ROS; D: "
           "its coefficients.");
  py::class_<PythonDriveWriter>(module, "DriveWriter",
                                "Writes a drive frame by frame: the base of an adapter for another "
                                "data set. As a context manager, it closes the drive at the end, "
                                "and keeps nothing after an exception.")
      .def(py::init<const std::filesystem::path&, const std::map<std::string, CameraModel>&, bool,
                    bool, const std::map<std::string, Doubles>&, const std::string&, bool>(),
           py::arg("path"), py::kw_only(),
           py::arg("cameras") = std::map<std::string, CameraModel>(), py::arg("force") = false,
           py::arg("compensated") = false,
           py::arg("further_lidars") = std::map<std::string, Doubles>(),
           py::arg("first_lidar") = "first", py::arg("allow_dropped") = false,
           "cameras: by name; their numbers follow the names. compensated: the scans' motion was "
           "undone already. further_lidars: T_lidar_sensor, 4x4, by name; first_lidar: the name of "
           "the first LiDAR. allow_dropped: over 10 % of the points may be unusable. OutputError "
           "if the folder exists (except with force).")
      .def("add_scan", &PythonDriveWriter::add_scan, py::arg("lidar"), py::arg("points"),
           py::arg("stamp"), py::kw_only(), py::arg("intensity") = py::none(),
           py::arg("times") = py::none(), py::arg("rings") = py::none(),
           "Adds a scan of a further LiDAR, in its own frame. It belongs to the frame nearest in "
           "time. Columns as in add().")
      .def("add", &PythonDriveWriter::add, py::arg("points"), py::arg("stamp"), py::kw_only(),
           py::arg("intensity") = py::none(), py::arg("times") = py::none(),
           py::arg("rings") = py::none(), py::arg("images") = std::map<std::string, py::object>(),
           py::arg("image_stamps") = std::map<std::string, TimeNs>(),
           py::arg("T_world_lidar") = py::none(),
           "Adds the next frame. points: N x 3, m, LiDAR frame; stamp: ns; intensity: N, up to 1, "
           "255 or 65535; times: N, s from the stamp; rings: N; images: by camera, uint8 arrays or "
           "PNG or "
           "JPEG files; image_stamps: by camera, ns (default: the scan's); T_world_lidar: 4x4. "
           "ValueError for what is no frame, InputError for files that are no images.")
      .def("close", &PythonDriveWriter::close,
           "Gives the drive its name. The numbers of scans, images, poses and dropped points.")
      .def("__enter__", [](py::object self) { return self; })
      .def("__exit__", [](PythonDriveWriter& self, const py::object& type, const py::object&,
                          const py::object&) {
        if (!type.is_none()) {
          self.discard();
        } else if (self.is_open()) {
          self.close();
        }
      });
}

}  // namespace fovea::python
