// Reading whole files and listing folders of numbered files; every failure names the file.
#pragma once

#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "fovea/core/input_file.h"

namespace fovea {

/// Whole content of a file; InputError if it cannot be read or is too large (InputFile).
std::vector<std::uint8_t> read_bytes(const std::filesystem::path& file,
                                     const FileKind& kind = kDataFile);

/// Makes the system fetch a file that will be read, without waiting. Ignores a file that cannot be
/// read: its reader reports it.
void expect_file(const std::filesystem::path& file);

/// Text of a UTF-8 file without a byte order mark. InputError if the file cannot be read or has
/// another encoding.
std::string read_text(const std::filesystem::path& file);

/// Lines of read_text() without their line ends (LF or CRLF).
std::vector<std::string> read_lines(const std::filesystem::path& file);

/// All numbers of a text, separated by white space; empty if anything in it is no number. "nan" and
/// "inf" are numbers here. Independent of the locale.
std::optional<std::vector<double>> parse_numbers(std::string_view text);

/// Files by the number that their names consist of ("0000000012.bin" is 12).
using NumberedFiles = std::map<int, std::filesystem::path>;

/// No drive has as many frames; a larger number in a name is something else, such as a date.
inline constexpr int kEndOfNames = 10'000'000;

/// The files of `folder` whose name is a number with one of the `extensions` (".png", any case);
/// others are ignored. Empty if there is no such folder. Of two files with one number the first by
/// name.
NumberedFiles list_numbered_files(const std::filesystem::path& folder,
                                  std::initializer_list<std::string_view> extensions);

/// The files next to the listed ones that have the same extension and are not listed, by name.
std::vector<std::filesystem::path> files_left_out(const NumberedFiles& listed);

}  // namespace fovea
