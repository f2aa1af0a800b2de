#include "fovea/drive/writers/drive_writer.h"

#include <fmt/format.h>

#include <set>
#include <stdexcept>

#include "fovea/core/file_format.h"
#include "fovea/core/input_file.h"
#include "fovea/core/plain_name.h"
#include "fovea/drive/scans/lidar_scan.h"
#include "fovea/drive/writers/png_encode.h"
#include "fovea/errors.h"
#include "fovea/geometry/pose_file.h"

namespace fovea {
namespace {

template <class... Arguments>
void require(bool condition, fmt::format_string<const Arguments&...> text,
             const Arguments&... arguments) {
  if (!condition) throw std::invalid_argument(fmt::format(text, arguments...));
}

/// The points that can be used.
LidarScan usable_points(const PointCloud& points) {
  const std::size_t size = points.size();
  require(points.intensity.empty() || points.intensity.size() == size,
          "a scan has {} points and {} intensities", size, points.intensity.size());
  require(points.time.empty() || points.time.size() == size, "a scan has {} points and {} times",
          size, points.time.size());
  require(points.ring.empty() || points.ring.size() == size, "a scan has {} points and {} rings",
          size, points.ring.size());
  ScanBuilder builder(size, !points.time.empty());
  for (std::size_t i = 0; i < size; ++i) {
    const bool is_usable =
        builder.add(points.position[i], points.intensity.empty() ? 0 : points.intensity[i],
                    points.time.empty() ? 0 : double(points.time[i]));
    if (is_usable && !points.ring.empty()) builder.add_ring(points.ring[i]);
  }
  return builder.take("scan");
}

RigidMotion checked_pose_at(TimeNs stamp, const RigidMotion& T_world_lidar) {
  try {
    return checked_pose(T_world_lidar.matrix().topRows<3>());
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(
        fmt::format("T_world_lidar of the scan at {} ns: {}", stamp, error.what()));
  }
}

}  // namespace

AdapterWriter::AdapterWriter(const std::filesystem::path& root, std::vector<RecordedCamera> cameras,
                             const DriveWriterOptions& options)
    : writer_(root, options.force), allow_dropped_(options.allow_dropped) {
  drive_.lidar.sweep_compensated = options.sweep_compensated;
  drive_.lidar.sweep = options.sweep;
  std::set<int> numbers;
  for (const RecordedCamera& camera : cameras) {
    require(is_plain_name(camera.name), "'{}' is no name of a camera", camera.name);
    require(camera.index >= 0 && camera.index <= 9, "camera '{}' has the number {}, not 0 to 9",
            camera.name, camera.index);
    require(numbers.insert(camera.index).second, "two cameras have the number {}", camera.index);
    require(cameras_.try_emplace(camera.name, CameraState{camera, {}}).second,
            "two cameras have the name '{}'", camera.name);
  }
  drive_.cameras = std::move(cameras);
  if (!options.further_lidars.empty()) drive_.lidar.name = options.first_lidar;
  lidars_[drive_.lidar.name];
  require(options.further_lidars.size() < kMaxLidars, "there are {} further LiDARs, over {}",
          options.further_lidars.size(), kMaxLidars - 1);
  for (const auto& [name, T_lidar_sensor] : options.further_lidars) {
    require(is_plain_name(name) && is_plain_name(drive_.lidar.name), "'{}' is no name of a LiDAR",
            name);
    require(lidars_.try_emplace(name).second, "two LiDARs have the name '{}'", name);
    RecordedLidar& lidar = drive_.further_lidars.emplace_back(drive_.lidar);
    lidar.name = name;
    lidar.T_lidar_sensor = checked_pose(T_lidar_sensor.matrix().topRows<3>());
  }
}

void AdapterWriter::add(const DriveScan& scan, const std::vector<DriveImage>& images,
                        const std::optional<RigidMotion>& T_world_lidar) {
  require(!is_closed_, "the drive is closed");
  std::map<std::string, TimeNs> last;
  std::vector<EncodedImage> files;
  for (const DriveImage& image : images) {
    check_image(image, last);
    files.push_back(encoded(image));
  }
  std::optional<RigidMotion> pose;
  if (T_world_lidar) pose = checked_pose_at(scan.stamp, *T_world_lidar);
  write_scan(drive_.lidar.name, lidars_.at(drive_.lidar.name), scan);
  for (std::size_t i = 0; i < images.size(); ++i) write_image(images[i], files[i]);
  if (pose) drive_.poses.push_back({scan.stamp, *pose});
}

void AdapterWriter::add_scan(const std::string& lidar, const DriveScan& scan) {
  require(!is_closed_, "the drive is closed");
  const auto found = lidars_.find(lidar);
  require(found != lidars_.end() && lidar != drive_.lidar.name,
          "the drive has no further LiDAR '{}'", lidar);
  write_scan(lidar, found->second, scan);
}

AdapterWriter::CameraState& AdapterWriter::find_camera(const std::string& name) {
  const auto found = cameras_.find(name);
  require(found != cameras_.end(), "the drive has no camera '{}'", name);
  return found->second;
}

void AdapterWriter::check_image(const DriveImage& image, std::map<std::string, TimeNs>& last) {
  const CameraState& state = find_camera(image.camera);
  if (state.last) last.try_emplace(image.camera, *state.last);
  const auto before = last.find(image.camera);
  require(before == last.end() || image.stamp > before->second,
          "the image of '{}' at {} ns is not after the one before", image.camera, image.stamp);
  last[image.camera] = image.stamp;
}

AdapterWriter::EncodedImage AdapterWriter::encoded(const DriveImage& image) {
  const auto require_size = [&](const Image& pixels) {
    const LensCamera& optics = find_camera(image.camera).camera.optics;
    require(pixels.width == optics.width && pixels.height == optics.height,
            "an image of '{}' has {} x {} pixels, not {} x {}", image.camera, pixels.width,
            pixels.height, optics.width, optics.height);
  };
  if (const auto* pixels = std::get_if<Image>(&image.content)) {
    require_size(*pixels);
    return {encode_png(*pixels), ".png"};
  }
  const auto& path = std::get<std::filesystem::path>(image.content);
  std::vector<std::uint8_t> bytes = InputFile(path, kImageFile).bytes();
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  const FileFormat format = sniff_format(text).format;
  if (format != FileFormat::kPng && format != FileFormat::kJpeg) {
    throw InputError("this is no PNG or JPEG image", path.string(), "convert it to PNG");
  }
  require_size(decode_image(bytes, path.string()));
  return {std::move(bytes), format == FileFormat::kPng ? ".png" : ".jpg"};
}

void AdapterWriter::require_usable(const LidarState& lidar, const DriveScan& scan,
                                   const LidarScan& usable) const {
  DroppedPoints dropped = lidar.dropped;
  dropped += usable.dropped;
  const std::size_t kept = lidar.kept + usable.points.size();
  if (allow_dropped_ || !are_too_many(dropped, kept)) return;
  throw InputError(
      fmt::format("{} of {} points so far cannot be used: {}", dropped.faulty(),
                  kept + dropped.faulty(), reasons_of(dropped)),
      fmt::format("the scan at {} ns", scan.stamp),
      "give points in m and times in s from the stamp, leave out what was not measured, "
      "or set allow_dropped");
}

void AdapterWriter::write_scan(const std::string& name, LidarState& lidar, const DriveScan& scan) {
  require(!lidar.last || scan.stamp > *lidar.last,
          "the scan at {} ns is not after the one at {} ns", scan.stamp, lidar.last.value_or(0));
  const LidarScan usable = usable_points(scan.points);
  require_usable(lidar, scan, usable);
  writer_.write_scan(lidar.scans++, scan.stamp, usable.points, ScanFile::kPcd, name);
  ++figures_.scans;
  figures_.dropped += usable.dropped;
  lidar.dropped += usable.dropped;
  lidar.kept += usable.points.size();
  lidar.scale.add(usable.points.intensity);
  lidar.last = scan.stamp;
}

void AdapterWriter::write_image(const DriveImage& image, const EncodedImage& file) {
  CameraState& state = find_camera(image.camera);
  const std::string_view bytes(reinterpret_cast<const char*>(file.bytes.data()), file.bytes.size());
  writer_.write_encoded_image(image.camera, state.images, image.stamp, bytes, file.extension);
  ++state.images;
  ++figures_.images;
  state.last = image.stamp;
}

DriveWriterFigures AdapterWriter::close() {
  if (is_closed_) throw std::logic_error("the drive is closed already");
  if (scans() == 0) throw std::logic_error("the drive has no scan");
  is_closed_ = true;
  drive_.lidar.intensity_max = lidars_.at(drive_.lidar.name).scale.max();
  for (RecordedLidar& lidar : drive_.further_lidars) {
    lidar.intensity_max = lidars_.at(lidar.name).scale.max();
  }
  figures_.poses = drive_.poses.size();
  // As a camera without images, a LiDAR without scans is not part of the drive.
  std::erase_if(drive_.further_lidars,
                [&](const RecordedLidar& lidar) { return lidars_.at(lidar.name).scans == 0; });
  writer_.finish(drive_);
  return figures_;
}

}  // namespace fovea
