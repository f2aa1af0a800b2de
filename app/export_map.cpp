#include "app/export_map.h"

#include <fmt/format.h>

#include <vector>

#include "app/map_arguments.h"
#include "app/print.h"
#include "app/viewer_page.h"
#include "fovea/exporting/frame_formats.h"
#include "fovea/exporting/mesh/mesh_tileset_writer.h"
#include "fovea/exporting/tileset/tileset_writer.h"
#include "fovea/exporting/views/colmap_writer.h"
#include "fovea/exporting/views/nerf_writer.h"
#include "fovea/map/map_store.h"
#include "fovea/map/point_files/las_writer.h"
#include "fovea/map/point_files/pcd_writer.h"
#include "fovea/map/point_files/ply_writer.h"

namespace fovea::app {
namespace {

void print_figures(const ExportArguments& arguments, const ExportFigures& figures) {
  print_out("{}: {} points\n", arguments.output, figures.points);
  if (figures.uncolored_left_out > 0) {
    print_out("left out: {} points that no camera coloured (--uncolored keeps them)\n",
              figures.uncolored_left_out);
  }
  if (figures.filtered_out > 0) {
    print_out("left out: {} points that do not meet --where\n", figures.filtered_out);
  }
}

void print_mesh(const MeshFigures& figures) {
  print_out("{} triangles of {} cells with points\n", figures.triangles, figures.cells);
  if (figures.lonely_cells > 0) {
    print_out("{} cells have too few others around them for a surface\n", figures.lonely_cells);
  }
  if (figures.uncolored_vertices > 0) {
    print_out("{} vertices are grey: no coloured point is near\n", figures.uncolored_vertices);
  }
}

/// A warning if points were left out.
std::vector<std::string> warnings_of(const MeshFigures& figures) {
  if (figures.without_frame == 0) return {};
  return {fmt::format("left out: {} points of frames that the map does not have",
                      figures.without_frame)};
}

/// A surface, as levels of detail in a folder or as one file.
void write_mesh(const MapReader& map, const ExportArguments& arguments, bool levels,
                Warnings& warnings) {
  const MeshOptions options{arguments.points, arguments.voxel, arguments.force};
  if (!levels) {
    const MeshFigures figures = write_mesh_file(map, arguments.output, options);
    warnings.add(warnings_of(figures), arguments.quiet);
    if (arguments.quiet) return;
    print_figures(arguments, figures);
    print_mesh(figures);
    return;
  }
  FilesBeside beside;
  if (arguments.viewer) beside = viewer_files(map, viewer_page(), /*mesh=*/true);
  const MeshTilesetFigures figures = write_mesh_tileset(map, arguments.output, options, beside);
  warnings.add(warnings_of(figures), arguments.quiet);
  if (arguments.quiet) return;
  print_figures(arguments, figures);
  print_mesh(figures);
  print_out("{} tiles\n", figures.tiles);
}

/// Posed images and points for view synthesis.
void write_views(const MapReader& map, const ExportArguments& arguments, const std::string& format,
                 Warnings& warnings) {
  const auto write = format == "nerf" ? write_nerf : write_colmap;
  const ViewExportFigures figures = write(map, arguments.map, arguments.output,
                                          {.points = arguments.points,
                                           .drive = arguments.drive,
                                           .max_points = arguments.max_points,
                                           .cell = arguments.voxel,
                                           .force = arguments.force});
  if (figures.images_missing > 0) {
    warnings.add({fmt::format("{} images of the map's frames cannot be read from the drive and are "
                              "left out",
                              figures.images_missing)},
                 arguments.quiet);
  }
  if (arguments.quiet) return;
  print_figures(arguments, figures);
  if (figures.thinned_out > 0) {
    print_out("left out: {} points of cells of {:.3g} m that have one already\n",
              figures.thinned_out, figures.cell);
  }
  print_out("{} images, {} of them held out to test\n", figures.images, figures.held_out);
  for (const std::string& note : figures.notes) print_out("note: {}\n", note);
  if (!arguments.drive.empty()) return;
  print_out("note: poses alone; --drive writes the images, too\n");
}

void write(const MapReader& map, ExportArguments& arguments, const std::string& format,
           Warnings& warnings) {
  if (is_frame_format(format)) {
    return write_frame_format(map, format, arguments.output, arguments.force);
  }
  if (map.size() > 0 && map.colored_size() == 0 && !arguments.points.include_uncolored) {
    arguments.points.include_uncolored = true;
    if (!arguments.quiet) print_out("the map has no colors: its points are gray\n");
  }
  if (format == "orthophoto" && arguments.crs.empty()) {
    arguments.crs = to_string(orthophoto_crs(map));
  }
  parse_point_choice(arguments);
  if (format == "mesh" || format == "glb") {
    return write_mesh(map, arguments, format == "mesh", warnings);
  }
  if (format == "colmap" || format == "nerf") {
    return write_views(map, arguments, format, warnings);
  }
  FilesBeside beside;
  if (arguments.viewer) beside = viewer_files(map, viewer_page(), /*mesh=*/false);
  const PointExport written = write_points(map, arguments.output, arguments, format, beside);
  report_points(written, arguments, format, warnings);
}

}  // namespace

void parse_point_choice(ExportArguments& arguments) {
  if (!arguments.where.empty()) arguments.points.where = PointFilter::parse(arguments.where);
  if (!arguments.crs.empty()) arguments.points.crs = *crs_of(arguments.crs);
  arguments.points.exposure = parse_exposure(arguments.exposure);
  arguments.points.deep_colors = arguments.color_depth == 16;
}

PointExport write_points(const MapReader& map, const std::string& output,
                         const ExportArguments& arguments, const std::string& format,
                         const FilesBeside& beside) {
  PointExport written;
  if (format == "las") {
    LasOptions options{.points = arguments.points, .force = arguments.force};
    if (arguments.utc_offset) options.utc_offset = from_seconds(3600 * *arguments.utc_offset);
    const LasFigures figures = write_las(map, output, options);
    written.figures = figures;
    written.points_without_time = figures.points_without_time;
    written.dated = figures.dated;
  } else if (format == "3dtiles") {
    const TilesetOptions options{.points = arguments.points,
                                 .with_sources = arguments.viewer,
                                 .beside = beside,
                                 .force = arguments.force};
    const TilesetFigures figures = write_tileset(map, output, options);
    written.figures = figures;
    written.tiles = figures.tiles;
  } else if (format == "orthophoto") {
    const OrthophotoFigures figures = write_orthophoto(
        map, output, {arguments.points, arguments.pixel, arguments.may_be_empty, arguments.force});
    written.figures = figures;
    written.width = figures.width, written.height = figures.height;
  } else {
    const auto write_file = format == "pcd" ? write_pcd : write_ply;
    written.figures =
        write_file(map, output, {arguments.points, arguments.double_positions, arguments.force});
  }
  return written;
}

void report_points(const PointExport& written, const ExportArguments& arguments,
                   const std::string& format, Warnings& warnings) {
  if (!arguments.quiet) {
    print_figures(arguments, written.figures);
    if (format == "3dtiles") print_out("{} tiles\n", written.tiles);
    if (written.width > 0) print_out("{} x {} pixels\n", written.width, written.height);
    if (!written.dated) {
      print_out("the drive's stamps have no date: LAS has them in seconds, as GPS week time\n");
    }
  }
  if (written.points_without_time == 0) return;
  warnings.add({fmt::format("{} points are of frames without a stamp and have time 0",
                            written.points_without_time)},
               arguments.quiet);
}

void export_map(ExportArguments& arguments, const std::string& format, Warnings& warnings) {
  const MapReader map = open_map(arguments.map);
  write(map, arguments, format, warnings);
  warnings.add(warnings_of_map(map.meta()), arguments.quiet);
}

}  // namespace fovea::app
