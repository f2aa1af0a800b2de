// Data of sensors in any order, with any stamps and sizes. The first byte chooses options, then
// each record is a kind and 7 bytes of numbers.
#include "fovea/drive/live/live_source.h"

#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <variant>

#include "fuzz_input.h"

using namespace fovea;

namespace {

constexpr std::size_t kRecordSize = 8, kMaxRecords = 400;

constexpr const char* kDrive = R"(version = 1
[lidar]
[images]
[body]
T_body_lidar = [[1, 0, 0, 0.8], [0, 1, 0, -0.3], [0, 0, 1, 0.8]]
[imu]
T_lidar_imu = [[1, 0, 0, 0.1], [0, 1, 0, 0], [0, 0, 1, 0]]
[camera.front]
index = 0
width = 8
height = 8
K = [5, 0, 3.5, 0, 5, 3.5, 0, 0, 1]
T_cam_lidar = [[0, -1, 0, 0], [0, 0, -1, -0.1], [1, 0, 0, -0.3]]
)";

/// The numbers of a record.
class Record {
 public:
  explicit Record(const std::uint8_t* bytes) { std::memcpy(bytes_.data(), bytes, kRecordSize); }
  unsigned kind() const { return bytes_[0] % 8; }
  /// Near the other stamps, or anywhere.
  TimeNs stamp() const {
    if (bytes_[1] == 0xff) return std::bit_cast<std::int64_t>(bytes_);
    const auto ms = std::int64_t(bytes_[2]) * 256 + bytes_[3];
    return kStart + ms * (kNsPerSecond / 1000);
  }
  std::size_t size() const { return bytes_[4]; }
  /// Usual ones, or none that can be used.
  double number(unsigned which) const {
    const std::uint8_t byte = bytes_[5 + which % 3];
    if (byte == 0xff) return std::numeric_limits<double>::quiet_NaN();
    if (byte == 0xfe) return std::numeric_limits<double>::max();
    return (byte - 100.0) * (1 + which);
  }

 private:
  static constexpr TimeNs kStart = 1'700'000'000'000'000'000;
  std::array<std::uint8_t, kRecordSize> bytes_{};
};

LiveScan scan_of(const Record& record) {
  LiveScan scan{"", record.stamp(), {}};
  for (std::size_t i = 0; i < record.size(); ++i) {
    const double angle = 0.1 * double(i);
    scan.points.position.push_back(Eigen::Vector3d(record.number(0) * std::cos(angle),
                                                   10 * std::sin(angle), record.number(1) / 50)
                                       .cast<float>());
    if (record.number(2) > 0) scan.points.time.push_back(float(0.001 * double(i)));
  }
  if (record.number(2) > 50 && !scan.points.time.empty()) scan.points.time.pop_back();
  return scan;
}

LiveImage image_of(const Record& record) {
  LiveImage image{"front", record.stamp(), Image(8, 8, 3)};
  if (record.size() > 200) image.content = std::string(record.size(), 'x');
  if (record.size() > 100 && record.size() <= 200) image.content = Image(7, 6, 1);
  if (record.number(0) > 0) image.exposure = record.number(1);
  return image;
}

void send(LiveSource& source, const Record& record) {
  const Eigen::Vector3d vector(record.number(0), record.number(1), record.number(2));
  switch (record.kind()) {
    case 0:
      return source.add_image(image_of(record));
    case 1:
      return source.add_pose(
          {record.stamp(), {vector, Eigen::Quaterniond(record.number(2), 0, 0, 1)}});
    case 2: {
      RecordedPosition position;
      position.time = record.stamp();
      position.antenna = {vector.x(), vector.y(), vector.z()};
      position.accuracy = record.number(1);
      return source.add_position(position);
    }
    case 3:
      return source.add_inertia({record.stamp(), std::nullopt, vector, vector});
    case 4:
      return source.add_wheel_speed({record.stamp(), record.number(0)});
    default:  // most of them, or there is no drive
      return source.add_scan(scan_of(record));
  }
}

void read_all(LiveSource& source, std::size_t scans) {
  const auto first_frames = source.begin({});
  if (!first_frames) return;
  std::optional<TimeNs> last;
  int next = 0;
  while (const std::optional<LiveFrame> live = source.next({})) {
    if (const auto* skipped = std::get_if<SkippedFrame>(&live->frame)) {
      require(skipped->index == next++, "frames are counted");
      continue;
    }
    const Frame& frame = std::get<Frame>(live->frame);
    require(frame.index == next++, "frames are counted");
    require(!last || frame.stamp > *last, "stamps increase");
    last = frame.stamp;
    require(frame.images.size() == first_frames->info().calibration.cameras.size(),
            "each camera has a place");
    for (const Eigen::Vector3f& p : frame.scan.position) {
      require(p.allFinite(), "points are finite");
    }
  }
  require(std::size_t(next) <= scans, "a frame has a scan");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  LiveOptions options;
  options.max_wait = data[0] % 2;
  options.longest_beginning = data[0] / 2 % 2;
  options.expects_navigation = data[0] / 4 % 2 == 1;
  options.max_scans = 1 + data[0] / 8 % 4;
  options.first_scans = 1 + data[0] / 32;
  const std::size_t records = std::min((size - 1) / kRecordSize, kMaxRecords);
  read_or_refuse<Error>([&] {
    LiveSource source(kDrive, options);
    std::size_t scans = 0;
    for (std::size_t i = 0; i < records; ++i) {
      const Record record(data + 1 + i * kRecordSize);
      send(source, record);
      scans += record.kind() > 4;
    }
    source.close();
    read_all(source, scans);
    require(source.figures().scans <= scans, "scans are counted");
  });
  return 0;
}
