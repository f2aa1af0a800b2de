#include "fovea/core/content_kind.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <sstream>
#include <string>
#include <string_view>

#include "fovea/core/file_format.h"
#include "fovea/core/input_file.h"
#include "fovea/errors.h"

namespace fovea {
namespace {

constexpr std::size_t kHead = 4096;  // bytes: more than the longest line of a pose file

std::string head_of(const std::filesystem::path& file) {
  try {
    return InputFile(file, kStreamedFile).beginning(kHead);
  } catch (const InputError&) {
    return {};
  }
}

std::string_view without_blanks(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  return first == std::string_view::npos ? std::string_view() : text.substr(first);
}

bool begins_with_tag(std::string_view text, std::string_view lower_case_tag) {
  return text.size() >= lower_case_tag.size() &&
         std::equal(
             lower_case_tag.begin(), lower_case_tag.end(), text.begin(),
             [](char tag, char c) { return tag == std::tolower(static_cast<unsigned char>(c)); });
}

bool is_number(const std::string& word) {
  try {
    std::size_t used = 0;
    static_cast<void>(std::stod(word, &used));
    return used == word.size();
  } catch (const std::exception&) {
    return false;
  }
}

/// How many numbers the first line has; "nan" is one. 0 if it has anything else.
int numbers_of_first_line(std::string_view text) {
  std::istringstream line{std::string(text.substr(0, text.find('\n')))};
  int numbers = 0;
  for (std::string word; line >> word; ++numbers) {
    if (!is_number(word)) return 0;
  }
  return numbers;
}

/// Whether a text is as many numbers as a world file has, one a line.
bool is_world_file(std::string_view text) {
  std::istringstream lines{std::string(text)};
  int numbers = 0;
  for (std::string line; std::getline(lines, line); ++numbers) {
    if (numbers_of_first_line(line) != 1) return false;
  }
  return numbers == 6;
}

/// Kind of a text that begins with '{', by its first key.
ContentKind kind_of_json_object(std::string_view text) {
  const std::string_view body = without_blanks(text.substr(1));
  if (body.starts_with('}')) return ContentKind::kReport;  // of no figures
  if (!body.starts_with('"')) return ContentKind::kOther;
  const std::string_view key = body.substr(1, body.find('"', 1) - 1);
  if (key == "fovea_pair") return ContentKind::kMapPair;
  if (key == "fovea_poses") return ContentKind::kCityPoses;
  if (key == "fovea_catalog") return ContentKind::kCatalog;
  if (key == "fovea_city") return ContentKind::kCityManifest;
  if (key == "type" && body.find("\"FeatureCollection\"") != std::string_view::npos) {
    return ContentKind::kGeoJson;
  }
  constexpr std::array kReportKeys{"map",   "protocol", "localize",
                                   "fovea", "warnings", "calibration"};
  const bool is_report =
      std::find(kReportKeys.begin(), kReportKeys.end(), key) != kReportKeys.end();
  return is_report ? ContentKind::kReport : ContentKind::kJson;
}

ContentKind kind_of_sqlite(std::string_view head) {
  constexpr std::size_t kApplicationId = 68;  // offset in SQLite's header
  const bool is_map =
      head.size() > kApplicationId && head.substr(kApplicationId).starts_with("FVEA");
  return is_map ? ContentKind::kMap : ContentKind::kSqlite;
}

}  // namespace

ContentKind content_kind_of(const std::filesystem::path& file) {
  std::error_code error;
  if (std::filesystem::file_size(file, error) == 0 && !error) return ContentKind::kEmpty;
  const std::string head = head_of(file);
  const std::string_view text = without_blanks(head);
  switch (sniff_format(head).format) {
    case FileFormat::kSqlite:
      return kind_of_sqlite(head);
    case FileFormat::kPly:
      return ContentKind::kPly;
    case FileFormat::kPcd:
      return ContentKind::kPcd;
    case FileFormat::kLas:
      return ContentKind::kLas;
    case FileFormat::kPng:
      return ContentKind::kPng;
    default:
      break;
  }
  if (head.starts_with("glTF")) return ContentKind::kGlb;
  if (begins_with_tag(text, "<!doctype html") || begins_with_tag(text, "<html"))
    return ContentKind::kHtml;
  if (text.starts_with("<PAMDataset")) return ContentKind::kRasterAuxiliary;
  if (text.starts_with('{')) return kind_of_json_object(text);
  if (text.starts_with("frame,time_ns,")) return ContentKind::kPoseTable;
  if (text.starts_with("index,time_ns,")) return ContentKind::kFrameTable;
  if (text.starts_with("# Results\n\n    fovea reproduce")) return ContentKind::kMarkdown;
  const int numbers = numbers_of_first_line(text);
  if (numbers == 12) return ContentKind::kPoses;
  if (numbers == 1 && is_world_file(text)) return ContentKind::kWorldFile;
  return numbers == 8 ? ContentKind::kTrajectory : ContentKind::kOther;
}

const char* describe(ContentKind kind) {
  switch (kind) {
    case ContentKind::kEmpty:
      return "an empty file";
    case ContentKind::kMap:
      return "a Fovea map";
    case ContentKind::kMapPair:
      return "a pair of maps";
    case ContentKind::kCityPoses:
      return "poses of a city";
    case ContentKind::kCatalog:
      return "the catalog of a drive";
    case ContentKind::kCityManifest:
      return "the manifest of a city";
    case ContentKind::kReport:
      return "a report of Fovea";
    case ContentKind::kHtml:
      return "an HTML page";
    case ContentKind::kPly:
      return "a PLY file";
    case ContentKind::kPcd:
      return "a PCD file";
    case ContentKind::kLas:
      return "a LAS file";
    case ContentKind::kGlb:
      return "a glTF file";
    case ContentKind::kPng:
      return "a PNG image";
    case ContentKind::kWorldFile:
      return "a world file";
    case ContentKind::kRasterAuxiliary:
      return "an XML file about a picture";
    case ContentKind::kPoses:
      return "a pose file";
    case ContentKind::kTrajectory:
      return "a trajectory";
    case ContentKind::kGeoJson:
      return "a GeoJSON file";
    case ContentKind::kPoseTable:
      return "a table of poses";
    case ContentKind::kFrameTable:
      return "a table of frames";
    case ContentKind::kMarkdown:
      return "a results page";
    case ContentKind::kSqlite:
      return "an SQLite database, but no map";
    case ContentKind::kJson:
      return "JSON, but no report of Fovea";
    case ContentKind::kOther:
      break;
  }
  return "a file of another kind";
}

}  // namespace fovea
