// fovea.register_scans: how a LiDAR moved between two scans.
#include "fovea/registration.h"

#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include <stdexcept>

#include "python/bindings/bindings.h"
#include "python/bindings/stage_arrays.h"

namespace fovea::python {
namespace py = pybind11;
namespace {

const std::vector<std::string> kMethods{"gicp", "point_to_point", "point_to_plane"};

/// Points that are not finite are allowed: they are left out.
PointCloud scan_of(const Floats& points) {
  return cloud_from(points, std::nullopt, std::nullopt, std::nullopt);
}

std::optional<PosePrior> prior_of(const std::optional<Doubles>& prior,
                                  const std::optional<Twist>& sigma) {
  if (prior.has_value() != sigma.has_value()) {
    throw std::invalid_argument("prior and prior_sigma belong together");
  }
  if (!prior) return std::nullopt;
  if (!(sigma->array() > 0).all()) throw std::invalid_argument("prior_sigma is not above 0");
  return PosePrior{motion_from(*prior), *sigma};
}

RegistrationResult register_arrays(const Floats& target, const Floats& source,
                                   const std::optional<Doubles>& guess, const std::string& method,
                                   int max_iterations, int max_points, double max_distance,
                                   double voxel, int neighbors, double robust_width,
                                   const std::optional<Doubles>& prior,
                                   const std::optional<Twist>& prior_sigma) {
  RegistrationOptions options;
  options.method = static_cast<RegistrationMethod>(choice_of("method", method, kMethods));
  require_range("max_iterations", max_iterations, 0, 100000);
  require_range("max_points", max_points, 0, 1e9);
  require_range("max_distance", max_distance, 1e-3, 1000);
  require_range("voxel", voxel, 0, 100);
  require_range("neighbors", neighbors, 3, 1000);
  require_range("robust_width", robust_width, 0, 1000);
  options.max_iterations = max_iterations;
  options.max_points = max_points;
  options.max_distance = max_distance;
  options.voxel = voxel;
  options.neighbors = neighbors;
  options.robust_width = robust_width;
  const RigidMotion start = guess ? motion_from(*guess) : RigidMotion::Identity();
  const std::optional<PosePrior> pose = prior_of(prior, prior_sigma);
  const PointCloud target_cloud = scan_of(target), source_cloud = scan_of(source);
  const py::gil_scoped_release others_run;
  return register_scans(target_cloud, source_cloud, start, options, pose);
}

ScanFit fit_of_arrays(const Floats& target, const Floats& source, const Doubles& T_target_source) {
  const RigidMotion motion = motion_from(T_target_source);
  const PointCloud target_cloud = scan_of(target), source_cloud = scan_of(source);
  const py::gil_scoped_release others_run;
  return scan_fit(target_cloud, source_cloud, motion);
}

void bind_fit(py::module_& module) {
  py::class_<ScanFit>(module, "ScanFit", "What scan_fit() returns.")
      .def_readonly("vertical", &ScanFit::vertical,
                    "Points on vertical surfaces, one in each cell of 0.25 m.")
      .def_readonly("overlap", &ScanFit::overlap, "Share of them with a counterpart within 1 m.")
      .def_readonly("on_plane", &ScanFit::on_plane,
                    "Share of these within 0.1 m of their counterpart's plane.")
      .def_property_readonly("shows_one_place", &ScanFit::shows_one_place,
                             "Whether both scans show one place, and the motion is right.")
      .def("__repr__", [](const ScanFit& self) {
        return "<fovea.ScanFit " + std::string(self.shows_one_place() ? "" : "not ") +
               "of one place>";
      });
  module.def("scan_fit", &fit_of_arrays, py::arg("target"), py::arg("source"),
             py::arg("T_target_source"),
             "How the vertical surfaces of two registered scans lie on each other.\n\n"
             "target, source: as those of register_scans(), z up; T_target_source: 4x4, m.\n"
             "Returns a ScanFit. ValueError for other shapes.");
}

void bind_result(py::module_& module) {
  py::class_<RegistrationResult>(module, "RegistrationResult", "What register_scans() returns.")
      .def_property_readonly(
          "T_target_source",
          [](const RegistrationResult& self) { return motion_array(self.T_target_source); },
          "4x4, m; the guess if not converged.")
      .def_readonly("converged", &RegistrationResult::converged)
      .def_readonly("iterations", &RegistrationResult::iterations)
      .def_readonly("pairs", &RegistrationResult::pairs, "Of points, in the last iteration.")
      .def_readonly("rms_distance", &RegistrationResult::rms_distance, "m, of these pairs.")
      .def_readonly("degenerate_directions", &RegistrationResult::degenerate_directions,
                    "Of six, that the scene leaves open.")
      .def_property_readonly(
          "information",
          [](const RegistrationResult& self) { return matrix_array<6, 6>(self.information); },
          "6x6, of a twist of the source in its own frame, rotation first (1/rad^2, 1/m^2). Too "
          "optimistic: it treats the pairs as independent.")
      .def("__repr__", [](const RegistrationResult& self) {
        return "<fovea.RegistrationResult " +
               std::string(self.converged ? "converged" : "not converged") + ", " +
               std::to_string(self.pairs) + " pairs>";
      });
}

}  // namespace

void bind_registration(py::module_& module) {
  bind_result(module);
  bind_fit(module);
  const RegistrationOptions options;
  module.def(
      "register_scans", &register_arrays, py::arg("target"), py::arg("source"),
      py::arg("guess") = py::none(), py::kw_only(), py::arg("method") = kMethods[0],
      py::arg("max_iterations") = options.max_iterations,
      py::arg("max_points") = options.max_points, py::arg("max_distance") = options.max_distance,
      py::arg("voxel") = options.voxel, py::arg("neighbors") = options.neighbors,
      py::arg("robust_width") = options.robust_width, py::arg("prior") = py::none(),
      py::arg("prior_sigma") = py::none(),
      "Aligns a scan to another one by iterative closest point.\n\n"
      "target, source: N x 3 and M x 3, m, each in the frame of its sensor; points that are not "
      "finite are left out. guess: T_target_source, 4x4, within max_distance of the truth; None: "
      "the identity. method: 'gicp', 'point_to_point' or 'point_to_plane'. max_points: of each "
      "scan, 0: all. max_distance: m, pairs further apart are not used. voxel: m, one point is "
      "kept in "
      "each cell of this edge, 0: all. neighbors: of a point, for "
      "its normal. robust_width: m, of the robust kernel, 0: none. prior: T_target_source, 4x4, "
      "with prior_sigma: 6, rad and m.\n"
      "Returns a RegistrationResult, the same at any number of threads. It is not converged with "
      "fewer than 50 pairs. A converged one may be wrong: see scan_fit(). ValueError for other "
      "shapes and ranges.");
}

}  // namespace fovea::python
