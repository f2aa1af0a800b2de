#include "python/bindings/drive.h"

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <tuple>

#include "fovea/api/drive_content.h"
#include "fovea/drive/lost_drive.h"
#include "python/bindings/bindings.h"
#include "python/bindings/path_object.h"

namespace fovea::python {
namespace py = pybind11;
namespace {

Drive open(const std::filesystem::path& path, const std::vector<int>& cameras,
           const FrameRange& frames, bool use_navigation, bool use_images) {
  DriveOptions options = drive_options(cameras, frames);
  options.use_navigation = options.use_imu = use_navigation;
  options.use_images = use_images;
  return Drive(path, options);
}

/// Half-open.
std::pair<int, int> range_of(const Drive& drive) {
  const DriveInfo& info = drive.content()->source->info();
  return {info.begin, info.end};
}

FrameOfDrive load(const Drive& drive, int index) {
  const py::gil_scoped_release others_run;
  return {drive, drive.load(index)};
}

/// The frames that can be used; a warning tells of each of the others.
class FrameIterator {
 public:
  explicit FrameIterator(const Drive& drive) : drive_(drive) {
    std::tie(next_, end_) = range_of(drive);
  }

  FrameOfDrive next() {
    while (next_ < end_) {
      try {
        return load(drive_, next_++);
      } catch (const DriveLostError&) {
        throw;
      } catch (const InputError& skipped) {
        warn(skipped.problem() + ", " + skipped.where());
      }
    }
    throw py::stop_iteration();
  }

 private:
  static void warn(const std::string& text) {
    if (PyErr_WarnEx(PyExc_UserWarning, text.c_str(), 1) != 0) throw py::error_already_set();
  }

  Drive drive_;
  int next_ = 0, end_ = 0;
};

py::str text_of(const Drive& drive) {
  const auto [begin, end] = range_of(drive);
  std::string numbers;
  for (const Camera& camera : drive.cameras()) {
    numbers += (numbers.empty() ? "" : ", ") + std::to_string(camera.index);
  }
  return py::str("<fovea.Drive {!r}, {}, frames {} to {}, cameras [{}]>")
      .format(name_object(drive.folder()), drive.kind(), begin, end - 1, numbers);
}

}  // namespace

DriveOptions drive_options(const std::vector<int>& cameras, const FrameRange& frames) {
  DriveOptions options;
  options.cameras = cameras;
  std::tie(options.begin, options.end) = frames;
  return options;
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
      .def_property_readonly("path", [](const Drive& drive) { return drive.folder(); })
      .def("__fspath__", [](const Drive& drive) { return name_object(drive.folder()); })
      .def_property_readonly("kind", [](const Drive& drive) { return drive.kind(); })
      .def_property_readonly("cameras", [](const Drive& drive) { return drive.cameras(); })
      .def_property_readonly(
          "frames",
          [](const Drive& drive) {
            const auto [begin, end] = range_of(drive);
            return py::module_::import("builtins").attr("range")(begin, end);
          },
          "Indices; some frames may turn out to be skipped.")
      .def_property_readonly(
          "notes", [](const Drive& drive) { return drive.notes(); }, "What a user must be told.")
      .def("load", &load, py::arg("index"),
           "A frame. IndexError beyond the range; InputError if it cannot be used.")
      .def("__getitem__", &load, py::arg("index"),
           "The frame of that number, as load(). Numbers are those of `frames`: not places, and "
           "not below 0.")
      .def(
          "__len__",
          [](const Drive& drive) {
            const auto [begin, end] = range_of(drive);
            return static_cast<std::size_t>(std::max(0, end - begin));
          },
          "Number of `frames`.")
      .def_property_readonly(
          "sweep", [](const Drive& drive) { return drive.sweep(); },
          "SweepTiming of scans whose points have no times.")
      .def_property_readonly(
          "is_compensated", [](const Drive& drive) { return drive.is_compensated(); },
          "Whether the motion was undone in the scans already.")
      .def("__repr__", &text_of)
      .def("__iter__", [](const Drive& drive) { return FrameIterator(drive); });
}

}  // namespace fovea::python
