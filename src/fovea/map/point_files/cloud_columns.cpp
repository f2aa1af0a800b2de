#include "fovea/map/point_files/cloud_columns.h"

#include "fovea/errors.h"

namespace fovea {
namespace {

/// No drive reaches farther; what does is damaged, or in another frame than the poses (say, UTM).
constexpr float kMaxDistance = 50e3f;  // m

}  // namespace

CloudBuilder::CloudBuilder(const std::filesystem::path& file, const Eigen::Vector3d& origin)
    : name_(file.string()) {
  cloud_.points.origin = origin;
}

void CloudBuilder::expect(std::size_t points, const std::array<bool, kCloudColumns>& columns) {
  if (points > std::numeric_limits<std::uint32_t>::max()) {
    throw InputError("the cloud has more points than can be scored", name_,
                     "split it, at most 4294967295 points a file");
  }
  has_ = columns;
  cloud_.has_camera = has_[kCamera];
  cloud_.points.position.reserve(points);
  cloud_.points.color.reserve(points);
  cloud_.points.camera.reserve(points);
  if (has_[kFrame]) cloud_.points.frame.reserve(points);
  if (has_[kInterpolated]) cloud_.points.interpolated.reserve(points);
}

void CloudBuilder::add(const CloudRow& row, std::size_t number) {
  const auto refuse = [&](const char* what) {
    throw InputError(what, name_ + ", point " + std::to_string(number), "write the file anew");
  };
  PointCloud& points = cloud_.points;
  const Eigen::Vector3d p(row[kX], row[kY], row[kZ]);
  const Eigen::Vector3f position = (p - points.origin).cast<float>();
  if (!p.allFinite()) refuse("a coordinate is not finite");
  if (!(position.cwiseAbs().maxCoeff() < kMaxDistance)) {
    throw InputError("a point lies over 50 km off the poses",
                     name_ + ", point " + std::to_string(number),
                     "give the cloud in the local frame of its poses, in metres");
  }
  for (const CloudColumn channel : {kRed, kGreen, kBlue}) {
    if (!(row[channel] >= 0 && row[channel] <= 255)) refuse("a colour is not in 0-255");
  }
  const double camera = !has_[kRed] ? kNoCamera : row[kCamera];
  if (!(camera >= kNoCamera && camera <= 127)) refuse("a camera number is out of range");
  const double frame = row[kFrame];
  if (!(std::abs(frame) < 2e9)) refuse("a frame number is out of range");
  points.position.push_back(position);
  points.camera.push_back(static_cast<std::int8_t>(camera));
  points.color.push_back({static_cast<std::uint8_t>(row[kRed]),
                          static_cast<std::uint8_t>(row[kGreen]),
                          static_cast<std::uint8_t>(row[kBlue])});
  if (has_[kFrame]) points.frame.push_back(static_cast<std::int32_t>(frame));
  if (has_[kInterpolated]) points.interpolated.push_back(row[kInterpolated] != 0);
}

}  // namespace fovea
