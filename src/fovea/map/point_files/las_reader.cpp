#include "fovea/map/point_files/las_reader.h"

#include "fovea/core/input_file.h"
#include "fovea/core/point_formats/cloud_rows.h"
#include "fovea/errors.h"

namespace fovea {
namespace {

/// Offsets in the header (LAS 1.4 R15, section 2.4).
constexpr std::size_t kVersionMinor = 25, kHeaderSize = 94, kPointsBegin = 96, kFormat = 104,
                      kRecordLength = 105, kLegacyCount = 107, kScale = 131, kOffset = 155,
                      kCount64 = 247;
constexpr std::size_t kHeaderBytes12 = 227, kHeaderBytes13 = 235, kHeaderBytes14 = 375;

/// Where a point format keeps what is read (sections 2.6.1 to 2.6.11), bytes from the record's
/// begin.
struct Layout {
  int format;
  std::size_t length;  // at least
  std::size_t color;
  bool flags_of_14;  // withheld is bit 2 of the flags, not bit 7 of the classification
};
constexpr std::array<Layout, 6> kLayouts = {{{2, 26, 20, false},
                                             {3, 34, 28, false},
                                             {5, 63, 28, false},
                                             {7, 36, 30, true},
                                             {8, 38, 30, true},
                                             {10, 67, 30, true}}};

class LasFile {
 public:
  LasFile(const std::filesystem::path& file, const Eigen::Vector3d& origin)
      : file_(file), input_(file, kStreamedFile), cloud_(file, origin) {
    read_header();
  }

  CloudFile read() {
    std::array<bool, kCloudColumns> columns{};
    for (const CloudColumn column : {kX, kY, kZ, kRed, kGreen, kBlue}) columns[column] = true;
    cloud_.expect(points_, columns);
    double highest = 0;
    for_each_record([&](const char* record, std::size_t) {
      for (std::size_t c = 0; c < 3; ++c) {
        highest = std::max(highest, decode(Scalar::kUint16, record + layout_.color + 2 * c));
      }
    });
    // The upper byte: of 255 * 256 as of 255 * 257, which programs write for white.
    const double unit = highest > 255 ? 256 : 1;
    for_each_record([&](const char* record, std::size_t number) {
      const auto flags = static_cast<unsigned char>(record[15]);
      if (((flags >> (layout_.flags_of_14 ? 2 : 7)) & 1) != 0) return;
      CloudRow row{};
      for (std::size_t axis = 0; axis < 3; ++axis) {
        row[kX + axis] = decode(Scalar::kInt32, record + 4 * axis) * scale_[axis] + offset_[axis];
        const double channel = decode(Scalar::kUint16, record + layout_.color + 2 * axis);
        row[kRed + axis] = std::floor(channel / unit);
      }
      cloud_.add(row, number);
    });
    return cloud_.take();
  }

 private:
  [[noreturn]] void reject(const std::string& what, std::uintmax_t offset,
                           const std::string& remedy = "write the file anew") const {
    throw InputError(what, file_.string() + ", byte " + std::to_string(offset), remedy);
  }

  void read_header() {
    std::string header(kHeaderBytes14, '\0');
    input_.stream().read(header.data(), kHeaderBytes14);
    const auto got = static_cast<std::size_t>(input_.stream().gcount());
    input_.stream().clear();
    if (!header.starts_with("LASF"))
      reject("this is no LAS file", 0, "give a LAS file, 1.2 to 1.4");
    if (got < kHeaderBytes12) reject("the LAS header ends early", got);
    const auto at = [&](Scalar type, std::size_t offset) {
      return decode(type, header.data() + offset);
    };
    const auto major = static_cast<int>(at(Scalar::kUint8, kVersionMinor - 1));
    const auto minor = static_cast<int>(at(Scalar::kUint8, kVersionMinor));
    if (major != 1 || minor < 2 || minor > 4) {
      reject("LAS " + std::to_string(major) + "." + std::to_string(minor) + " is not read",
             kVersionMinor - 1, "convert it to LAS 1.4");
    }
    const std::size_t header_bytes = minor == 4   ? kHeaderBytes14
                                     : minor == 3 ? kHeaderBytes13
                                                  : kHeaderBytes12;
    const auto header_size = static_cast<std::size_t>(at(Scalar::kUint16, kHeaderSize));
    if (header_size < header_bytes || got < header_bytes) {
      reject("the LAS header is too short for its version", kHeaderSize);
    }
    const auto format = static_cast<unsigned>(at(Scalar::kUint8, kFormat));
    if (format >= 64) reject_laz(file_);  // LASzip's mark
    choose_layout(static_cast<int>(format));
    record_bytes_ = static_cast<std::size_t>(at(Scalar::kUint16, kRecordLength));
    if (record_bytes_ < layout_.length) {
      reject("a point of " + std::to_string(record_bytes_) +
                 " bytes is too short for point format " + std::to_string(format),
             kRecordLength);
    }
    read_count(header, minor == 4);
    begin_ = static_cast<std::uintmax_t>(at(Scalar::kUint32, kPointsBegin));
    if (begin_ < header_size) reject("the points begin inside the header", kPointsBegin);
    // A damaged header can say anything: checked before anything is allocated.
    if (begin_ > input_.size() || points_ > (input_.size() - begin_) / record_bytes_) {
      reject("the file is too short for its " + std::to_string(points_) + " points", kPointsBegin);
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
      scale_[axis] = at(Scalar::kDouble, kScale + 8 * axis);
      offset_[axis] = at(Scalar::kDouble, kOffset + 8 * axis);
      if (!std::isfinite(scale_[axis]) || scale_[axis] == 0) {
        reject("a scale is zero or not finite", kScale + 8 * axis);
      }
      if (!std::isfinite(offset_[axis])) reject("an offset is not finite", kOffset + 8 * axis);
    }
  }

  void choose_layout(int format) {
    for (const Layout& layout : kLayouts) {
      if (layout.format == format) {
        layout_ = layout;
        return;
      }
    }
    reject("point format " + std::to_string(format) + " has no colours or is not known", kFormat,
           "write the cloud in point format 2, 3, 5, 7, 8 or 10");
  }

  void read_count(const std::string& header, bool has_count64) {
    std::uint32_t legacy = 0;
    std::uint64_t count = 0;
    std::copy_n(header.data() + kLegacyCount, sizeof legacy, reinterpret_cast<char*>(&legacy));
    if (has_count64) {
      std::copy_n(header.data() + kCount64, sizeof count, reinterpret_cast<char*>(&count));
    }
    points_ = count != 0 ? count : legacy;
  }

  template <class F>
  void for_each_record(F&& f) {
    constexpr std::size_t kBlock = 1 << 10;
    // No larger than the file needs: a header may give a point 64 KiB.
    std::string buffer(std::min<std::size_t>(kBlock, points_) * record_bytes_, '\0');
    input_.stream().seekg(static_cast<std::streamoff>(begin_));
    for (std::size_t begin = 0; begin < points_; begin += kBlock) {
      const std::size_t count = std::min<std::size_t>(kBlock, points_ - begin);
      if (!input_.stream().read(buffer.data(), std::streamsize(count * record_bytes_))) {
        reject("the file cannot be read to its end", begin_ + begin * record_bytes_);
      }
      for (std::size_t i = 0; i < count; ++i) f(buffer.data() + i * record_bytes_, begin + i);
    }
  }

  std::filesystem::path file_;
  InputFile input_;
  std::uintmax_t begin_ = 0;  // bytes before the first point
  CloudBuilder cloud_;
  Layout layout_{};
  std::size_t record_bytes_ = 0;
  std::uint64_t points_ = 0;
  std::array<double, 3> scale_{}, offset_{};
};

}  // namespace

CloudFile read_las(const std::filesystem::path& file, const Eigen::Vector3d& origin) {
  return LasFile(file, origin).read();
}

void reject_laz(const std::filesystem::path& file) {
  throw InputError(
      "compressed LAS (LAZ) is not read", file.string(),
      "convert it to LAS: laszip -i IN.laz -o OUT.las, or pdal translate IN.laz OUT.las");
}

}  // namespace fovea
