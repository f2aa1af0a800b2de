#include "app/file_kind.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <fstream>
#include <sstream>
#include <string>
#include <string_view>

namespace fovea::app {
namespace {

constexpr std::size_t kHead = 4096;  // bytes: more than the longest line of a pose file

std::string head_of(const std::filesystem::path& file) {
  std::string head(kHead, '\0');
  std::ifstream stream(file, std::ios::binary);
  stream.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<std::size_t>(std::max<std::streamsize>(stream.gcount(), 0)));
  return head;
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

/// Whether the first line has 12 numbers; "nan" is one.
bool is_pose_file(std::string_view text) {
  std::istringstream line{std::string(text.substr(0, text.find('\n')))};
  int numbers = 0;
  for (std::string word; line >> word; ++numbers) {
    if (!is_number(word)) return false;
  }
  return numbers == 12;
}

/// Kind of a text that begins with '{', by its first key.
FileKind kind_of_json_object(std::string_view text) {
  const std::string_view body = without_blanks(text.substr(1));
  if (body.starts_with('}')) return FileKind::kReport;  // of no figures
  if (!body.starts_with('"')) return FileKind::kOther;
  const std::string_view key = body.substr(1, body.find('"', 1) - 1);
  constexpr std::array kReportKeys{"map", "protocol", "localize", "fovea", "warnings"};
  const bool is_report =
      std::find(kReportKeys.begin(), kReportKeys.end(), key) != kReportKeys.end();
  return is_report ? FileKind::kReport : FileKind::kJson;
}

FileKind kind_of_sqlite(std::string_view head) {
  constexpr std::size_t kApplicationId = 68;  // offset in SQLite's header
  const bool is_map =
      head.size() > kApplicationId && head.substr(kApplicationId).starts_with("FVEA");
  return is_map ? FileKind::kMap : FileKind::kSqlite;
}

}  // namespace

FileKind kind_of_file(const std::filesystem::path& file) {
  std::error_code error;
  if (std::filesystem::file_size(file, error) == 0 && !error) return FileKind::kEmpty;
  const std::string head = head_of(file);
  const std::string_view text = without_blanks(head);
  if (head.starts_with(std::string_view("SQLite format 3\0", 16))) return kind_of_sqlite(head);
  if (begins_with_tag(head, "ply\n") || begins_with_tag(head, "ply\r") ||
      begins_with_tag(head, "ply "))
    return FileKind::kPly;
  if (begins_with_tag(head, "# .pcd") || head.starts_with("VERSION ")) return FileKind::kPcd;
  if (head.starts_with("LASF")) return FileKind::kLas;
  if (head.starts_with("glTF")) return FileKind::kGlb;
  if (head.starts_with("\x89PNG")) return FileKind::kPng;
  if (begins_with_tag(text, "<!doctype html") || begins_with_tag(text, "<html"))
    return FileKind::kHtml;
  if (text.starts_with('{')) return kind_of_json_object(text);
  if (text.starts_with("frame,time_ns,")) return FileKind::kPoseTable;
  if (text.starts_with("# Results\n\n    fovea reproduce")) return FileKind::kMarkdown;
  return is_pose_file(text) ? FileKind::kPoses : FileKind::kOther;
}

const char* describe(FileKind kind) {
  switch (kind) {
    case FileKind::kEmpty:
      return "an empty file";
    case FileKind::kMap:
      return "a Fovea map";
    case FileKind::kReport:
      return "a report of Fovea";
    case FileKind::kHtml:
      return "an HTML page";
    case FileKind::kPly:
      return "a PLY file";
    case FileKind::kPcd:
      return "a PCD file";
    case FileKind::kLas:
      return "a LAS file";
    case FileKind::kGlb:
      return "a glTF file";
    case FileKind::kPng:
      return "a PNG image";
    case FileKind::kPoses:
      return "a pose file";
    case FileKind::kPoseTable:
      return "a table of poses";
    case FileKind::kMarkdown:
      return "a results page";
    case FileKind::kSqlite:
      return "an SQLite database, but no map";
    case FileKind::kJson:
      return "JSON, but no report of Fovea";
    case FileKind::kOther:
      break;
  }
  return "a file of another kind";
}

}  // namespace fovea::app
