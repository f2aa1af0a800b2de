#include "fovea/evaluation/cloud_columns.h"

#include <cstring>

#include "fovea/base/errors.h"

namespace fovea {
namespace {

constexpr std::size_t kMaxLine = 1 << 16;
/// No drive reaches farther; what does is damaged, or in another frame than the poses (say, UTM).
constexpr float kMaxDistance = 50e3f;  // m

template <class T>
double read_as(const char* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof value);  // little endian, like every machine this is built for
  return static_cast<double>(value);
}

}  // namespace

std::size_t size_of(Scalar type) {
  switch (type) {
    case Scalar::kInt8:
    case Scalar::kUint8:
      return 1;
    case Scalar::kInt16:
    case Scalar::kUint16:
      return 2;
    case Scalar::kInt32:
    case Scalar::kUint32:
    case Scalar::kFloat:
      return 4;
    case Scalar::kInt64:
    case Scalar::kUint64:
    case Scalar::kDouble:
      return 8;
  }
  return 0;
}

double decode(Scalar type, const char* bytes) {
  switch (type) {
    case Scalar::kInt8:
      return read_as<std::int8_t>(bytes);
    case Scalar::kUint8:
      return read_as<std::uint8_t>(bytes);
    case Scalar::kInt16:
      return read_as<std::int16_t>(bytes);
    case Scalar::kUint16:
      return read_as<std::uint16_t>(bytes);
    case Scalar::kInt32:
      return read_as<std::int32_t>(bytes);
    case Scalar::kUint32:
      return read_as<std::uint32_t>(bytes);
    case Scalar::kInt64:
      return read_as<std::int64_t>(bytes);
    case Scalar::kUint64:
      return read_as<std::uint64_t>(bytes);
    case Scalar::kFloat:
      return read_as<float>(bytes);
    case Scalar::kDouble:
      return read_as<double>(bytes);
  }
  return 0;
}

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

LineReader::LineReader(const std::filesystem::path& file)
    : name_(file.string()), stream_(file, std::ios::binary), buffer_(kMaxLine, '\0') {
  std::error_code error;
  size_ = std::filesystem::file_size(file, error);
  if (!stream_ || error) throw InputError("the file cannot be read", name_, "check the path");
}

std::optional<std::string> LineReader::next() {
  stream_.getline(buffer_.data(), static_cast<std::streamsize>(buffer_.size()));
  const auto count = static_cast<std::size_t>(stream_.gcount());
  if (count == 0 && !stream_) return std::nullopt;
  ++line_number_;
  if (stream_.fail()) {
    throw InputError("a line is longer than 64 KiB", name_ + ":" + std::to_string(line_number_),
                     "write the file anew");
  }
  // The line end counts among the characters read, but the end of the file does not.
  std::string line(buffer_.data(), stream_.eof() ? count : count - 1);
  if (!line.empty() && line.back() == '\r') line.pop_back();
  return line;
}

std::uintmax_t LineReader::rest() {
  if (stream_.eof()) return 0;
  const std::streamoff at = stream_.tellg();
  return at < 0 ? 0 : size_ - std::min(size_, static_cast<std::uintmax_t>(at));
}

}  // namespace fovea
