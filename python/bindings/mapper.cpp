// fovea.Mapper: a map in memory, frame by frame.
#include <pybind11/stl.h>

#include <mutex>
#include <stdexcept>

#include "fovea/pipeline/drive_records.h"
#include "fovea/pipeline/drive_sensors.h"
#include "fovea/pipeline/initial_motion.h"
#include "fovea/pipeline/make_mapper.h"
#include "python/bindings/arrays.h"
#include "python/bindings/bindings.h"
#include "python/bindings/drive.h"
#include "python/bindings/points.h"
#include "python/bindings/settings.h"

namespace fovea::python {
namespace py = pybind11;
namespace {

std::vector<RigidMotion> submaps_of(const TileMap& map) {
  std::vector<RigidMotion> T_local_submap;
  for (const Submap& submap : map.submaps()) T_local_submap.push_back(submap.T_local_submap);
  return T_local_submap;
}

std::map<TileTuple, Points> tiles_of(const TileMap& map,
                                     const std::shared_ptr<const ColorDisplay>& display) {
  std::map<TileTuple, Points> tiles;
  for (std::size_t number = 0; number < map.submaps().size(); ++number) {
    for (const auto& [key, tile] : map.submaps()[number].tiles) {
      tiles.emplace(tuple_of({number, key}), Points(tile.points->cloud(), display));
    }
  }
  return tiles;
}

/// A mapper with its drive, that Python's threads take turns with.
class DriveMapper {
 public:
  DriveMapper(Drive drive, const std::string& preset, const py::dict& settings)
      : DriveMapper(std::move(drive), map_settings(preset, settings)) {}

  FrameRecord process(const DriveFrame& frame, bool held_out) {
    frame.require_of(drive_);
    const py::gil_scoped_release others_run;
    const std::lock_guard one_at_a_time(mutex_);
    if (last_ && frame.frame->index <= *last_) {
      throw std::invalid_argument("frames are mapped in the drive's order, each once");
    }
    last_ = frame.frame->index;
    const FrameResult result = mapper_->process(*frame.frame, {.held_out = held_out});
    FrameRecord record = record_of(result);
    add_views(*frame.frame, info_, result, record);
    return records_.emplace_back(std::move(record));
  }

  /// The points so far, as a file of them would show them.
  std::map<TileTuple, Points> tiles() const {
    const py::gil_scoped_release others_run;
    const std::lock_guard one_at_a_time(mutex_);
    return tiles_of(std::as_const(*mapper_).map(),
                    std::make_shared<const ColorDisplay>(color_display({}, records_)));
  }

  template <class Look>
  auto look(Look&& look) const {
    const py::gil_scoped_release others_run;
    const std::lock_guard one_at_a_time(mutex_);
    return look(std::as_const(*mapper_).map());
  }

 private:
  DriveMapper(Drive drive, const MapSettings& settings)
      : drive_(std::move(drive)), info_(info_with_lidars(*drive_.source)) {
    MapperServices services;
    services.initial_velocity = [this, compensate = settings.compensates_motion()](int frame) {
      return initial_velocity(*drive_.source, {}, frame, compensate);
    };
    mapper_ = make_mapper(info_, settings, PoseSource::kRefine, std::move(services));
  }

  Drive drive_;
  DriveInfo info_;
  std::unique_ptr<IncrementalMapper> mapper_;
  std::optional<int> last_;
  std::vector<FrameRecord> records_;
  mutable std::mutex mutex_;
};

}  // namespace

void bind_mapper(py::module_& module) {
  py::class_<DriveMapper>(module, "Mapper",
                          "Maps a drive frame by frame, all in memory; map_drive() makes files.")
      .def(py::init<Drive, const std::string&, const py::dict&>(), py::arg("drive"), py::kw_only(),
           py::arg("preset") = "default", py::arg("settings") = py::dict())
      .def("process", &DriveMapper::process, py::arg("frame"), py::kw_only(),
           py::arg("held_out") = false,
           "Maps the drive's next frame and returns its record. A held-out one gets a pose, and "
           "adds nothing. Where navigation does not tell how the vehicle moves, the first call "
           "reads the drive's next frame, too. ValueError for a frame of another drive or one that "
           "is not later.")
      .def_property_readonly(
          "size",
          [](const DriveMapper& self) {
            return self.look([](const auto& map) { return map.size(); });
          },
          "Number of points so far.")
      .def_property_readonly(
          "submaps", [](const DriveMapper& self) { return motion_arrays(self.look(&submaps_of)); },
          "T_local_submap as of the last frame, N x 4 x 4.")
      .def(
          "tiles", &DriveMapper::tiles,
          "The points so far by (submap, x, y, z), in the frames of their submaps: not copied, and "
          "not changed by later frames.");
}

}  // namespace fovea::python
