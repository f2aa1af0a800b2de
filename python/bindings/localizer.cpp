// fovea.Localizer: where scans were taken in a map made before.
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <mutex>

#include "fovea/localize.h"
#include "python/bindings/arrays.h"
#include "python/bindings/bindings.h"
#include "python/bindings/drive.h"

namespace fovea::python {
namespace py = pybind11;
namespace {

/// A localizer that Python's threads take turns with.
class PythonLocalizer {
 public:
  PythonLocalizer(const std::filesystem::path& map, const Drive& drive,
                  const DriveLocalizerOptions& options)
      : localizer_(map, drive, options) {}

  Localization localize(const FrameOfDrive& frame) {
    const py::gil_scoped_release others_run;
    const std::lock_guard one_at_a_time(mutex_);
    return localizer_.localize(frame.frame);
  }

 private:
  DriveLocalizer localizer_;
  std::mutex mutex_;
};

std::unique_ptr<PythonLocalizer> make_localizer(
    const std::filesystem::path& map, const Drive& drive, bool use_navigation,
    const std::optional<py::array_t<double>>& T_local_lidar) {
  DriveLocalizerOptions options{use_navigation, std::nullopt};
  if (T_local_lidar) options.first = motion_from(*T_local_lidar);
  const py::gil_scoped_release others_run;
  return std::make_unique<PythonLocalizer>(map, drive, options);
}

bool is_localized(const Localization& self) { return self.state == LocalizationState::kLocalized; }

void bind_localization(py::module_& module) {
  using Array = py::array_t<double>;
  py::class_<Localization>(module, "Localization", "Where one scan was taken.")
      .def_readonly("index", &Localization::index, "The frame's.")
      .def_readonly("stamp", &Localization::stamp, "ns, or None.")
      .def_property_readonly(
          "state", [](const Localization& self) { return to_string(self.state); },
          "'localized', 'lost' or 'outside' (the map has next to nothing there).")
      .def_property_readonly(
          "T_local_lidar",
          [](const Localization& self) -> std::optional<Array> {
            if (!is_localized(self)) return std::nullopt;
            return motion_array(self.T_local_lidar);
          },
          "The pose in the map's frame at the scan's stamp, 4x4; None unless localized.")
      .def_property_readonly(
          "covariance",
          [](const Localization& self) -> std::optional<Array> {
            if (!is_localized(self)) return std::nullopt;
            return matrix_array<6, 6>(self.covariance);
          },
          "6x6, of a twist of the LiDAR in its own frame, rotation first (rad^2, m^2); None unless "
          "localized.")
      .def_readonly("health", &Localization::health,
                    "How well scan and map agree, 0 to 1 (docs/localization.md).")
      .def_readonly("found", &Localization::found,
                    "Whether the place was looked for, not followed from the scan before.")
      .def_readonly("degenerate_directions", &Localization::degenerate_directions,
                    "Of six, that the scene leaves open: predicted, not measured.");
}

}  // namespace

void bind_localizer(py::module_& module) {
  bind_localization(module);
  py::class_<PythonLocalizer>(module, "Localizer",
                              "Registers the scans of a drive to a map, one after the other.")
      .def(py::init(&make_localizer), py::arg("map"), py::arg("drive"), py::kw_only(),
           py::arg("use_navigation") = true, py::arg("T_local_lidar") = py::none(),
           "The first scan is looked for where GPS/INS says, near T_local_lidar (4x4) or, with "
           "neither, along the map's drives.")
      .def("localize", &PythonLocalizer::localize, py::arg("frame"),
           "The drive's next scan. ValueError for a frame of another drive; InputError if the map "
           "is damaged there.");
}

}  // namespace fovea::python
