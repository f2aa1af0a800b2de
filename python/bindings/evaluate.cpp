// fovea.evaluate: scores of a map against a drive.
#include "fovea/evaluation/evaluate.h"

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "fovea/base/parallel.h"
#include "fovea/base/path_name.h"
#include "fovea/pipeline/stored_calibration.h"
#include "python/bindings/bindings.h"
#include "python/bindings/json_object.h"
#include "python/bindings/run_watch.h"

namespace fovea::python {
namespace py = pybind11;
namespace {

std::string report_of(const std::filesystem::path& map_file, const std::filesystem::path& folder,
                      const ProtocolOptions& options) {
  const ScoredMap map =
      load_scored_map(map_file, {.poses = std::nullopt, .drive = name_of(folder)});
  DriveOptions wanted;
  wanted.cameras = options.cameras.empty() ? map.cameras : options.cameras;
  std::unique_ptr<FrameSource> drive = open_drive(folder, wanted);
  const bool corrected = has_stored_calibration(map.meta);
  if (corrected) drive = with_stored_calibration(std::move(drive), map.meta, map_file);
  EvaluationReport report = evaluate(map, *drive, options, [](std::size_t, std::size_t) {
    const py::gil_scoped_acquire running;
    raise_signals();
  });
  if (corrected) report.calibration = map_file.string();
  return to_json(report);
}

py::object evaluate_map(const std::filesystem::path& map, const std::filesystem::path& drive,
                        const std::string& protocol, const std::vector<int>& cameras,
                        const std::string& hold_out, int threads) {
  const ProtocolOptions options{parse_protocol(protocol), cameras, HoldOut::parse(hold_out)};
  std::string report;
  {
    const py::gil_scoped_release others_run;
    const ThreadLimit limit(threads);
    report = report_of(map, drive, options);
  }
  return json_object(report);
}

}  // namespace

void bind_evaluate(py::module_& module) {
  module.def("evaluate", &evaluate_map, py::arg("map"), py::arg("drive"),
             py::arg("protocol") = "held-out", py::kw_only(),
             py::arg("cameras") = std::vector<int>(), py::arg("hold_out") = "",
             py::arg("threads") = 0,
             "Scores a map against its drive: a dict with the keys of `fovea evaluate --json` "
             "(docs/report.md). protocol: 'held-out', 'cross-camera', 'in-sample' or "
             "'in-sample-nav'.");
}

}  // namespace fovea::python
