// fovea.Mapper: a map in memory, frame by frame.
#include "fovea/mapper.h"

#include <pybind11/stl.h>

#include <mutex>

#include "fovea/api/frame_mapper_content.h"
#include "python/bindings/arrays.h"
#include "python/bindings/bindings.h"
#include "python/bindings/drive.h"
#include "python/bindings/points.h"
#include "python/bindings/settings.h"

namespace fovea::python {
namespace py = pybind11;
namespace {

std::vector<RigidMotion> mapper_submaps(const FrameMapper::Content& content) {
  std::vector<RigidMotion> T_local_submap;
  for (const Submap& submap : content.map().submaps()) {
    T_local_submap.push_back(submap.T_local_submap);
  }
  return T_local_submap;
}

/// The points so far, as a file of them would show them.
std::map<TileTuple, Points> mapper_tiles(const FrameMapper::Content& content) {
  const auto display = std::make_shared<const ColorDisplay>(color_display({}, content.records));
  const TileMap& map = content.map();
  std::map<TileTuple, Points> tiles;
  for (std::size_t number = 0; number < map.submaps().size(); ++number) {
    for (const auto& [key, tile] : map.submaps()[number].tiles) {
      tiles.emplace(tuple_of({number, key}), Points(tile.points->cloud(), display));
    }
  }
  return tiles;
}

/// A mapper that Python's threads take turns with.
class PythonMapper {
 public:
  PythonMapper(const Drive& drive, const MapperSettings& settings) : mapper_(drive, settings) {}

  MappedFrame process(const FrameOfDrive& frame, bool held_out) {
    const py::gil_scoped_release others_run;
    const std::lock_guard one_at_a_time(mutex_);
    return mapper_.map(frame.frame, held_out);
  }

  template <class Look>
  auto look(Look&& look) const {
    const py::gil_scoped_release others_run;
    const std::lock_guard one_at_a_time(mutex_);
    return look(mapper_.content());
  }

 private:
  FrameMapper mapper_;
  mutable std::mutex mutex_;
};

std::unique_ptr<PythonMapper> make_frame_mapper(const Drive& drive, const std::string& preset,
                                                const py::dict& settings) {
  const MapperSettings options = mapper_settings(preset, settings);
  const py::gil_scoped_release others_run;
  return std::make_unique<PythonMapper>(drive, options);
}

}  // namespace

void bind_mapper(py::module_& module) {
  py::class_<PythonMapper>(module, "Mapper",
                           "Maps a drive frame by frame, all in memory; map_drive() makes files.")
      .def(py::init(&make_frame_mapper), py::arg("drive"), py::kw_only(),
           py::arg("preset") = "default", py::arg("settings") = py::dict())
      .def("process", &PythonMapper::process, py::arg("frame"), py::kw_only(),
           py::arg("held_out") = false,
           "Maps the drive's next frame and returns its record. A held-out one gets a pose, and "
           "adds nothing. Where navigation does not tell how the vehicle moves, the first call "
           "reads the drive's next frame, too. ValueError for a frame of another drive or one that "
           "is not later.")
      .def_property_readonly(
          "size",
          [](const PythonMapper& self) {
            return self.look([](const auto& content) { return content.map().size(); });
          },
          "Number of points so far.")
      .def_property_readonly(
          "submaps",
          [](const PythonMapper& self) { return motion_arrays(self.look(&mapper_submaps)); },
          "T_local_submap as of the last frame, N x 4 x 4.")
      .def(
          "tiles", [](const PythonMapper& self) { return self.look(&mapper_tiles); },
          "The points so far by (submap, x, y, z), in the frames of their submaps: not copied, and "
          "not changed by later frames.");
}

}  // namespace fovea::python
