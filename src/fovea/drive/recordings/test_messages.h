// CDR messages of a vehicle with a LiDAR and a camera, for tests.
#pragma once

#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>

#include "../../../../tests/cdr_writer.h"

namespace fovea::test_messages {

inline constexpr int kSecond = 1'700'000'000;
inline constexpr std::uint32_t kStep = 100'000'000, kMiddle = kStep / 2;  // ns, of a sweep

/// @param spoiled  points without coordinates
inline std::string cloud(std::uint32_t nanosec, std::uint32_t points,
                         std::string_view frame = "lidar", float intensity = 0.5f,
                         std::uint32_t spoiled = 0) {
  CdrWriter message;
  message.header(kSecond, nanosec, frame).number(1u).number(points).number(5u);
  std::uint32_t offset = 0;
  for (const char* name : {"x", "y", "z", "intensity", "time"}) {
    message.text(name).number(offset).number(std::uint8_t{7}).number(1u);
    offset += 4;
  }
  std::string data;
  for (std::uint32_t i = 0; i < points; ++i) {
    const float time = 0.1f * float(i) / float(points - 1);
    const float x = i < spoiled ? std::nanf("") : float(i + 1);
    for (const float value : {x, 2.0f, 3.0f, intensity, time}) {
      data.append(reinterpret_cast<const char*>(&value), sizeof value);
    }
  }
  return message.number(std::uint8_t{0})
      .number(offset)
      .number(offset * points)
      .bytes(data)
      .number(std::uint8_t{1})
      .message();
}

inline std::string grey_image(std::uint32_t nanosec, std::uint32_t width = 16) {
  return CdrWriter()
      .header(kSecond, nanosec, "front")
      .number(8u)
      .number(width)
      .text("mono8")
      .number(std::uint8_t{0})
      .number(width)
      .bytes(std::string(8 * width, 'g'))
      .message();
}

inline std::string compressed_image(std::uint32_t nanosec, std::string_view format,
                                    std::string_view bytes) {
  return CdrWriter().header(kSecond, nanosec, "front").text(format).bytes(bytes).message();
}

inline std::string camera_info() {
  CdrWriter message;
  message.header(kSecond, 0, "front").number(8u).number(16u).text("plumb_bob").number(0u);
  for (const double k : {20.0, 0.0, 7.5, 0.0, 20.0, 3.5, 0.0, 0.0, 1.0}) message.number(k);
  message.doubles(9).doubles(12);
  for (int i = 0; i < 6; ++i) message.number(0u);
  return message.number(std::uint8_t{0}).message();
}

inline std::string transforms() {
  const QuaternionMotion T(exp_se3((Twist() << 0.1, 0.2, 0.3, 1, 2, 3).finished()));
  return CdrWriter()
      .number(2u)
      .header(kSecond, 0, "base_link")
      .text("lidar")
      .motion({})
      .header(kSecond, 0, "lidar")
      .text("front")
      .motion(T)
      .message();
}

}  // namespace fovea::test_messages
