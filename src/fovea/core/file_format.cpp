#include "fovea/core/file_format.h"

#include <algorithm>
#include <array>

namespace fovea {
namespace {

using namespace std::string_view_literals;

/// First bytes of a file that no file of another format has.
struct Signature {
  std::string_view bytes;
  SniffedFormat format;
};

// The first four bytes as a coordinate in float32 are below 1 mm or beyond 1 km, or more bytes
// follow: no scan without a header begins so.
constexpr std::array kSignatures = {
    Signature{"# .PCD"sv, {FileFormat::kPcd, "a PCD point cloud"}},
    Signature{"ASTM-E57"sv, {FileFormat::kE57, "an E57 point cloud"}},
    Signature{"\x89PNG\r\n\x1a\n"sv, {FileFormat::kPng, "a PNG image"}},
    Signature{"II*\0"sv, {FileFormat::kOther, "a TIFF image"}},
    Signature{"MM\0*"sv, {FileFormat::kOther, "a TIFF image"}},
    Signature{"GIF87a"sv, {FileFormat::kOther, "a GIF image"}},
    Signature{"GIF89a"sv, {FileFormat::kOther, "a GIF image"}},
    Signature{"RIFF"sv, {FileFormat::kOther, "a RIFF file (WebP, WAV or AVI)"}},
    Signature{"SQLite format 3\0"sv, {FileFormat::kSqlite, "an SQLite database"}},
    Signature{"\x89MCAP0\r\n"sv, {FileFormat::kMcap, "an MCAP recording"}},
    Signature{"#ROSBAG V"sv, {FileFormat::kRosBag1, "a recording of ROS 1"}},
    Signature{"\x28\xb5\x2f\xfd"sv, {FileFormat::kZstd, "zstd-compressed data"}},
    Signature{"\xfd"
              "7zXZ\0"sv,
              {FileFormat::kOther, "xz-compressed data"}},
    Signature{"7z\xbc\xaf\x27\x1c"sv, {FileFormat::kOther, "a 7z archive"}},
    Signature{"PK\x03\x04"sv, {FileFormat::kOther, "a ZIP archive"}},
    Signature{"Rar!\x1a\x07"sv, {FileFormat::kOther, "a RAR archive"}},
    Signature{"\x89HDF\r\n\x1a\n"sv, {FileFormat::kOther, "an HDF5 file"}},
    Signature{"\x93NUMPY"sv, {FileFormat::kOther, "a NumPy array"}},
    Signature{"\xd4\xc3\xb2\xa1"sv, {FileFormat::kOther, "a capture of packets (pcap)"}},
    Signature{"\x4d\x3c\xb2\xa1"sv, {FileFormat::kOther, "a capture of packets (pcap)"}},
    Signature{"\x0a\x0d\x0d\x0a"sv, {FileFormat::kOther, "a capture of packets (pcapng)"}},
    Signature{"glTF"sv, {FileFormat::kOther, "a glTF model"}},
    Signature{"%PDF-"sv, {FileFormat::kOther, "a PDF document"}},
    Signature{"\x7f"
              "ELF"sv,
              {FileFormat::kOther, "a program (ELF)"}},
};

constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";  // of UTF-8
constexpr std::string_view kBlanks = " \t\r";

/// "ply" on a line of its own. Blanks may follow it.
bool is_ply(std::string_view text) {
  if (!text.starts_with("ply")) return false;
  text.remove_prefix(3);
  text.remove_prefix(std::min(text.find_first_not_of(kBlanks), text.size()));
  return text.empty() || text.front() == '\n';
}

/// A header of PCD: comments, then VERSION, or FIELDS in files without a version.
bool is_pcd(std::string_view text) {
  while (text.starts_with('#') || text.starts_with('\n') || text.starts_with("\r\n")) {
    const std::size_t end = text.find('\n');
    if (end == std::string_view::npos) return false;
    text.remove_prefix(end + 1);
  }
  return text.starts_with("VERSION ") || text.starts_with("FIELDS ") ||
         text.starts_with("COLUMNS ");
}

bool is_laz(std::string_view bytes) {
  constexpr std::size_t kPointFormat = 104;
  constexpr unsigned char kCompressed = 64;  // LASzip's marks are bits 6 and 7
  return bytes.size() > kPointFormat &&
         static_cast<unsigned char>(bytes[kPointFormat]) >= kCompressed;
}

/// The mark of JPEG and the first segment, of a type that a JPEG file begins with.
bool is_jpeg(std::string_view bytes) {
  constexpr unsigned char kFirstSegment = 0xc4;
  return bytes.starts_with("\xff\xd8\xff") &&
         (bytes.size() == 3 || static_cast<unsigned char>(bytes[3]) >= kFirstSegment);
}

/// The mark of gzip with deflate, and flags of which the upper three bits are zero.
bool is_gzip(std::string_view bytes) {
  return bytes.size() > 3 && bytes.starts_with("\x1f\x8b\x08") &&
         static_cast<unsigned char>(bytes[3]) < 0x20;
}

bool is_bzip2(std::string_view bytes) {
  return bytes.size() > 4 && bytes.starts_with("BZh") && bytes.substr(4).starts_with("1AY&SY");
}

/// The name of a tar archive stands behind its first entry.
bool is_tar(std::string_view bytes) {
  constexpr std::size_t kMagic = 257;
  return bytes.size() >= kMagic + 5 && bytes.substr(kMagic, 5) == "ustar";
}

/// Only printable ASCII and white space. Fewer bytes of a point can look like that.
bool is_text(std::string_view bytes) {
  constexpr std::size_t kLeast = 16;
  return bytes.size() >= kLeast && std::all_of(bytes.begin(), bytes.end(), [](char c) {
           return (c >= ' ' && c <= '~') || (c >= '\t' && c <= '\r');
         });
}

}  // namespace

SniffedFormat sniff_format(std::string_view beginning) {
  const std::string_view bytes = beginning.substr(0, kSniffedBytes);
  for (const Signature& signature : kSignatures) {
    if (bytes.starts_with(signature.bytes)) return signature.format;
  }
  if (bytes.starts_with("LASF")) {
    if (is_laz(bytes)) return {FileFormat::kLaz, "a LAZ point cloud (compressed LAS)"};
    return {FileFormat::kLas, "a LAS point cloud"};
  }
  if (is_jpeg(bytes)) return {FileFormat::kJpeg, "a JPEG image"};
  if (is_gzip(bytes)) return {FileFormat::kOther, "gzip-compressed data"};
  if (is_bzip2(bytes)) return {FileFormat::kOther, "bzip2-compressed data"};
  if (is_tar(bytes)) return {FileFormat::kOther, "a tar archive"};
  std::string_view text = bytes;
  if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
  if (is_ply(text)) return {FileFormat::kPly, "a PLY point cloud"};
  if (is_pcd(text)) return {FileFormat::kPcd, "a PCD point cloud"};
  if (text.starts_with("<?xml")) return {FileFormat::kText, "an XML file"};
  if (is_text(bytes)) return {FileFormat::kText, "a text file"};
  return {};
}

}  // namespace fovea
