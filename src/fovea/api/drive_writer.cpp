#include "fovea/api/recorded_camera.h"

namespace fovea {
namespace {

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
