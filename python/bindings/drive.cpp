#include "python/bindings/drive.h"

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <stdexcept>

#include "fovea/errors.h"
#include "python/bindings/bindings.h"
#include "python/bindings/columns.h"
#include "python/bindings/path_object.h"

namespace fovea::python {
namespace py = pybind11;
namespace {

Drive open(const std::filesystem::path& path, const std::vector<int>& cameras,
           const FrameRange& frames, bool use_navigation, bool use_images) {
  DriveOptions options;
  options.cameras = cameras;
  std::tie(options.begin, options.end) = frames;
  options.use_navigation = options.use_imu = use_navigation;
  options.use_images = use_images;
  return {open_drive(path, options)};
}

LoadedFrame load_result(const Drive& drive, int index) {
  const DriveInfo& info = drive.source->info();
  if (index < info.begin || index >= info.end) {
    throw py::index_error("the drive has no frame " + std::to_string(index));
  }
  const py::gil_scoped_release others_run;
  return drive.source->load(index);
}

DriveFrame frame_of(const Drive& drive, Frame frame) {
  return {drive.source, std::make_shared<const Frame>(std::move(frame))};
}

std::string reason_of(const SkippedFrame& skipped) {
  return "frame " + std::to_string(skipped.index) + " is skipped: " + to_string(skipped.reason);
}

DriveFrame load(const Drive& drive, int index) {
  LoadedFrame result = load_result(drive, index);
  if (const auto* skipped = std::get_if<SkippedFrame>(&result)) {
    throw InputError(reason_of(*skipped), skipped->detail, "go on with the next one");
  }
  return frame_of(drive, std::get<Frame>(std::move(result)));
}

/// The frames that can be used; a warning tells of each of the others.
class FrameIterator {
 public:
  explicit FrameIterator(const Drive& drive) : drive_(drive), next_(drive.source->info().begin) {}

  DriveFrame next() {
    while (next_ < drive_.source->info().end) {
      LoadedFrame result = load_result(drive_, next_++);
      if (auto* frame = std::get_if<Frame>(&result)) return frame_of(drive_, std::move(*frame));
      warn(std::get<SkippedFrame>(result));
    }
    throw py::stop_iteration();
  }

 private:
  static void warn(const SkippedFrame& skipped) {
    const std::string text = reason_of(skipped) + ", " + skipped.detail;
    if (PyErr_WarnEx(PyExc_UserWarning, text.c_str(), 1) != 0) throw py::error_already_set();
  }

  Drive drive_;
  int next_;
};

/// Height x width x channels; nothing for an image that is missing.
std::vector<std::optional<py::array>> images(const DriveFrame& self) {
  std::vector<std::optional<py::array>> arrays;
  for (const Image& image : self.frame->images) {
    if (image.empty()) {
      arrays.emplace_back();
    } else {
      arrays.emplace_back(shared_array(py::dtype::of<std::uint8_t>(),
                                       {image.height, image.width, image.channels},
                                       image.data.data(), self.frame));
    }
  }
  return arrays;
}

std::vector<std::string> missing_images(const DriveFrame& self) {
  std::vector<std::string> lines;
  for (const MissingImage& image : self.frame->missing_images) {
    lines.push_back("camera " + std::to_string(image.camera) + ": " + to_string(image.reason) +
                    ", " + image.detail);
  }
  return lines;
}

/// The scan as a cloud that keeps its frame alive.
std::shared_ptr<const PointCloud> scan_of(const DriveFrame& self) {
  return {self.frame, &self.frame->scan};
}

void bind_frame(py::module_& module) {
  py::class_<DriveFrame>(module, "Frame",
                         "A LiDAR sweep with its images. Arrays are read-only and not copied.")
      .def_property_readonly("index", [](const DriveFrame& self) { return self.frame->index; })
      .def_property_readonly(
          "stamp", [](const DriveFrame& self) { return self.frame->stamp; }, "ns.")
      .def_property_readonly(
          "points",
          [](const DriveFrame& self) { return column_array(scan_of(self), &PointCloud::position); },
          "N x 3 float32, m, LiDAR frame, as measured: not yet motion compensated.")
      .def_property_readonly(
          "intensity",
          [](const DriveFrame& self) {
            return optional_column(scan_of(self), &PointCloud::intensity);
          },
          "N float32, 0-1, or None.")
      .def_property_readonly(
          "time",
          [](const DriveFrame& self) { return optional_column(scan_of(self), &PointCloud::time); },
          "N float32, s from the stamp, or None.")
      .def_property_readonly(
          "sensor",
          [](const DriveFrame& self) {
            return optional_column(scan_of(self), &PointCloud::sensor);
          },
          "N uint16, number of the LiDAR, or None for a drive with one.")
      .def_property_readonly(
          "dropped_points",
          [](const DriveFrame& self) { return self.frame->dropped_points.total(); },
          "Points of the scan that are not finite or out of reach, and not in `points`.")
      .def_property_readonly("images", &images,
                             "A height x width x channels uint8 array a camera of the drive, RGB "
                             "or grey, or None where it is missing.")
      .def_property_readonly("missing_images", &missing_images,
                             "Why images are None, a line each.");
}

void bind_camera(py::module_& module) {
  py::class_<Camera>(module, "Camera", "A pinhole camera; pixel centres at integers.")
      .def_readonly("index", &Camera::index, "The drive's number for it.")
      .def_readonly("width", &Camera::width)
      .def_readonly("height", &Camera::height)
      .def_readonly("image_delay", &Camera::image_delay,
                    "s, from a scan's stamp to its image; the drive's median.")
      .def_property_readonly(
          "K",
          [](const Camera& c) {
            Eigen::Matrix3d K;
            K << c.fx, 0, c.cx, 0, c.fy, c.cy, 0, 0, 1;
            return matrix_array<3, 3>(K);
          },
          "3x3, pixels.")
      .def_property_readonly(
          "T_cam_lidar", [](const Camera& camera) { return motion_array(camera.T_cam_lidar); },
          "4x4.");
}

}  // namespace

void DriveFrame::require_of(const Drive& drive) const {
  if (source != drive.source) {
    throw std::invalid_argument("the frame is not of the drive that this was made for");
  }
}

void bind_drive(py::module_& module) {
  bind_camera(module);
  bind_frame(module);
  py::class_<FrameIterator>(module, "_FrameIterator")
      .def("__iter__", [](py::object self) { return self; })
      .def("__next__", &FrameIterator::next);

  py::class_<Drive>(module, "Drive",
                    "A drive: KITTI's folders or one with a drive.toml. Iteration gives the "
                    "frames that can be used and warns of each that cannot.")
      .def(py::init(&open), py::arg("path"), py::kw_only(), py::arg("cameras") = std::vector<int>(),
           py::arg("frames") = FrameRange(), py::arg("use_navigation") = true,
           py::arg("use_images") = true, py::call_guard<py::gil_scoped_release>())
      .def_property_readonly("path", [](const Drive& drive) { return drive.source->info().path; })
      .def("__fspath__", [](const Drive& drive) { return name_object(drive.source->info().path); })
      .def_property_readonly("kind", [](const Drive& drive) { return drive.source->info().kind; })
      .def_property_readonly(
          "cameras", [](const Drive& drive) { return drive.source->info().calibration.cameras; })
      .def_property_readonly(
          "frames",
          [](const Drive& drive) {
            const DriveInfo& info = drive.source->info();
            return py::module_::import("builtins").attr("range")(info.begin, info.end);
          },
          "Indices; some frames may turn out to be skipped.")
      .def_property_readonly(
          "notes", [](const Drive& drive) { return drive.source->info().notes; },
          "What a user must be told.")
      .def("load", &load, py::arg("index"),
           "A frame. IndexError beyond the range; InputError if it cannot be used.")
      .def("__iter__", [](const Drive& drive) { return FrameIterator(drive); });
}

}  // namespace fovea::python
