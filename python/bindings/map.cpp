// A map file in Python.
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <mutex>

#include "fovea/api/mapped_frame.h"
#include "fovea/map/map_store.h"
#include "python/bindings/arrays.h"
#include "python/bindings/bindings.h"
#include "python/bindings/path_object.h"
#include "python/bindings/points.h"

namespace fovea::python {
namespace py = pybind11;
namespace {

/// A reader that Python's threads take turns with, each without holding up the others.
class Map {
 public:
  explicit Map(std::filesystem::path path)
      : path_(std::move(path)),
        reader_(path_),
        display_(std::make_shared<const ColorDisplay>(color_display({}, reader_.frames()))) {}

  template <class Read>
  auto read(Read&& read) const {
    const py::gil_scoped_release others_run;
    const std::lock_guard one_at_a_time(mutex_);
    return read(reader_);
  }
  const std::filesystem::path& path() const { return path_; }
  const std::shared_ptr<const ColorDisplay>& display() const { return display_; }

 private:
  std::filesystem::path path_;
  MapReader reader_;
  std::shared_ptr<const ColorDisplay> display_;
  mutable std::mutex mutex_;
};

/// Goes through the tiles of one committed state.
class TileIterator {
 public:
  explicit TileIterator(std::shared_ptr<const Map> map) : map_(std::move(map)) {
    map_->read([this](const MapReader& reader) {
      state_ = reader.hold_state();
      tiles_ = reader.tile_sizes();
    });
  }

  std::pair<TileTuple, Points> next() {
    if (next_ == tiles_.size()) throw py::stop_iteration();
    const TileId id = tiles_[next_++].first;
    return {tuple_of(id), map_->read([&](const MapReader& reader) {
              return Points(reader.read_tile(id), map_->display());
            })};
  }

 private:
  std::shared_ptr<const Map> map_;
  std::shared_ptr<const void> state_;  // goes before the map
  std::vector<std::pair<TileId, std::size_t>> tiles_;
  std::size_t next_ = 0;
};

std::map<TileTuple, std::size_t> tiles_of(const Map& map) {
  std::map<TileTuple, std::size_t> tiles;
  for (const auto& [id, points] : map.read([](const MapReader& r) { return r.tile_sizes(); })) {
    tiles.emplace(tuple_of(id), points);
  }
  return tiles;
}

Points points_of(const Map& map, const std::string& where) {
  return map.read([&](const MapReader& reader) {
    return Points(
        reader.all_points_local(where.empty() ? PointFilter() : PointFilter::parse(where)),
        map.display());
  });
}

}  // namespace

void bind_map(py::module_& module) {
  py::class_<TileIterator>(module, "_TileIterator")
      .def("__iter__", [](py::object self) { return self; })
      .def("__next__", &TileIterator::next);

  py::class_<Map, std::shared_ptr<Map>>(module, "Map",
                                        "A map file, read as it is asked for. InputError if it is "
                                        "missing, damaged or no map.")
      .def(py::init([](std::filesystem::path path) {
             const py::gil_scoped_release others_run;
             return std::make_shared<Map>(std::move(path));
           }),
           py::arg("path"))
      .def_property_readonly(
          "path", [](const Map& map) { return map.path(); }, "The file's name.")
      .def("__fspath__", [](const Map& map) { return name_object(map.path()); })
      .def_property_readonly(
          "meta", [](const Map& map) { return map.read([](const auto& r) { return r.meta(); }); },
          "What the map says of itself, text by key (docs/map-format.md).")
      .def_property_readonly(
          "frames",
          [](const Map& map) {
            return mapped_frames(map.read([](const auto& r) { return r.frames(); }));
          },
          "A FrameRecord a frame, by index.")
      .def_property_readonly(
          "submaps",
          [](const Map& map) {
            return motion_arrays(map.read([](const auto& r) { return r.submaps(); }));
          },
          "T_local_submap by number, N x 4 x 4 float64.")
      .def_property_readonly(
          "size", [](const Map& map) { return map.read([](const auto& r) { return r.size(); }); },
          "Number of points.")
      .def("tiles", &tiles_of, "How many points each tile has, by (submap, x, y, z).")
      .def(
          "tile",
          [](const Map& map, const TileTuple& id) {
            return map.read(
                [&](const auto& r) { return Points(r.read_tile(id_of(id)), map.display()); });
          },
          py::arg("id"),
          "The points of a tile, in the frame of its submap. InputError if it is not there.")
      .def("__iter__", [](std::shared_ptr<Map> map) { return TileIterator(std::move(map)); })
      .def("points", &points_of, py::arg("where") = "",
           "All points in the frame `local`, or those that pass, as in \"views >= 2 and range < "
           "10\" (docs/exports.md). ConfigError that says what is not understood.")
      .def(
          "digest",
          [](const Map& map) { return map.read([](const auto& r) { return r.digest(); }); },
          "Hash of everything but timings: the same for the same map.");
}

}  // namespace fovea::python
