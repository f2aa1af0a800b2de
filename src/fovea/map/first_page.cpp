#include "fovea/map/first_page.h"

#include <fmt/format.h>
#include <stdlib.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <fstream>
#include <string_view>
#include <vector>

#include "fovea/core/output_file.h"
#include "fovea/map/map_schema.h"
#include "fovea/map/map_store.h"

namespace fovea {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kHeaderSize = 100;
// Places in the header (https://www.sqlite.org/fileformat.html).
constexpr std::string_view kMagic{"SQLite format 3\0", 16};
constexpr std::size_t kPageSizeAt = 16, kChangesAt = 24, kPagesAt = 28, kPagesValidForAt = 92;

/// `count` bytes of a file, less where it ends.
std::string bytes_at(const fs::path& file, std::uintmax_t offset, std::size_t count) {
  std::ifstream stream(file, std::ios::binary);
  std::string bytes(count, '\0');
  stream.seekg(static_cast<std::streamoff>(offset));
  stream.read(bytes.data(), static_cast<std::streamsize>(count));
  bytes.resize(static_cast<std::size_t>(std::max<std::streamsize>(stream.gcount(), 0)));
  return bytes;
}

std::uint32_t big_endian(std::string_view bytes, std::size_t at, std::size_t count) {
  std::uint32_t number = 0;
  for (std::size_t i = 0; i < count; ++i) {
    number = number << 8 | static_cast<unsigned char>(bytes[at + i]);
  }
  return number;
}

std::uintmax_t size_of(const fs::path& file) {
  std::error_code ignored;
  const std::uintmax_t size = fs::file_size(file, ignored);
  return ignored ? 0 : size;
}

/// Whether a header states the number of pages. Other programs may write a file without counting.
bool counts_pages(std::string_view header) {
  return big_endian(header, kChangesAt, 4) == big_endian(header, kPagesValidForAt, 4);
}

/// Of the file, in bytes.
std::uintmax_t stated_size(std::string_view header) {
  const std::uint32_t stored = big_endian(header, kPageSizeAt, 2);
  const std::uintmax_t page_size = stored == 1 ? 65536 : stored;
  return page_size * big_endian(header, kPagesAt, 4);
}

fs::path new_folder() {
  std::string name = (fs::temp_directory_path() / "fovea-XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) throw_output_error(name, errno);
  return name;
}

}  // namespace

std::optional<std::string> missing_bytes(const fs::path& map) {
  const std::string header = bytes_at(map, 0, kHeaderSize);
  if (header.size() < kHeaderSize || !header.starts_with(kMagic)) return std::nullopt;
  if (!counts_pages(header)) return std::nullopt;
  const std::uintmax_t expected = stated_size(header), size = size_of(map);
  if (size >= expected) return std::nullopt;
  return fmt::format("{} of {} bytes are there", size, expected);
}

bool has_pages_of_map(const fs::path& file) {
  // The tables and their indexes begin on the second page and those that follow.
  std::size_t pages = 0;
  for (std::size_t page = 1; page <= kTables.size(); ++page) {
    const std::string first = bytes_at(file, page * kPageSize, 1);
    if (first.empty()) break;
    constexpr std::string_view kTypes("\x02\x05\x0a\x0d");  // inner pages and leaves of B-trees
    pages += kTypes.find(first[0]) != std::string_view::npos;
  }
  return 2 * pages > kTables.size();
}

bool has_damaged_header(const fs::path& file) {
  struct Part {
    std::size_t at;
    std::string_view bytes;
  };
  // Page size, payload fractions, format of the schema, no vacuum, UTF-8.
  constexpr std::array kParts{Part{16, {"\x20\0", 2}}, Part{20, {"\0\x40\x20\x20", 4}},
                              Part{44, {"\0\0\0\4", 4}}, Part{52, {"\0\0\0\0\0\0\0\1", 8}}};
  const std::string header = bytes_at(file, 0, kHeaderSize);
  if (header.size() < kHeaderSize || !header.starts_with(kMagic)) return false;
  const bool is_whole = std::all_of(kParts.begin(), kParts.end(), [&](const Part& part) {
    return header.compare(part.at, part.bytes.size(), part.bytes) == 0;
  });
  const bool has_fewer_pages = counts_pages(header) && stated_size(header) < size_of(file);
  return (!is_whole || has_fewer_pages) && has_pages_of_map(file);
}

CopyWithNewFirstPage::CopyWithNewFirstPage(const fs::path& map) : folder_(new_folder()) {
  const fs::path empty = folder_ / "empty.fovea";
  MapWriter::create(empty, false)->commit();
  std::string page = bytes_at(empty, 0, kPageSize);
  const std::uintmax_t pages = size_of(map) / kPageSize;
  for (std::size_t i = 0; i < 4; ++i) {
    page[kPagesAt + i] = static_cast<char>(pages >> (8 * (3 - i)) & 0xff);
  }
  std::error_code error;
  fs::copy_file(map, path(), error);
  if (error) throw_output_error(path(), error.value());
  fs::permissions(path(), fs::perms::owner_read | fs::perms::owner_write, error);
  std::fstream copy(path(), std::ios::binary | std::ios::in | std::ios::out);
  copy.write(page.data(), static_cast<std::streamsize>(page.size()));
  if (!copy.flush()) throw_output_error(path(), errno);
}

CopyWithNewFirstPage::~CopyWithNewFirstPage() {
  std::error_code ignored;
  fs::remove_all(folder_, ignored);
}

}  // namespace fovea
