#include "fovea/map/point_files/las_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <limits>
#include <string>
#include <unordered_map>

#include "fovea/core/gps_time.h"
#include "fovea/core/output_file.h"
#include "fovea/errors.h"
#include "fovea/map/point_files/point_packing.h"
#include "fovea/platform.h"

// Numbers of sections and tables are those of the LAS Specification 1.4 - R15 (ASPRS).
namespace fovea {
namespace {

constexpr double kCoordinateScale = 0.001;  // m
constexpr std::uint16_t kHeaderBytes = 375, kVlrHeaderBytes = 54;
constexpr std::uint8_t kPointFormat = 7;
constexpr std::uint16_t kFormatBytes = 36;
constexpr std::uint16_t kExtraBytes = 1 + 4 + 4 + 1 + 1 + 1 + 1;  // pack_provenance()
constexpr std::size_t kReturns = 15;

// Global encoding, table 4.
constexpr std::uint16_t kAdjustedGpsTime = 1, kSyntheticReturns = 8, kWkt = 16;
// Flags and classes of a point, tables 16 and 17.
constexpr std::uint8_t kOnlyReturn = 1 | 1 << 4, kSyntheticPoint = 1, kUnclassified = 1;

/// An attribute that LAS has no field for, table 24.
struct ExtraByte {
  enum Type : std::uint8_t { kUint8 = 1, kInt8 = 2, kInt32 = 6, kFloat = 9 };
  const char* name;
  Type type;
  const char* description;
  std::optional<std::int64_t> no_data = std::nullopt;
};
/// As pack_provenance() writes them.
constexpr std::array<ExtraByte, 7> kProvenance = {
    {{"camera", ExtraByte::kInt8, "camera of the colour, -1: none", kNoCamera},
     {"frame", ExtraByte::kInt32, "index of the frame"},
     {"range", ExtraByte::kFloat, "m from the sensor"},
     {"interpolated", ExtraByte::kUint8, "1: upsampled, 0: measured"},
     {"views", ExtraByte::kUint8, "images fused in the colour"},
     {"spread", ExtraByte::kUint8, "RMS of their differences"},
     {"reason", ExtraByte::kUint8, "why it is in the map"}}};

std::string variable_length_record(std::string_view user, std::uint16_t record,
                                   std::string_view description, const std::string& content) {
  std::string bytes;
  BytePacker packer(bytes);
  packer.put(std::uint16_t{0});
  packer.put_text(user, 16);
  packer.put(record);
  packer.put(static_cast<std::uint16_t>(content.size()));
  packer.put_text(description, 32);
  return bytes + content;
}

std::string extra_bytes_content() {
  std::string bytes;
  BytePacker packer(bytes);
  for (const ExtraByte& extra : kProvenance) {
    packer.put_zeros(2);
    packer.put(std::uint8_t{extra.type});
    packer.put(static_cast<std::uint8_t>(extra.no_data ? 1 : 0));
    packer.put_text(extra.name, 32);
    packer.put_zeros(4);
    packer.put(extra.no_data.value_or(0));
    packer.put_zeros(16 + 4 * 24);  // no_data of deprecated arrays; min, max, scale, offset
    packer.put_text(extra.description, 32);
  }
  return bytes;
}

std::string variable_length_records(const PointStream& points) {
  return variable_length_record("LASF_Projection", 2112, "OGC coordinate system WKT",
                                points.georeference().wkt1() + '\0') +
         variable_length_record("fovea", 1, "Exposure of the colors", points.exposure()) +
         variable_length_record("LASF_Spec", 4, "Extra bytes", extra_bytes_content());
}

/// How far the stamps of a drive of this kind (DriveInfo::kind) are ahead of UTC. KITTI recorded in
/// September and October 2011 by the clock of Karlsruhe, which is summer time. The stamps of other
/// kinds are Unix time, which is UTC.
TimeNs utc_offset_of(std::string_view kind) {
  constexpr TimeNs kSummerTime = TimeNs{2} * 3600 * kNsPerSecond;
  return kind.starts_with("kitti") ? kSummerTime : 0;
}

/// How far the stamp of a frame is ahead of UTC, by the kind of its drive.
TimeNs utc_offset_of_frame(int frame, const std::vector<DriveRecord>& drives) {
  for (const DriveRecord& drive : drives) {
    const bool is_its_own = frame >= drive.first_frame && frame < drive.end_frame;
    if (is_its_own) return utc_offset_of(drive.kind);
  }
  return 0;
}

/// GPS times of a map's frames.
class FrameTimes {
 public:
  FrameTimes(const MapReader& map, std::optional<TimeNs> stated_offset) {
    const std::vector<DriveRecord> drives = map.drives();
    for (const FrameRecord& frame : map.frames()) {
      if (!frame.stamp) continue;
      const TimeNs utc_offset = stated_offset.value_or(utc_offset_of_frame(frame.index, drives));
      // Beyond any date the difference could overflow.
      const std::optional<double> gps = adjusted_gps_seconds(*frame.stamp)
                                            ? adjusted_gps_seconds(*frame.stamp - utc_offset)
                                            : std::nullopt;
      dated_ = dated_ && gps;
      times_[frame.index] = {seconds(*frame.stamp), gps.value_or(0)};
      if (!first_utc_) first_utc_ = *frame.stamp - (gps ? utc_offset : 0);
    }
    dated_ = dated_ && first_utc_;
  }

  bool dated() const { return dated_; }

  std::optional<double> of(std::int32_t frame) const {
    const auto found = times_.find(frame);
    if (found == times_.end()) return std::nullopt;
    return dated_ ? found->second.gps : found->second.stamp;
  }

  /// Of the first frame: day of the year (from 1) and year, UTC; 0, 0 without dates.
  std::pair<std::uint16_t, std::uint16_t> date() const {
    if (!dated_) return {0, 0};
    namespace chrono = std::chrono;
    const auto day = chrono::floor<chrono::days>(
        chrono::sys_time<chrono::nanoseconds>(chrono::nanoseconds(*first_utc_)));
    const chrono::year year = chrono::year_month_day(day).year();
    const auto new_year = chrono::sys_days(year / chrono::January / 1);
    return {static_cast<std::uint16_t>((day - new_year).count() + 1),
            static_cast<std::uint16_t>(static_cast<int>(year))};
  }

 private:
  struct Times {
    double stamp, gps;
  };
  bool dated_ = true;
  std::optional<TimeNs> first_utc_;
  std::unordered_map<std::int32_t, Times> times_;
};

/// Positions as the integers of the file, with the box around them.
class Grid {
 public:
  explicit Grid(const Eigen::Vector3d& origin) : offset_(origin.array().round()) {}

  Eigen::Vector3i add(const Eigen::Vector3d& position) {
    const Eigen::Array3d steps = ((position - offset_) / kCoordinateScale).array().round();
    if ((steps.abs() > std::numeric_limits<std::int32_t>::max()).any()) {
      throw InputError("a point lies over 2147 km from the map's origin, too far for LAS",
                       "the map's tiles", "leave it out by --where, or map the drive again");
    }
    Eigen::Vector3i cell = steps.cast<std::int32_t>();
    lowest_ = lowest_.cwiseMin(cell);
    highest_ = highest_.cwiseMax(cell);
    empty_ = false;
    return cell;
  }

  const Eigen::Vector3d& offset() const { return offset_; }
  Eigen::Vector3d low() const { return corner(lowest_); }
  Eigen::Vector3d high() const { return corner(highest_); }

 private:
  /// As a reader computes it from the integers.
  Eigen::Vector3d corner(const Eigen::Vector3i& cell) const {
    if (empty_) return Eigen::Vector3d::Zero();
    return cell.cast<double>() * kCoordinateScale + offset_;
  }

  Eigen::Vector3d offset_;
  Eigen::Vector3i lowest_ = Eigen::Vector3i::Constant(std::numeric_limits<std::int32_t>::max());
  Eigen::Vector3i highest_ = -lowest_;
  bool empty_ = true;
};

/// Section 2.4; counts of the formats up to 5 are 0.
std::string public_header(std::size_t points, std::size_t record_bytes, const FrameTimes& times,
                          const Grid& grid) {
  std::string bytes;
  BytePacker packer(bytes);
  packer.put_text("LASF", 4);
  packer.put(std::uint16_t{0});
  packer.put(static_cast<std::uint16_t>((times.dated() ? kAdjustedGpsTime : 0) | kSyntheticReturns |
                                        kWkt));
  packer.put_zeros(16);  // project
  packer.put(std::uint8_t{1});
  packer.put(std::uint8_t{4});
  packer.put_text("OTHER", 32);
  packer.put_text(fmt::format("fovea {}", version()), 32);
  packer.put(times.date().first);
  packer.put(times.date().second);
  packer.put(kHeaderBytes);
  packer.put(static_cast<std::uint32_t>(kHeaderBytes + record_bytes));
  packer.put(std::uint32_t{3});
  packer.put(kPointFormat);
  packer.put(static_cast<std::uint16_t>(kFormatBytes + kExtraBytes));
  packer.put_zeros(4 + 5 * 4);
  for (int axis = 0; axis < 3; ++axis) packer.put(kCoordinateScale);
  for (const double offset : grid.offset()) packer.put(offset);
  for (int axis = 0; axis < 3; ++axis) {
    packer.put(grid.high()[axis]);
    packer.put(grid.low()[axis]);
  }
  packer.put_zeros(8 + 8 + 4);  // no waveforms, no extended records
  packer.put(static_cast<std::uint64_t>(points));
  packer.put(static_cast<std::uint64_t>(points));  // all are first returns
  packer.put_zeros((kReturns - 1) * 8);
  return bytes;
}

std::uint16_t intensity(float reflectance) {
  return static_cast<std::uint16_t>(
      std::lround(65535.0 * (reflectance > 0 ? std::min(reflectance, 1.f) : 0.f)));
}

/// Table 21 and the extra bytes.
void pack(const ExportPoint& point, const Eigen::Vector3i& cell, double gps_time, bool deep_colors,
          BytePacker& packer) {
  for (const int coordinate : cell) packer.put(std::int32_t{coordinate});
  packer.put(intensity(point.intensity));
  packer.put(kOnlyReturn);
  packer.put(static_cast<std::uint8_t>(point.interpolated != 0 ? kSyntheticPoint : 0));
  packer.put(kUnclassified);
  packer.put_zeros(1 + 2 + 2);  // user data, scan angle, source: this file
  packer.put(gps_time);
  if (deep_colors) {
    pack_deep_color(point, packer);
  } else {
    for (const std::uint8_t channel : {point.color.r, point.color.g, point.color.b}) {
      packer.put(static_cast<std::uint16_t>(channel * 257));
    }
  }
  pack_provenance(point, packer);
}

}  // namespace

LasFigures write_las(const MapReader& map, const std::filesystem::path& path,
                     const LasOptions& options) {
  OutputFile file(path, options.force);
  const PointStream points(map, options.points);
  const FrameTimes times(map, options.utc_offset);
  const std::string records = variable_length_records(points);
  LasFigures figures{points.figures(), 0, times.dated()};
  Grid grid(points.georeference().from_local(Eigen::Vector3d::Zero()));
  const auto write_header = [&] {
    file.stream() << public_header(figures.points, records.size(), times, grid);
  };
  write_header();
  file.stream() << records;
  write_points(points, file.stream(), [&](const ExportPoint& point, BytePacker& packer) {
    const std::optional<double> time = times.of(point.frame);
    figures.points_without_time += !time;
    pack(point, grid.add(point.position), time.value_or(0), options.points.deep_colors, packer);
  });
  file.stream().seekp(0);
  write_header();  // now with the box
  file.commit();
  return figures;
}

}  // namespace fovea
