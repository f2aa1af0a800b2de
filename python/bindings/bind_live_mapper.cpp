// fovea.LiveMapper as Python has it.
#include <pybind11/eigen.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <utility>

#include "fovea/core/read_file.h"
#include "fovea/drive/command_files.h"
#include "fovea/errors.h"
#include "fovea/live.h"
#include "python/bindings/bindings.h"
#include "python/bindings/live_mapper.h"
#include "python/bindings/settings.h"

namespace fovea::python {
namespace py = pybind11;
namespace fs = std::filesystem;
namespace {

/// The file drive.toml; nothing if `drive` is its text.
std::optional<fs::path> file_of(const py::object& drive) {
  if (py::isinstance<py::str>(drive) && drive.cast<std::string>().find('\n') != std::string::npos) {
    return std::nullopt;
  }
  const auto path = drive.cast<fs::path>();
  return fs::is_directory(path) ? path / "drive.toml" : path;
}

/// OutputError for outputs that would replace the description of the sensors.
void check_input(const fs::path& drive, const LiveRunOptions& options) {
  const LiveMapperOptions& mapper = options.mapper;
  CommandFiles files{{drive.string()}, {}, {mapper.record.string(), FolderUse::kReplace}};
  files.outputs = {{options.output.string(), ContentKind::kMap, mapper.force || mapper.resume}};
  check_files(files);
}

std::unique_ptr<PythonLiveMapper> make_live_mapper(
    const py::object& drive, const fs::path& output, const std::string& preset,
    const py::dict& settings, const std::vector<int>& cameras, int threads, bool resume, bool force,
    double max_wait, bool every_frame, bool expects_navigation,
    const std::optional<fs::path>& record, const py::object& on_pose) {
  LiveRunOptions options;
  options.output = output;
  options.mapper = {mapper_settings(preset, settings),
                    cameras,
                    expects_navigation,
                    max_wait,
                    every_frame,
                    resume,
                    force,
                    record.value_or(fs::path()),
                    threads,
                    {}};
  options.on_pose = on_pose;
  if (!on_pose.is_none() && PyCallable_Check(on_pose.ptr()) == 0) {
    throw py::type_error("on_pose cannot be called");
  }
  if (const std::optional<fs::path> file = file_of(drive)) {
    check_input(*file, options);
    options.drive_toml = read_text(*file);
  } else {
    options.drive_toml = drive.cast<std::string>();
  }
  return std::make_unique<PythonLiveMapper>(std::move(options));
}

/// Nullptr before the constructor has ended.
LiveRun* run_of(PyObject* mapper) {
  auto* const instance = reinterpret_cast<py::detail::instance*>(mapper);
  if (!instance->get_value_and_holder().holder_constructed()) return nullptr;
  return &py::cast<PythonLiveMapper&>(py::handle(mapper)).run();
}

/// The garbage collector finds cycles through on_pose and what it raised.
void let_collect(PyHeapTypeObject* heap_type) {
  PyTypeObject& type = heap_type->ht_type;
  type.tp_flags |= Py_TPFLAGS_HAVE_GC;
  type.tp_traverse = [](PyObject* self, visitproc visit, void* arg) {
    Py_VISIT(Py_TYPE(self));
    LiveRun* const run = run_of(self);
    if (run == nullptr) return 0;
    Py_VISIT(run->on_pose().ptr());
    Py_VISIT(run->raised().ptr());
    return 0;
  };
  type.tp_clear = [](PyObject* self) {
    LiveRun* const run = run_of(self);
    if (run == nullptr) return 0;
    // Each is released when it is no longer in its place.
    const py::object on_pose = std::exchange(run->on_pose(), py::none());
    const py::object raised = std::exchange(run->raised(), py::object());
    return 0;
  };
}

void bind_live_pose(py::module_& module) {
  py::class_<LivePose>(module, "LivePose", "A frame of a LiveMapper when it has its pose.")
      .def_readonly("index", &LivePose::index)
      .def_readonly("stamp", &LivePose::stamp, "ns, of the scan.")
      .def_readonly("state", &LivePose::state, "'tracked', 'lost' or 'restarted'.")
      .def_property_readonly(
          "T_local_lidar", [](const LivePose& pose) { return motion_array(pose.T_local_lidar); },
          "4x4.")
      .def_property_readonly(
          "covariance",
          [](const LivePose& pose) -> std::optional<py::array_t<double>> {
            if (!pose.covariance) return std::nullopt;
            return matrix_array(*pose.covariance);
          },
          "6x6, of a twist of the LiDAR in its own frame, rotation first (rad^2, m^2); or None.");
}

}  // namespace

void bind_live_mapper(py::module_& module) {
  bind_live_pose(module);
  py::class_<PythonLiveMapper>(
      module, "LiveMapper",
      "Maps scans, images and poses while a program's threads measure them. Images and poses are "
      "matched to scans by their stamps, as by fovea::LiveSource (docs/live.md): each sensor's "
      "data come in the order of their stamps, the sensors in any order, from any thread.\n\n"
      "Mapping runs in a thread of its own. What ends it early is raised by the next add function "
      "and by close(). As a context manager it is closed at the end. After an exception it ends "
      "with the frames at hand.",
      py::custom_type_setup(&let_collect))
      .def(py::init(&make_live_mapper), py::arg("drive"), py::arg("output"), py::kw_only(),
           py::arg("preset") = "default", py::arg("settings") = py::dict(),
           py::arg("cameras") = std::vector<int>(), py::arg("threads") = 0,
           py::arg("resume") = false, py::arg("force") = false,
           py::arg("max_wait") = LiveMapperOptions().max_wait, py::arg("every_frame") = false,
           py::arg("expects_navigation") = false, py::arg("record") = py::none(),
           py::arg("on_pose") = py::none(),
           "drive: a drive.toml that describes the sensors (docs/drives.md), as a path or as text "
           "of several lines. max_wait: s from the arrival of a scan, for its images and poses. "
           "every_frame: add functions wait if the mapper is behind; otherwise scans are dropped "
           "and textures skipped, and counted. expects_navigation: the map begins when poses or "
           "positions are there. resume: goes on with the map of an earlier LiveMapper. record: a "
           "folder, for the frames as a drive. on_pose(pose): is called with a LivePose after "
           "each frame, in order, in the tracker's thread: it must be fast, and may not call the "
           "mapper. What it raises ends the map.\n\n"
           "ConfigError and InputError for a drive.toml that cannot be used, OutputError for "
           "outputs that exist (except with force or resume).")
      .def("add_scan", &PythonLiveMapper::add_scan, py::arg("stamp"), py::arg("points"),
           py::kw_only(), py::arg("intensity") = py::none(), py::arg("times") = py::none(),
           py::arg("rings") = py::none(), py::arg("lidar") = "",
           "Adds a sweep. stamp: ns; points: N x 3, m, LiDAR frame, as measured, or N x 4 with "
           "intensity; intensity: N, 0 to intensity_max of drive.toml; times: N, s from the stamp; "
           "rings: N; lidar: the name, of several.")
      .def("add_image", &PythonLiveMapper::add_image, py::arg("camera"), py::arg("stamp"),
           py::arg("image"), py::kw_only(), py::arg("exposure") = py::none(),
           "Adds an image as the camera took it. camera: its name; stamp: ns; image: height x "
           "width x 3 or height x width uint8, or the bytes of a PNG or JPEG file; exposure: s, "
           "times the amplification.")
      .def("add_pose", &PythonLiveMapper::add_pose, py::arg("stamp"), py::arg("T_world_body"),
           "Adds a pose of the body of drive.toml, 4x4, m, in a world that never jumps. stamp: ns.")
      .def("add_position", &PythonLiveMapper::add_position, py::arg("stamp"), py::arg("latitude"),
           py::arg("longitude"), py::arg("altitude"), py::kw_only(), py::arg("accuracy") = 0.0,
           py::arg("roll_pitch_yaw") = py::none(),
           "Adds a position of the antenna. stamp: ns; latitude, longitude: degrees; altitude: m; "
           "accuracy: m, standard deviation of a coordinate (0: not known; infinite: no fix); "
           "roll_pitch_yaw: rad, yaw 0 is east.")
      .def("add_imu", &PythonLiveMapper::add_imu, py::arg("stamp"), py::arg("angular_velocity"),
           py::arg("acceleration"), py::kw_only(), py::arg("R_enu_imu") = py::none(),
           "Adds a record of the IMU, in its own frame. stamp: ns; angular_velocity: 3, rad/s; "
           "acceleration: 3, m/s^2, gravity included; R_enu_imu: 3x3, orientation.")
      .def("add_wheel_speed", &PythonLiveMapper::add_wheel_speed, py::arg("stamp"),
           py::arg("speed"), "Adds a speed of the body ahead, m/s. stamp: ns.")
      .def("close", &PythonLiveMapper::close,
           "Waits until the map has all frames; data that come later are dropped. Ctrl-C ends the "
           "map with the frames at hand, and is a KeyboardInterrupt. Returns the figures that "
           "`fovea map --report` writes, as a dict, with those of the source as 'live'.")
      .def_property_readonly(
          "missing", [](PythonLiveMapper& self) { return self.run().mapper().missing(); },
          "What the beginning of the map waits for; empty: nothing.")
      .def_property_readonly(
          "figures", [](PythonLiveMapper& self) { return self.run().mapper().figures(); },
          "What came and what was not used, so far, by name.")
      .def("__enter__", [](py::object self) { return self; })
      .def("__exit__", [](PythonLiveMapper& self, const py::object&, const py::object& raised,
                          const py::object&) { self.exit(raised); });
  py::module_::import("atexit").attr("register")(py::cpp_function(&LiveRun::end_all));
}

}  // namespace fovea::python
