// fovea.evaluate: scores of a map against a drive.
#include "fovea/evaluate.h"

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "python/bindings/bindings.h"
#include "python/bindings/json_object.h"
#include "python/bindings/run_watch.h"

namespace fovea::python {
namespace py = pybind11;
namespace {

py::object evaluate_in_python(const std::filesystem::path& map, const std::filesystem::path& drive,
                              const std::string& protocol, const std::vector<int>& cameras,
                              const std::string& hold_out, bool foreign, int threads) {
  const EvaluationOptions options{protocol, cameras, hold_out, foreign, threads};
  std::string report;
  {
    const py::gil_scoped_release others_run;
    report = evaluate_map(map, drive, options, [](std::size_t, std::size_t) {
               const py::gil_scoped_acquire running;
               raise_signals();
             }).json;
  }
  return json_object(report);
}

}  // namespace

void bind_evaluate(py::module_& module) {
  module.def(
      "evaluate", &evaluate_in_python, py::arg("map"), py::arg("drive"),
      py::arg("protocol") = "held-out", py::kw_only(), py::arg("cameras") = std::vector<int>(),
      py::arg("hold_out") = "", py::arg("foreign") = false, py::arg("threads") = 0,
      "Scores a map against its drive: a dict with the keys of `fovea evaluate --json` "
      "(docs/report.md). protocol: 'held-out', 'cross-camera', 'in-sample', 'in-sample-nav' "
      "or, of simulated drives, 'truth'. foreign: also a drive that the map was not made of.");
}

}  // namespace fovea::python
