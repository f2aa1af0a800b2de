// A map file in Python.
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <mutex>

#include "fovea/api/mapped_frame.h"
#include "fovea/errors.h"
#include "fovea/map/map_store.h"
#include "fovea/map/point_query.h"
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
        reader_(std::make_shared<const MapReader>(path_)),
        display_(std::make_shared<const ColorDisplay>(color_display({}, reader_->frames()))) {}

  /// @throws std::invalid_argument  if the map is closed, as files of Python do
  template <class Read>
  auto read(Read&& read) const {
    const py::gil_scoped_release others_run;
    const std::lock_guard one_at_a_time(mutex_);
    if (!reader_) throw std::invalid_argument("the map is closed");
    return read(*reader_);
  }
  void close() {
    const py::gil_scoped_release others_run;
    const std::lock_guard one_at_a_time(mutex_);
    reader_.reset();
  }
  bool is_closed() const {
    const py::gil_scoped_release others_run;
    const std::lock_guard one_at_a_time(mutex_);
    return reader_ == nullptr;
  }
  /// Nullptr of a closed map. The file stays open as long as it is kept.
  std::shared_ptr<const MapReader> reader() const {
    const py::gil_scoped_release others_run;
    const std::lock_guard one_at_a_time(mutex_);
    return reader_;
  }
  const std::filesystem::path& path() const { return path_; }
  const std::shared_ptr<const ColorDisplay>& display() const { return display_; }

 private:
  std::filesystem::path path_;
  std::shared_ptr<const MapReader> reader_;
  std::shared_ptr<const ColorDisplay> display_;
  mutable std::mutex mutex_;
};

/// Goes through the tiles of one committed state.
class TileIterator {
 public:
  explicit TileIterator(std::shared_ptr<const Map> map)
      : map_(std::move(map)), reader_(map_->reader()) {
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
  std::shared_ptr<const MapReader> reader_;  // outlives the state, also if the map is closed
  std::shared_ptr<const void> state_;
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

/// Two corners of a box.
PointQuery::Box box_of(const py::object& corners) {
  const auto array = py::array_t < double, py::array::c_style | py::array::forcecast > (corners);
  if (array.ndim() != 2 || array.shape(0) != 2 || array.shape(1) != 3) {
    throw std::invalid_argument("a box is two corners, ((x0, y0, z0), (x1, y1, z1))");
  }
  return {Eigen::Vector3d(array.data(0, 0)), Eigen::Vector3d(array.data(1, 0))};
}

Points points_of(const Map& map, const std::string& where, const py::object& box) {
  PointQuery query;
  query.where = where;
  if (!box.is_none()) query.box = box_of(box);
  return map.read(
      [&](const MapReader& reader) { return Points(find_points(reader, query), map.display()); });
}

/// One line, also of a map that is closed or damaged.
std::string text_of(const Map& map, const std::string& path) {
  const std::string name = "<fovea.Map " + path;
  try {
    return map.read([&](const MapReader& reader) {
      return name + ": " + std::to_string(reader.size()) + " points, " +
             std::to_string(reader.frames().size()) + " frames>";
    });
  } catch (const std::invalid_argument&) {
    return name + ": closed>";
  } catch (const Error&) {
    return name + ": damaged>";
  }
}

void bind_closing(py::class_<Map, std::shared_ptr<Map>>& map) {
  map.def("close", &Map::close,
          "Closes the file. Points that were read stay; all else is a ValueError then.")
      .def_property_readonly("closed", &Map::is_closed, "Whether close() was called.")
      .def("__enter__",
           [](py::object self) {
             if (py::cast<const Map&>(self).is_closed()) {
               throw std::invalid_argument("the map is closed");
             }
             return self;
           })
      .def("__exit__", [](Map& self, const py::args&) { self.close(); });
}

void bind_points_of_map(py::class_<Map, std::shared_ptr<Map>>& map) {
  map.def_property_readonly(
         "size", [](const Map& self) { return self.read([](const auto& r) { return r.size(); }); },
         "Number of points.")
      .def("__len__",
           [](const Map& self) { return self.read([](const auto& r) { return r.size(); }); })
      .def("tiles", &tiles_of, "How many points each tile has, by (submap, x, y, z).")
      .def(
          "tile",
          [](const Map& self, const TileTuple& id) {
            return self.read(
                [&](const auto& r) { return Points(r.read_tile(id_of(id)), self.display()); });
          },
          py::arg("id"),
          "The points of a tile, in the frame of its submap. InputError if it is not there.")
      .def("__iter__", [](std::shared_ptr<Map> self) { return TileIterator(std::move(self)); })
      .def("points", &points_of, py::arg("where") = "", py::kw_only(), py::arg("box") = py::none(),
           "The points that pass, in the frame `local`. where: as in \"views >= 2 and range < 10\" "
           "(docs/exports.md); \"\" for all. box: two corners, ((x0, y0, z0), (x1, y1, z1)), m, "
           "borders included. Of tiles outside the box nothing is read. ConfigError for "
           "conditions that are not understood and a box without a volume.");
}

}  // namespace

void bind_map(py::module_& module) {
  py::class_<TileIterator>(module, "_TileIterator")
      .def("__iter__", [](py::object self) { return self; })
      .def("__next__", &TileIterator::next);

  py::class_<Map, std::shared_ptr<Map>> map(
      module, "Map", "A map file, read on demand. InputError if it is missing, damaged or no map.");
  map.def(py::init([](std::filesystem::path path) {
            const py::gil_scoped_release others_run;
            return std::make_shared<Map>(std::move(path));
          }),
          py::arg("path"))
      .def_property_readonly(
          "path", [](const Map& self) { return self.path(); }, "The file's name.")
      .def("__fspath__", [](const Map& self) { return name_object(self.path()); })
      .def("__repr__",
           [](const Map& self) {
             return text_of(self, py::cast<std::string>(py::repr(name_object(self.path()))));
           })
      .def_property_readonly(
          "_meta",
          [](const Map& self) { return self.read([](const auto& r) { return r.meta(); }); },
          "Text by key, for fovea.Meta.")
      .def_property_readonly(
          "frames",
          [](const Map& self) {
            return mapped_frames(self.read([](const auto& r) { return r.frames(); }));
          },
          "A FrameRecord a frame, by index.")
      .def_property_readonly(
          "submaps",
          [](const Map& self) {
            return motion_arrays(self.read([](const auto& r) { return r.submaps(); }));
          },
          "T_local_submap by number, N x 4 x 4 float64.")
      .def(
          "digest",
          [](const Map& self) { return self.read([](const auto& r) { return r.digest(); }); },
          "Hash of everything but timings: the same for the same map.");
  bind_closing(map);
  bind_points_of_map(map);
}

}  // namespace fovea::python
