#include "fovea/core/read_file.h"

#include <fcntl.h>

#include <algorithm>
#include <charconv>
#include <set>

#include "fovea/core/text_encoding.h"
#include "fovea/errors.h"

namespace fovea {
namespace {

constexpr std::string_view kWhiteSpace = " \t\r\n\v\f";

std::optional<int> parse_file_number(const std::string& stem) {
  int number = 0;
  const char* end = stem.data() + stem.size();
  const auto [rest, error] = std::from_chars(stem.data(), end, number);
  if (error != std::errc() || rest != end || number < 0 || number >= kEndOfNames) {
    return std::nullopt;
  }
  return number;
}

std::string lower_case(std::string text) {
  for (char& c : text) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return text;
}

}  // namespace

std::vector<std::uint8_t> read_bytes(const std::filesystem::path& file, const FileKind& kind) {
  return InputFile(file, kind).bytes();
}

void expect_file(const std::filesystem::path& file) {
  try {
    const InputFile expected(file, kStreamedFile);
    static_cast<void>(posix_fadvise(expected.descriptor(), 0, 0, POSIX_FADV_WILLNEED));
  } catch (const InputError&) {  // reported where the file is read
  }
}

std::string read_text(const std::filesystem::path& file) {
  const std::vector<std::uint8_t> bytes = read_bytes(file);
  const std::string text(bytes.begin(), bytes.end());
  return std::string(without_byte_order_mark(text, file.string()));
}

std::vector<std::string> read_lines(const std::filesystem::path& file) {
  const std::string text = read_text(file);
  std::vector<std::string> lines;
  for (auto begin = text.begin(); begin != text.end();) {
    const auto end = std::find(begin, text.end(), '\n');
    lines.emplace_back(begin, end);
    if (!lines.back().empty() && lines.back().back() == '\r') lines.back().pop_back();
    begin = end == text.end() ? end : end + 1;
  }
  return lines;
}

std::optional<std::vector<double>> parse_numbers(std::string_view text) {
  std::vector<double> numbers;
  while (true) {
    text.remove_prefix(std::min(text.find_first_not_of(kWhiteSpace), text.size()));
    if (text.empty()) return numbers;
    const std::string_view word = text.substr(0, text.find_first_of(kWhiteSpace));
    double number = 0;
    const auto [rest, error] = std::from_chars(word.data(), word.data() + word.size(), number);
    if (error != std::errc() || rest != word.data() + word.size()) return std::nullopt;
    numbers.push_back(number);
    text.remove_prefix(word.size());
  }
}

NumberedFiles list_numbered_files(const std::filesystem::path& folder,
                                  std::initializer_list<std::string_view> extensions) {
  NumberedFiles files;
  std::error_code missing;
  for (const auto& entry : std::filesystem::directory_iterator(folder, missing)) {
    const std::filesystem::path& file = entry.path();
    const std::string extension = lower_case(file.extension().string());
    if (std::find(extensions.begin(), extensions.end(), extension) == extensions.end()) continue;
    const std::optional<int> number = parse_file_number(file.stem().string());
    if (!number) continue;
    const auto [it, is_new] = files.try_emplace(*number, file);
    if (!is_new && file < it->second) it->second = file;
  }
  return files;
}

std::vector<std::filesystem::path> files_left_out(const NumberedFiles& listed) {
  std::set<std::filesystem::path> names;
  for (const auto& [number, file] : listed) names.insert(file);
  std::vector<std::filesystem::path> others;
  if (names.empty()) return others;
  const std::string extension = lower_case(names.begin()->extension().string());
  std::error_code missing;
  for (const auto& entry :
       std::filesystem::directory_iterator(names.begin()->parent_path(), missing)) {
    const std::filesystem::path& file = entry.path();
    if (lower_case(file.extension().string()) != extension || names.contains(file)) continue;
    others.push_back(file);
  }
  std::sort(others.begin(), others.end());
  return others;
}

}  // namespace fovea
