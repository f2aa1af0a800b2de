// What is made of a map: exports, pictures and merged maps.
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <array>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "fovea/core/output_file.h"
#include "fovea/core/parallel.h"
#include "fovea/drive/command_files.h"
#include "fovea/drive/writers/png_encode.h"
#include "fovea/evaluation/map_picture.h"
#include "fovea/export.h"
#include "fovea/map/checked_map.h"
#include "fovea/merging/merge_maps.h"
#include "fovea/pipeline/settings_of_map.h"
#include "python/bindings/arrays.h"
#include "python/bindings/bindings.h"

namespace fovea::python {
namespace py = pybind11;
namespace fs = std::filesystem;
namespace {

ExportedMap export_in_python(const fs::path& map, const fs::path& output,
                             const ExportOptions& options) {
  const py::gil_scoped_release others_run;
  return export_map(map, output, options);
}

/// Opens a drive with one camera; -1: its own choice.
PhotographedDrive open_photographed(const fs::path& path, int camera, bool foreign) {
  DriveOptions options;
  if (camera >= 0) options.cameras = {camera};
  return {open_drive(path, options), path, foreign};
}

py::array render(const fs::path& map, const std::optional<fs::path>& output, bool force,
                 const PictureOptions& options, const std::optional<fs::path>& drive, int camera,
                 bool foreign) {
  auto image = std::make_shared<Image>();
  {
    const py::gil_scoped_release others_run;
    std::unique_ptr<OutputFile> file;
    if (output) {
      const std::string read = drive ? drive->string() : "";
      check_files({{map.string(), read}, {{output->string(), ContentKind::kPng, force}}});
      file = std::make_unique<OutputFile>(*output, force);
    }
    const MapReader reader = open_checked_map(map);
    *image = drive ? draw_above_photograph(reader, map, open_photographed(*drive, camera, foreign),
                                           options)
                   : draw_map(reader, map, options);
    if (file) {
      const std::vector<std::uint8_t> png = encode_png(*image);
      file->stream().write(reinterpret_cast<const char*>(png.data()), std::ssize(png));
      file->commit();
    }
  }
  const std::vector<py::ssize_t> shape{image->height, image->width, image->channels};
  return shared_array(py::dtype::of<std::uint8_t>(), shape, image->data.data(), image);
}

MergeFigures merge(const fs::path& first, const fs::path& second, const fs::path& output,
                   std::size_t memory, int threads, bool force) {
  const py::gil_scoped_release others_run;
  check_files({{first.string(), second.string()}, {{output.string(), ContentKind::kMap, force}}});
  const ThreadLimit limit(threads);
  const MapReader a = open_checked_map(first), b = open_checked_map(second);
  MergeJob job;
  job.output = output;
  job.force = force;
  job.memory = memory;
  job.spacing = settings_of_map(a.meta(), first.string()).spacing();
  return merge_maps(a, b, job);
}

void bind_exported(py::module_& module) {
  py::class_<ExportOptions>(module, "_ExportOptions")
      .def(py::init<>())
      .def_readwrite("format", &ExportOptions::format)
      .def_readwrite("crs", &ExportOptions::crs)
      .def_readwrite("where", &ExportOptions::where)
      .def_readwrite("exposure", &ExportOptions::exposure)
      .def_readwrite("include_uncolored", &ExportOptions::include_uncolored)
      .def_readwrite("double_positions", &ExportOptions::double_positions)
      .def_readwrite("color_depth", &ExportOptions::color_depth)
      .def_readwrite("voxel", &ExportOptions::voxel)
      .def_readwrite("max_points", &ExportOptions::max_points)
      .def_readwrite("drive", &ExportOptions::drive)
      .def_readwrite("pixel", &ExportOptions::pixel)
      .def_readwrite("utc_offset", &ExportOptions::utc_offset)
      .def_readwrite("force", &ExportOptions::force);
  py::class_<ExportedMap>(module, "ExportedMap", "What Map.export() wrote.")
      .def_readonly("points", &ExportedMap::points,
                    "Points, or vertices of the points that a mesh was made of.")
      .def_readonly("uncolored_left_out", &ExportedMap::uncolored_left_out,
                    "Points that no camera colored.")
      .def_readonly("filtered_out", &ExportedMap::filtered_out,
                    "Points that do not meet the conditions.")
      .def_readonly("tiles", &ExportedMap::tiles, "Tiles of a tileset.")
      .def_readonly("triangles", &ExportedMap::triangles, "Triangles of a mesh.")
      .def_readonly("width", &ExportedMap::width, "Of an orthophoto, pixels.")
      .def_readonly("height", &ExportedMap::height, "Of an orthophoto, pixels.")
      .def_readonly("images", &ExportedMap::images, "Images of colmap and nerf.")
      .def_readonly("held_out", &ExportedMap::held_out, "Images of held-out frames among them.")
      .def("__repr__", [](const ExportedMap& self) {
        return "<fovea.ExportedMap: " + std::to_string(self.points) + " points>";
      });
  module.def("_export", &export_in_python, "Map.export()");
}

void bind_pictures(py::module_& module) {
  py::class_<PictureOptions>(module, "_PictureOptions")
      .def(py::init<>())
      .def_readwrite("view", &PictureOptions::view)
      .def_readwrite("frame", &PictureOptions::frame)
      .def_readwrite("width", &PictureOptions::width)
      .def_readwrite("height", &PictureOptions::height)
      .def_readwrite("exposure", &PictureOptions::exposure)
      .def("look", [](PictureOptions& self, const std::array<double, 3>& from,
                      const std::array<double, 3>& to) {
        self.free_view = {Eigen::Vector3d(from.data()), Eigen::Vector3d(to.data())};
      });
  module.def("_render", &render, "Map.render()");
}

void bind_merged(py::module_& module) {
  py::class_<MergeFigures>(module, "MergeFigures", "What merge() did.")
      .def_readonly("points", &MergeFigures::points, "Points of the result.")
      .def_readonly("drives_added", &MergeFigures::drives_added,
                    "Drives of the second map that the first one did not have.")
      .def_readonly("georeferenced", &MergeFigures::georeferenced,
                    "Whether the maps were placed by their georeference or a common drive first.")
      .def_property_readonly(
          "submaps_met", [](const MergeFigures& self) { return self.alignment.met; },
          "Submaps of the second map with the first map around them.")
      .def_property_readonly(
          "submaps_registered", [](const MergeFigures& self) { return self.alignment.registered; },
          "Submaps of these that were registered; 0: the maps lie as the first guess says.")
      .def_property_readonly(
          "moved", [](const MergeFigures& self) { return self.alignment.moved; },
          "m, median motion of the registered submaps.")
      .def_property_readonly(
          "points_added", [](const MergeFigures& self) { return self.merged.added; },
          "New points of the second map.")
      .def_property_readonly(
          "points_known", [](const MergeFigures& self) { return self.merged.known; },
          "Points of the second map on a surface of the first one, left out.")
      .def_property_readonly(
          "points_fused", [](const MergeFigures& self) { return self.merged.fused; },
          "Points of the first map that got a color of the second one.")
      .def_property_readonly(
          "log2_gain",
          [](const MergeFigures& self) {
            const Eigen::Vector3d gain = self.gain_of_b.matrix().cast<double>();
            return py::array_t<double>(3, gain.data());
          },
          "3: base-2 logarithms of the gains of red, green, blue, second map = first map * gain.")
      .def("__repr__", [](const MergeFigures& self) {
        return "<fovea.MergeFigures: " + std::to_string(self.points) + " points>";
      });
  module.def("merge", &merge, py::arg("first"), py::arg("second"), py::arg("output"), py::kw_only(),
             py::arg("memory") = MergeJob().memory, py::arg("threads") = 0,
             py::arg("force") = false,
             "Writes a map of two maps of one place, in the first one's frame, as `fovea merge` "
             "does, and returns MergeFigures. memory: bytes for tiles; threads: 0 for all; force: "
             "replaces the output, and merges also maps that do not overlap.\n\n"
             "InputError for maps that cannot be merged, OutputError for an output that exists.");
}

}  // namespace

void bind_map_output(py::module_& module) {
  bind_exported(module);
  bind_pictures(module);
  bind_merged(module);
}

}  // namespace fovea::python
