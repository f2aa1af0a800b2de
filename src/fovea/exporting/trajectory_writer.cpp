#include "fovea/exporting/trajectory_writer.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <functional>
#include <string>

#include "fovea/core/output_file.h"
#include "fovea/errors.h"
#include "fovea/geometry/georeference.h"

namespace fovea {
namespace {

/// Frames with a pose of their own.
std::vector<FrameRecord> posed_frames(const std::vector<FrameRecord>& frames,
                                      const std::filesystem::path& path) {
  std::vector<FrameRecord> posed;
  for (const FrameRecord& frame : frames) {
    if (frame.status != FrameStatus::kSkipped) posed.push_back(frame);
  }
  if (posed.empty()) {
    throw InputError("the map has no frame with a pose", path.string(), "map the drive again");
  }
  return posed;
}

/// Coordinates and the unit quaternion, which read back to the same doubles.
std::string pose_text(const RigidMotion& T_local_lidar, char separator) {
  const Eigen::Vector3d p = T_local_lidar.translation();
  Eigen::Quaterniond q(T_local_lidar.linear());
  if (q.w() < 0) q.coeffs() = -q.coeffs();
  return fmt::format("{1}{0}{2}{0}{3}{0}{4}{0}{5}{0}{6}{0}{7}", separator, p.x(), p.y(), p.z(),
                     q.x(), q.y(), q.z(), q.w());
}

std::string stamp_text(const FrameRecord& frame) {
  return frame.stamp ? fmt::format("{}", *frame.stamp) : std::string();
}

/// Seconds with nine decimals: a double would round the stamps of this century.
std::string seconds_text(TimeNs stamp) {
  const char* sign = stamp < 0 ? "-" : "";
  const TimeNs whole = stamp / kNsPerSecond, part = stamp % kNsPerSecond;
  return fmt::format("{}{}.{:09}", sign, whole < 0 ? -whole : whole, part < 0 ? -part : part);
}

std::string point_text(const GeodeticPoint& point) {
  return fmt::format("[{:.9f},{:.9f},{:.4f}]", point.longitude, point.latitude, point.altitude);
}

}  // namespace

void write_tum_trajectory(const std::vector<FrameRecord>& frames, const std::filesystem::path& path,
                          bool force) {
  const std::vector<FrameRecord> posed = posed_frames(frames, path);
  for (const FrameRecord& frame : posed) {
    if (frame.stamp) continue;
    throw InputError(fmt::format("frame {} has no stamp, which TUM's format needs", frame.index),
                     path.string(), "export --format csv");
  }
  OutputFile file(path, force);
  for (const FrameRecord& frame : posed) {
    file.stream() << seconds_text(*frame.stamp) << ' ' << pose_text(frame.T_local_lidar, ' ')
                  << '\n';
  }
  file.commit();
}

void write_trajectory_table(const std::vector<FrameRecord>& frames,
                            const std::optional<GeodeticPoint>& origin,
                            const std::filesystem::path& path, bool force) {
  const std::vector<FrameRecord> posed = posed_frames(frames, path);
  std::optional<Georeference> utm;
  if (origin) utm.emplace(Crs::kUtm, origin, path.string());
  OutputFile file(path, force);
  file.stream() << "index,time_ns,status,x_m,y_m,z_m,qx,qy,qz,qw";
  file.stream() << (utm ? ",easting_m,northing_m,height_m,crs\n" : "\n");
  for (const FrameRecord& frame : posed) {
    file.stream() << frame.index << ',' << stamp_text(frame) << ',' << to_string(frame.status)
                  << ',' << pose_text(frame.T_local_lidar, ',');
    if (utm) {
      const Eigen::Vector3d p = utm->from_local(frame.T_local_lidar.translation());
      file.stream() << fmt::format(",{:.4f},{:.4f},{:.4f},\"{}\"", p.x(), p.y(), p.z(),
                                   utm->description());
    }
    file.stream() << '\n';
  }
  file.commit();
}

void write_geojson_trajectory(const std::vector<FrameRecord>& frames,
                              const std::optional<GeodeticPoint>& origin,
                              const std::filesystem::path& path, bool force) {
  if (!origin) {
    throw InputError("the map has no place on the earth, which GeoJSON needs", path.string(),
                     "map a drive with GPS/INS, or export --format csv");
  }
  const std::vector<FrameRecord> posed = posed_frames(frames, path);
  const LocalTangentPlane plane(*origin);
  std::string line, points;
  for (const FrameRecord& frame : posed) {
    const std::string at = point_text(plane.to_geodetic(frame.T_local_lidar.translation()));
    if (!line.empty()) line += ',';
    line += at;
    points += fmt::format(
        ",\n{{\"type\":\"Feature\",\"geometry\":{{\"type\":\"Point\",\"coordinates\":{}}},"
        "\"properties\":{{\"index\":{},\"time_ns\":{},\"status\":\"{}\"}}}}",
        at, frame.index, frame.stamp ? fmt::format("\"{}\"", *frame.stamp) : "null",
        to_string(frame.status));
  }
  // A line has two points or more.
  if (posed.size() == 1) line += "," + line;
  OutputFile file(path, force);
  file.stream() << "{\"type\":\"FeatureCollection\",\"features\":[\n"
                << "{\"type\":\"Feature\",\"geometry\":{\"type\":\"LineString\",\"coordinates\":["
                << line << "]},\"properties\":{\"frames\":" << posed.size() << "}}" << points
                << "\n]}\n";
  file.commit();
}

}  // namespace fovea
