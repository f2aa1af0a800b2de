// Messages of ROS, and the scans, images and cameras in them. The first byte gives the type, and
// its highest bit the encoding.
#include "fovea/drive/recordings/ros_messages.h"

#include <array>
#include <vector>

#include "fovea/drive/recordings/bag_sink.h"
#include "fovea/drive/recordings/camera_topics.h"
#include "fovea/drive/recordings/pixels.h"
#include "fovea/drive/recordings/scan_message.h"
#include "fovea/drive/scans/lidar_scan.h"
#include "fovea/drive/scans/recognized_format.h"
#include "fuzz_input.h"

using namespace fovea;

namespace {

void read_scan(std::string_view type, MessageReader& message) {
  const ScanMessage scan_message(type, message);
  const TimeNs stamp = scan_message.header().stamp;
  ScanNumberRows numbers(stamp);
  scan_message.read("t", numbers);
  ScanFormat format;
  try {
    format = recognize_format(std::vector{numbers.take()}, {}).format;
  } catch (const ConfigError&) {
    format.time_reference = TimeReference::kNone;
  }
  ScanRows rows(format, stamp);
  scan_message.read("t", rows);
  const LidarScan scan = rows.take("t");
  scan.points.check();
  require(!scan.points.empty(), "a scan has points");
}

void read_pixels(MessageReader& message) {
  const Image image = image_of(ros::read_image(message), "t");
  require(image.width > 0 && image.height > 0, "an image has pixels");
}

void read_optics(MessageReader& message) {
  const ros::CameraInfo info = ros::read_camera_info(message);
  for (const bool rectified : {false, true}) {
    read_or_refuse([&] {
      const LensCamera optics = optics_of(info, rectified, "t");
      require(optics.fx >= 1 && optics.width >= 8, "a camera takes pictures");
    });
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using Reader = void (*)(MessageReader&);
  constexpr std::array<Reader, 10> kReaders = {
      [](MessageReader& message) { read_scan(ros::kPointCloud, message); },
      read_pixels,
      read_optics,
      [](MessageReader& message) { ros::read_compressed_image(message); },
      [](MessageReader& message) { ros::read_nav_sat_fix(message); },
      [](MessageReader& message) { ros::read_imu(message); },
      [](MessageReader& message) { ros::read_odometry(message); },
      [](MessageReader& message) { ros::read_transforms(message); },
      [](MessageReader& message) { read_scan(ros::kLivox, message); },
      [](MessageReader& message) { read_scan(ros::kVelodyneScan, message); },
  };
  if (size == 0) return 0;
  read_or_refuse([&] {
    const std::string_view encoding = data[0] < 0x80 ? kCdrEncoding : kRos1Encoding;
    MessageReader message(as_text(data + 1, size - 1), encoding, "t");
    kReaders[(data[0] & 0x7f) % kReaders.size()](message);
  });
  return 0;
}
