#include "app/export_city.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <vector>

#include "app/map_arguments.h"
#include "app/print.h"
#include "app/viewer_page.h"
#include "fovea/core/output_file.h"
#include "fovea/core/output_folder.h"
#include "fovea/errors.h"
#include "fovea/exporting/city/city_description.h"
#include "fovea/exporting/city/city_tileset_writer.h"
#include "fovea/exporting/city/tile_overview.h"

namespace fovea::app {
namespace {

namespace fs = std::filesystem;

void check_city_options(const ExportArguments& arguments, const std::string& format) {
  constexpr std::array kFormats{"3dtiles", "las", "ply", "pcd", "orthophoto"};
  if (std::find(kFormats.begin(), kFormats.end(), format) == kFormats.end()) {
    throw ConfigError("a city has no export in the format " + format, "--format",
                      "choose 3dtiles, las, ply, pcd or orthophoto, or export a tile");
  }
  if (arguments.crs == "local") {
    throw ConfigError("each tile has a local frame of its own", "--crs", "choose utm or ecef");
  }
}

/// The same choice for all tiles.
void choose_points(const City& city, ExportArguments& arguments, const std::string& format) {
  if (format != "3dtiles" && arguments.crs.empty()) arguments.crs = "utm";
  parse_point_choice(arguments);
  arguments.points.exposure = exposure_of_city(arguments.points.exposure);
  const bool has_colors =
      std::any_of(city.tiles.begin(), city.tiles.end(),
                  [](const CityTileFile& tile) { return MapReader(tile.map).colored_size() > 0; });
  if (has_colors || arguments.points.include_uncolored || city.tiles.empty()) return;
  arguments.points.include_uncolored = true;
  if (!arguments.quiet) print_out("the city has no colors: its points are gray\n");
}

/// Each tile has the UTM zone of its own middle.
void require_one_zone(const City& city, const ExportArguments& arguments) {
  if (arguments.points.crs != Crs::kUtm) return;
  const auto zone_at = [](const GeodeticPoint& place) {
    return Georeference(Crs::kUtm, place, "the city's manifest").description();
  };
  const CityGrid grid(city.origin, city.tile_size);
  const std::string zone = zone_at(city.origin);
  for (const CityTileFile& tile : city.tiles) {
    if (zone_at(grid.middle(tile.tile)) == zone) continue;
    throw ConfigError("the city lies in several UTM zones", "--crs", "choose ecef");
  }
}

bool is_ending_of_part(std::string ending) {
  constexpr std::array kEndings{"", ".las", ".ply", ".pcd", ".png", ".pgw", ".png.aux.xml"};
  constexpr std::string_view kPartial = ".partial";
  if (ending.ends_with(kPartial)) ending.resize(ending.size() - kPartial.size());
  return std::find(kEndings.begin(), kEndings.end(), ending) != kEndings.end();
}

/// Names that the folder of an earlier export, or what a killed program left of one, may have.
std::vector<std::string> names_in(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    const std::string name = entry.path().filename().string();
    const std::size_t dot = std::min(name.find('.'), name.size());
    std::string place = name.substr(0, dot);
    std::replace(place.begin(), place.end(), '_', ',');
    const bool is_node_folder = name == "q" || name == "q.partial";
    const bool is_part = CityTile::parse(place) && is_ending_of_part(name.substr(dot));
    if (is_node_folder || is_part) names.push_back(name);
  }
  return names;
}

std::vector<std::string> contents_of(const City& city, const fs::path& output,
                                     const std::string& ending, const FilesBeside& beside) {
  std::vector<std::string> names{"tileset.json", "tileset.json.partial", "q"};
  for (const CityTileFile& tile : city.tiles) names.push_back(city_part_name(tile.tile) + ending);
  for (const auto& [name, bytes] : beside) names.push_back(fs::path(name).begin()->string());
  for (const fs::path& folder : {output, partial_path(output)}) {
    for (std::string& name : names_in(folder)) names.push_back(std::move(name));
  }
  return names;
}

FilesBeside viewer_files_of(const City& city) {
  FilesBeside files;
  for (const PageFile& file : viewer_page()) files.emplace(file.name, file.bytes);
  MapDescription description = describe_city(city);
  description.tileset = "tileset.json";
  files["map.json"] = to_json(description);
  files["frames.json"] = city_frames_text(city);
  return files;
}

void add(PointExport& sum, const PointExport& of_tile) {
  sum.figures.points += of_tile.figures.points;
  sum.figures.uncolored_left_out += of_tile.figures.uncolored_left_out;
  sum.figures.filtered_out += of_tile.figures.filtered_out;
  sum.tiles += of_tile.tiles;
  sum.points_without_time += of_tile.points_without_time;
  sum.dated = sum.dated && of_tile.dated;
}

/// One tile after the other.
PointExport write_tiles(const City& city, const fs::path& folder, const std::string& ending,
                        const ExportArguments& arguments, const std::string& format) {
  PointExport sum;
  for (const CityTileFile& tile : city.tiles) {
    const MapReader map = open_map(tile.map.string());
    const fs::path output = folder / (city_part_name(tile.tile) + ending);
    const PointExport written = write_points(map, output.string(), arguments, format);
    if (!arguments.quiet) {
      print_out("tile {}: {} points\n", tile.tile.text(), written.figures.points);
    }
    add(sum, written);
  }
  return sum;
}

}  // namespace

void export_city(ExportArguments& arguments, const std::string& format, Warnings& warnings) {
  check_city_options(arguments, format);
  const City city = open_city(arguments.map);
  const bool is_tileset = format == "3dtiles";
  const FilesBeside beside = arguments.viewer ? viewer_files_of(city) : FilesBeside();
  const CityRootOptions root{arguments.viewer, beside, arguments.force};
  if (arguments.root_only) {
    const CityRootFigures figures = write_city_root(city, arguments.output, root);
    if (!arguments.quiet) {
      print_out("{}: the root of {} tiles\n", arguments.output, city.tiles.size());
      print_out("{} nodes above the tiles\n", figures.nodes);
    }
    return;
  }
  choose_points(city, arguments, format);
  require_one_zone(city, arguments);
  arguments.may_be_empty = format == "orthophoto";
  const std::string ending = is_tileset ? "" : format == "orthophoto" ? ".png" : "." + format;
  OutputFolder folder(arguments.output, arguments.force,
                      contents_of(city, arguments.output, ending, beside));
  PointExport written = write_tiles(city, folder.partial(), ending, arguments, format);
  if (is_tileset) written.tiles += write_city_root(city, folder.partial(), root).nodes;
  folder.commit();
  report_points(written, arguments, format, warnings);
}

}  // namespace fovea::app
