// fovea.evaluate: scores of a map against a drive.
#include "fovea/evaluation/evaluate.h"

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "fovea/core/parallel.h"
#include "fovea/evaluation/evaluate_truth.h"
#include "fovea/pipeline/drive_match.h"
#include "fovea/pipeline/stored_calibration.h"
#include "python/bindings/bindings.h"
#include "python/bindings/json_object.h"
#include "python/bindings/run_watch.h"

namespace fovea::python {
namespace py = pybind11;
namespace {

constexpr const char* kTruth = "truth";

std::string held_to_truth(ScoredMap map, const FrameSource& drive) {
  return to_json(evaluate_truth(std::move(map), drive, {}));
}

std::string held_to_photographs(ScoredMap map, const FrameSource& drive,
                                const ProtocolOptions& options, const std::string& calibration) {
  EvaluationReport report = evaluate(std::move(map), drive, options, [](std::size_t, std::size_t) {
    const py::gil_scoped_acquire running;
    raise_signals();
  });
  report.calibration = calibration;
  return to_json(report);
}

py::object evaluate_map(const std::filesystem::path& file, const std::filesystem::path& folder,
                        const std::string& protocol, const std::vector<int>& cameras,
                        const std::string& hold_out, bool foreign, int threads) {
  ProtocolOptions options{.cameras = cameras, .hold_out = HoldOut::parse(hold_out)};
  if (protocol != kTruth) options.protocol = parse_protocol(protocol);
  std::string report;
  {
    const py::gil_scoped_release others_run;
    const ThreadLimit limit(threads);
    ScoredMap map = load_scored_map(file, {.poses = std::nullopt});
    DriveOptions wanted;
    wanted.cameras = cameras.empty() ? map.cameras : cameras;
    std::unique_ptr<FrameSource> drive = open_drive(folder, wanted);
    if (!foreign) {
      const DriveMatch match = match_drive(MapReader(file), *drive, file);
      if (!match.keeps_numbers) choose_frames(match.number_in_drive, map);
    }
    const bool corrected = has_stored_calibration(map.meta);
    if (corrected) drive = with_stored_calibration(std::move(drive), map.meta, file);
    report = protocol == kTruth ? held_to_truth(std::move(map), *drive)
                                : held_to_photographs(std::move(map), *drive, options,
                                                      corrected ? file.string() : "drive");
  }
  return json_object(report);
}

}  // namespace

void bind_evaluate(py::module_& module) {
  module.def(
      "evaluate", &evaluate_map, py::arg("map"), py::arg("drive"), py::arg("protocol") = "held-out",
      py::kw_only(), py::arg("cameras") = std::vector<int>(), py::arg("hold_out") = "",
      py::arg("foreign") = false, py::arg("threads") = 0,
      "Scores a map against its drive: a dict with the keys of `fovea evaluate --json` "
      "(docs/report.md). protocol: 'held-out', 'cross-camera', 'in-sample', 'in-sample-nav' "
      "or, of simulated drives, 'truth'. foreign: also a drive that the map was not made of.");
}

}  // namespace fovea::python
