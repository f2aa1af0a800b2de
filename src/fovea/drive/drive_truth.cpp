#include "fovea/drive/drive_truth.h"

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>
#include <utility>

#include "fovea/core/nesting.h"
#include "fovea/core/read_file.h"
#include "fovea/drive/calibrated_drive.h"
#include "fovea/errors.h"
#include "fovea/geometry/pose_file.h"

namespace fovea {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

static_assert(std::endian::native == std::endian::little, "the files are little endian");

constexpr int kVersion = 1;
constexpr std::size_t kReturnBytes = 28;
constexpr const char* kRemedy = "write the drive anew with 'fovea simulate'";

/// The library converts what it finds, and 1e300 to no int that there is.
template <class Int>
Int whole_number(const Json& json, const fs::path& file) {
  if (json.is_number_unsigned() && std::in_range<Int>(json.get<std::uint64_t>())) {
    return static_cast<Int>(json.get<std::uint64_t>());
  }
  if (json.is_number_integer() && !json.is_number_unsigned() &&
      std::in_range<Int>(json.get<std::int64_t>())) {
    return static_cast<Int>(json.get<std::int64_t>());
  }
  throw InputError("the truth's description is damaged (a whole number is none)", file.string(),
                   kRemedy);
}

std::string file_stem(int frame) { return fmt::format("{:010d}", frame); }

fs::path camera_folder(const fs::path& truth, int camera) {
  return truth / fmt::format("image_{:02d}", camera);
}

/// Offsets in a record as docs/simulator.md gives them.
TrueReturn decode_return(const std::uint8_t* record) {
  TrueReturn decoded;
  std::memcpy(decoded.hit_lidar.data(), record, 12);
  std::memcpy(&decoded.time, record + 12, 4);
  std::memcpy(&decoded.surface, record + 16, 4);
  decoded.albedo = {record[20], record[21], record[22]};
  decoded.ring = record[23];
  decoded.moving = record[24] != 0;
  return decoded;
}

std::vector<double> read_exposures(const fs::path& file) {
  std::vector<double> exposures;
  const std::vector<std::string> lines = read_lines(file);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const std::optional<std::vector<double>> numbers = parse_numbers(lines[i]);
    if (!numbers || numbers->size() != 1 || !(numbers->front() > 0) ||
        !std::isfinite(numbers->front())) {
      throw InputError("an exposure is not one positive number",
                       fmt::format("{}:{}", file.string(), i + 1), kRemedy);
    }
    exposures.push_back(numbers->front());
  }
  return exposures;
}

}  // namespace

DriveTruth::DriveTruth(const fs::path& drive) : folder_(recorded_folder(drive) / "truth") {
  std::error_code unreadable;
  if (!fs::is_directory(folder_, unreadable)) {
    throw InputError("the drive has no truth", folder_.string(),
                     "give a drive that 'fovea simulate' wrote, or choose another protocol");
  }
  read_description();
  const fs::path poses = folder_ / "poses.txt";
  T_local_lidar_ = read_poses(poses);
  require_frames(T_local_lidar_.size(), poses);
  for (const int number : camera_numbers_) read_camera(number);
}

void DriveTruth::read_description() {
  const fs::path file = folder_ / "truth.json";
  const std::vector<std::uint8_t> bytes = read_bytes(file, kDescriptionFile);
  if (nesting_depth({reinterpret_cast<const char*>(bytes.data()), bytes.size()}) > kMaxNesting) {
    throw InputError("the truth's description is nested too deep", file.string(), kRemedy);
  }
  try {
    const Json json = Json::parse(bytes);
    const int version = whole_number<int>(json.at("version"), file);
    if (version != kVersion) {
      throw InputError(
          fmt::format("the truth has format version {}, this program reads {}", version, kVersion),
          file.string(), version > kVersion ? "use a newer Fovea" : kRemedy);
    }
    scene_ = json.at("scene").get<std::string>();
    described_frames_ = whole_number<std::size_t>(json.at("frames"), file);
    for (const Json& number : json.at("cameras")) {
      camera_numbers_.push_back(whole_number<int>(number, file));
    }
    sweep_period_ = json.at("sweep_period").get<double>();
    const Json& origin = json.at("origin");
    origin_ = {origin.at("latitude").get<double>(), origin.at("longitude").get<double>(),
               origin.at("altitude").get<double>()};
  } catch (const Json::exception& error) {
    throw InputError(fmt::format("the truth's description is damaged ({})", error.what()),
                     file.string(), kRemedy);
  }
}

void DriveTruth::read_camera(int number) {
  const fs::path folder = camera_folder(folder_, number);
  TrueCamera camera;
  camera.T_local_cam = read_poses(folder / "poses.txt");
  require_frames(camera.T_local_cam.size(), folder / "poses.txt");
  camera.exposure = read_exposures(folder / "exposure.txt");
  require_frames(camera.exposure.size(), folder / "exposure.txt");
  cameras_[number] = std::move(camera);
}

void DriveTruth::require_frames(std::size_t found, const fs::path& file) const {
  if (found == described_frames_) return;
  throw InputError(fmt::format("{} lines for {} frames", found, described_frames_), file.string(),
                   kRemedy);
}

const TrueCamera& DriveTruth::camera(int number) const {
  const auto found = cameras_.find(number);
  if (found != cameras_.end()) return found->second;
  throw InputError(fmt::format("there is no truth of camera {}", number), folder_.string(),
                   "use cameras of the simulated drive (--cameras)");
}

std::vector<TrueReturn> DriveTruth::returns(int frame) const {
  const fs::path file = folder_ / "velodyne_points" / (file_stem(frame) + ".bin");
  const std::vector<std::uint8_t> bytes = read_bytes(file);
  if (bytes.size() % kReturnBytes != 0) {
    throw InputError(fmt::format("the true scan has {} bytes, no multiple of the {} of a return",
                                 bytes.size(), kReturnBytes),
                     file.string(), kRemedy);
  }
  std::vector<TrueReturn> returns;
  returns.reserve(bytes.size() / kReturnBytes);
  for (std::size_t at = 0; at < bytes.size(); at += kReturnBytes) {
    returns.push_back(decode_return(bytes.data() + at));
    if (returns.back().hit_lidar.allFinite()) continue;
    throw InputError(fmt::format("true return {} is not finite", returns.size() - 1), file.string(),
                     kRemedy);
  }
  return returns;
}

Image DriveTruth::perfect_image(int camera, int frame) const {
  return read_image(camera_folder(folder_, camera) / "perfect" / (file_stem(frame) + ".png"));
}

DepthImage DriveTruth::depth(int camera, int frame) const {
  return read_depth_image(camera_folder(folder_, camera) / "depth" / (file_stem(frame) + ".png"));
}

}  // namespace fovea
