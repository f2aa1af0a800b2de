#include "fovea/drive/writers/drive_writer.h"

#include <fmt/format.h>

#include <array>
#include <stdexcept>

#include "fovea/drive.h"

namespace fovea {
namespace {

LensModel lens_model_of(const DriveCamera& camera) {
  constexpr std::array kModels = {LensModel::kNone, LensModel::kPlumbBob,
                                  LensModel::kRationalPolynomial, LensModel::kEquidistant};
  for (const LensModel model : kModels) {
    if (to_string(model) == camera.distortion_model) return model;
  }
  throw std::invalid_argument(
      fmt::format("camera '{}' has the distortion model '{}', not none, plumb_bob, "
                  "rational_polynomial or equidistant",
                  camera.name, camera.distortion_model));
}

RecordedCamera recorded_camera(const DriveCamera& camera) {
  const LensModel model = lens_model_of(camera);
  const auto coefficients = lens_coefficients(model, camera.distortion);
  if (!coefficients) {
    throw std::invalid_argument(
        fmt::format("camera '{}' has no coefficients of {}", camera.name, camera.distortion_model));
  }
  const LensCamera optics{camera.width,
                          camera.height,
                          camera.fx,
                          camera.fy,
                          camera.cx,
                          camera.cy,
                          Lens(model, *coefficients)};
  if (camera.width < 1 || camera.height < 1 || !optics.has_pinhole()) {
    throw std::invalid_argument(fmt::format(
        "camera '{}' has a size, focal lengths or a center that no camera has", camera.name));
  }
  return {camera.name, camera.number, optics, camera.T_lidar_cam};
}

std::vector<RecordedCamera> recorded_cameras(const std::vector<DriveCamera>& cameras) {
  std::vector<RecordedCamera> recorded;
  recorded.reserve(cameras.size());
  for (const DriveCamera& camera : cameras) recorded.push_back(recorded_camera(camera));
  return recorded;
}

}  // namespace

struct DriveWriter::Content {
  AdapterWriter writer;
};

DriveWriter::DriveWriter(const std::filesystem::path& folder,
                         const std::vector<DriveCamera>& cameras, const DriveWriterOptions& options)
    : content_(new Content{AdapterWriter(folder, recorded_cameras(cameras), options)}) {}
DriveWriter::~DriveWriter() = default;
DriveWriter::DriveWriter(DriveWriter&&) noexcept = default;

void DriveWriter::add(const DriveScan& scan, const std::vector<DriveImage>& images,
                      const std::optional<RigidMotion>& T_world_lidar) {
  content_->writer.add(scan, images, T_world_lidar);
}

void DriveWriter::add_scan(const std::string& lidar, const DriveScan& scan) {
  content_->writer.add_scan(lidar, scan);
}

WrittenDrive DriveWriter::close() {
  const DriveWriterFigures figures = content_->writer.close();
  return {figures.scans, figures.images, figures.poses, figures.dropped.total()};
}

}  // namespace fovea
