// fovea.map_drive: a whole drive into a map file.
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <variant>

#include "fovea/errors.h"
#include "fovea/mapper.h"
#include "python/bindings/bindings.h"
#include "python/bindings/drive.h"
#include "python/bindings/json_object.h"
#include "python/bindings/run_watch.h"
#include "python/bindings/settings.h"

namespace fovea::python {
namespace py = pybind11;
namespace {

std::variant<Drive, std::filesystem::path> drive_or_folder(const py::object& drive) {
  if (py::isinstance<Drive>(drive)) return drive.cast<const Drive&>();
  return py::module_::import("os").attr("fspath")(drive).cast<std::filesystem::path>();
}

/// A Drive as it is, unless cameras or frames are chosen. Otherwise its folder is opened.
Drive opened(const std::variant<Drive, std::filesystem::path>& drive, const DriveOptions& options) {
  const auto* const open = std::get_if<Drive>(&drive);
  if (open == nullptr) return Drive(std::get<std::filesystem::path>(drive), options);
  const bool is_chosen = !options.cameras.empty() || options.begin || options.end;
  return is_chosen ? Drive(open->folder(), options) : *open;
}

py::object map_in_python(const py::object& drive, const std::filesystem::path& output,
                         const std::string& preset, const py::dict& settings,
                         const std::string& hold_out, const FrameRange& frames,
                         const std::vector<int>& cameras, int threads, bool calibrate, bool resume,
                         bool force, const py::object& callback) {
  RunWatch watch;
  const MapOptions options{mapper_settings(preset, settings),
                           hold_out,
                           calibrate,
                           resume,
                           force,
                           threads,
                           watch.token()};
  const auto progress = [&](const MapProgress& now) {
    watch.call([&] {
      if (!callback.is_none()) callback(now);
    });
  };
  const auto source = drive_or_folder(drive);
  std::string summary, error;
  {
    const py::gil_scoped_release others_run;
    try {
      summary =
          map_drive(opened(source, drive_options(cameras, frames)), output, options, progress).json;
    } catch (const Error& thrown) {
      if (!watch.has_raised()) throw;
      error = thrown.what();
    }
  }
  watch.rethrow(error);
  return json_object(summary);
}

}  // namespace

void bind_map_drive(py::module_& module) {
  py::class_<MapProgress>(module, "Progress", "How far a run of map_drive() is, after a frame.")
      .def_readonly("done", &MapProgress::done, "Frames.")
      .def_readonly("total", &MapProgress::total, "Frames.")
      .def_readonly("points", &MapProgress::points, "In the map so far.")
      .def_readonly("frame", &MapProgress::frame, "The record of the frame just done.");

  module.def("map_drive", &map_in_python, py::arg("drive"), py::arg("output"), py::kw_only(),
             py::arg("preset") = "default", py::arg("settings") = py::dict(),
             py::arg("hold_out") = "", py::arg("frames") = FrameRange(),
             py::arg("cameras") = std::vector<int>(), py::arg("threads") = 0,
             py::arg("calibrate") = false, py::arg("resume") = false, py::arg("force") = false,
             py::arg("callback") = py::none(),
             "Maps a drive into a map file, as `fovea map` does.\n\n"
             "drive: a folder, or a Drive with its cameras and frames.\n\n"
             "callback(progress) is called after each frame, in order. What it raises, or Ctrl-C, "
             "ends the run after the frames at hand: what was mapped is in the file, which "
             "resume=True goes on with.\n\n"
             "OutputError if the output is an input, a file of another kind or no ordinary file, "
             "also with force=True (docs/outputs.md).\n\n"
             "Returns the figures that `fovea map --report` writes, as a dict.");
}

}  // namespace fovea::python
