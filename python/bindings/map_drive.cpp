// fovea.map_drive: a whole drive into a map file.
#include "fovea/pipeline/map_drive.h"

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <nlohmann/json.hpp>

#include "fovea/core/parallel.h"
#include "fovea/drive/command_files.h"
#include "fovea/errors.h"
#include "fovea/pipeline/summary_json.h"
#include "python/bindings/bindings.h"
#include "python/bindings/drive.h"
#include "python/bindings/json_object.h"
#include "python/bindings/run_watch.h"
#include "python/bindings/settings.h"

namespace fovea::python {
namespace py = pybind11;
namespace {

/// A RunProgress that a callback may keep.
struct Progress {
  int done = 0, total = 0;
  std::size_t points = 0;
  FrameRecord frame;
};

py::object map_drive(const std::filesystem::path& drive, const std::filesystem::path& output,
                     const std::string& preset, const py::dict& settings,
                     const std::string& hold_out, const FrameRange& frames,
                     const std::vector<int>& cameras, int threads, bool calibrate, bool resume,
                     bool force, const py::object& callback) {
  check_files({{drive.string()}, {{output.string(), ContentKind::kMap, force || resume}}});
  DriveOptions wanted;
  wanted.cameras = cameras;
  std::tie(wanted.begin, wanted.end) = frames;
  MapJob job;
  job.output = output;
  job.settings = map_settings(preset, settings);
  job.hold_out = HoldOut::parse(hold_out);
  job.calibrate = calibrate;
  job.resume = resume;
  job.force = force;
  RunWatch watch;
  job.stop = watch.token();
  const auto progress = [&](const RunProgress& now) {
    watch.call([&] {
      if (callback.is_none()) return;
      callback(Progress{now.done, now.total, now.points, *now.latest});
    });
  };
  std::string summary, error;
  {
    const py::gil_scoped_release others_run;
    const ThreadLimit limit(threads);
    const auto source = open_drive(drive, wanted);
    try {
      using Json = nlohmann::ordered_json;
      // A note may quote a file's name in any encoding.
      summary = to_json(fovea::map_drive(*source, job, progress))
                    .dump(-1, ' ', false, Json::error_handler_t::replace);
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
  py::class_<Progress>(module, "Progress", "How far a run of map_drive() is, after a frame.")
      .def_readonly("done", &Progress::done, "Frames.")
      .def_readonly("total", &Progress::total, "Frames.")
      .def_readonly("points", &Progress::points, "In the map so far.")
      .def_readonly("frame", &Progress::frame, "The record of the frame just done.");

  module.def("map_drive", &map_drive, py::arg("drive"), py::arg("output"), py::kw_only(),
             py::arg("preset") = "default", py::arg("settings") = py::dict(),
             py::arg("hold_out") = "", py::arg("frames") = FrameRange(),
             py::arg("cameras") = std::vector<int>(), py::arg("threads") = 0,
             py::arg("calibrate") = false, py::arg("resume") = false, py::arg("force") = false,
             py::arg("callback") = py::none(),
             "Maps a drive into a map file, as `fovea map` does.\n\n"
             "callback(progress) is called after each frame, in order. What it raises, or Ctrl-C, "
             "ends the run after the frames at hand: what was mapped is in the file, which "
             "resume=True goes on with.\n\n"
             "OutputError if the output is an input, a file of another kind or no ordinary file, "
             "also with force=True (docs/outputs.md).\n\n"
             "Returns the figures that `fovea map --report` writes, as a dict.");
}

}  // namespace fovea::python
