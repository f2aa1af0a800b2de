#include "fovea/drive/recordings/message_reader.h"

#include <gtest/gtest.h>

#include "../../../../tests/cdr_writer.h"
#include "fovea/drive/recordings/bag_sink.h"
#include "fovea/drive/recordings/ros_messages.h"
#include "fovea/errors.h"

namespace fovea::message_reader_test {

TEST(MessageReader, ReadsNumbersTextsAndSequencesOfEitherByteOrder) {
  for (const bool big_endian : {false, true}) {
    const std::string message = CdrWriter(big_endian)
                                    .number(std::uint8_t{7})
                                    .number(0.1)  // aligned to 8
                                    .text("abc")
                                    .number(std::uint16_t{513})
                                    .bytes("xyzuv")
                                    .number(std::int32_t{-5})
                                    .number(1.5f)
                                    .message();
    MessageReader reader(message, kCdrEncoding, "m");
    EXPECT_EQ(reader.number<std::uint8_t>(), 7);
    EXPECT_EQ(reader.number<double>(), 0.1);
    EXPECT_EQ(reader.text(), "abc");
    EXPECT_EQ(reader.number<std::uint16_t>(), 513);
    EXPECT_EQ(reader.bytes(), "xyzuv");
    EXPECT_EQ(reader.number<std::int32_t>(), -5);
    EXPECT_EQ(reader.number<float>(), 1.5f);
    EXPECT_THROW(reader.number<std::uint8_t>(), InputError);
  }
}

TEST(MessageReader, BytesAreThoseOfTheStandard) {
  // Little endian; a byte, three of padding, a 32-bit number, a text with its length and end.
  const std::string message("\0\1\0\0\x09\0\0\0\x78\x56\x34\x12\3\0\0\0hi\0", 4 + 4 + 4 + 4 + 3);
  MessageReader reader(message, kCdrEncoding, "m");
  EXPECT_EQ(reader.number<std::uint8_t>(), 9);
  EXPECT_EQ(reader.number<std::uint32_t>(), 0x12345678u);
  EXPECT_EQ(reader.text(), "hi");
}

TEST(MessageReader, RefusesWhatEndsEarlyOrIsNoPlainCdr) {
  const std::string whole = CdrWriter().text("frame").bytes("0123456789").message();
  for (std::size_t size = 0; size < whole.size(); ++size) {
    EXPECT_THROW(
        {
          MessageReader reader(std::string_view(whole).substr(0, size), kCdrEncoding, "/topic");
          reader.text();
          reader.bytes();
        },
        InputError)
        << size;
  }
  EXPECT_THROW(MessageReader(std::string("\0\3\0\0abcd", 8), kCdrEncoding, "m"),
               InputError);  // parameter list
  const std::string endless = CdrWriter().number(std::uint32_t{0xffffffff}).message();
  MessageReader huge(endless, kCdrEncoding, "m");
  EXPECT_THROW(huge.count(8), InputError);
}

TEST(MessageReader, Ros1HasNoGapsAndNoEncapsulation) {
  // A byte, a number, a text without an end, and the header: sequence number, time, frame.
  const std::string message("\x09\x78\x56\x34\x12\2\0\0\0hi\7\0\0\0\5\0\0\0\6\0\0\0\3\0\0\0/ab",
                            1 + 4 + 6 + 12 + 7);
  MessageReader reader(message, kRos1Encoding, "m");
  EXPECT_EQ(reader.number<std::uint8_t>(), 9);
  EXPECT_EQ(reader.number<std::uint32_t>(), 0x12345678u);
  EXPECT_EQ(reader.text(), "hi");
  const ros::Header header = ros::read_header(reader);
  EXPECT_EQ(header.stamp, 5'000'000'006);
  EXPECT_EQ(header.frame, "ab");
  EXPECT_THROW(reader.number<std::uint8_t>(), InputError);
}

TEST(RosMessages, EachFieldIsWhereItsInterfaceHasIt) {
  const std::string info = CdrWriter()
                               .header(5, 6, "/front")
                               .number(std::uint32_t{480})
                               .number(std::uint32_t{640})
                               .text("plumb_bob")
                               .number(std::uint32_t{2})
                               .doubles(2, 0.25)
                               .doubles(9, 1)
                               .doubles(9, 2)
                               .doubles(12, 3)
                               .number(std::uint32_t{1})
                               .number(std::uint32_t{2})
                               .number(std::uint32_t{3})
                               .number(std::uint32_t{4})
                               .number(std::uint32_t{5})
                               .number(std::uint32_t{6})
                               .number(std::uint8_t{0})
                               .message();
  MessageReader reader(info, kCdrEncoding, "m");
  const ros::CameraInfo camera = ros::read_camera_info(reader);
  EXPECT_EQ(camera.header.stamp, 5'000'000'006);
  EXPECT_EQ(camera.header.frame, "front");
  EXPECT_EQ(camera.height, 480u);
  EXPECT_EQ(camera.width, 640u);
  EXPECT_EQ(camera.d, (std::vector<double>{0.25, 0.25}));
  EXPECT_EQ(camera.k[8], 1);
  EXPECT_EQ(camera.r[8], 2);
  EXPECT_EQ(camera.p[11], 3);
  EXPECT_EQ(camera.binning_y, 2u);
  EXPECT_EQ(camera.roi_x, 3u);
  EXPECT_EQ(camera.roi_width, 6u);

  const auto imu = [](double first_covariance, double w) {
    const std::string body = CdrWriter()
                                 .header(1, 0, "imu")
                                 .doubles(3, 0)
                                 .number(w)
                                 .number(first_covariance)
                                 .doubles(8)
                                 .doubles(3, 0.5)
                                 .doubles(9)
                                 .doubles(3, 9.8)
                                 .doubles(9)
                                 .message();
    MessageReader reader_of_imu(body, kCdrEncoding, "m");
    return ros::read_imu(reader_of_imu);
  };
  EXPECT_EQ(imu(0.1, 1).orientation->w(), 1);
  EXPECT_EQ(imu(0.1, 1).angular_velocity, Eigen::Vector3d::Constant(0.5));
  EXPECT_EQ(imu(0.1, 1).acceleration, Eigen::Vector3d::Constant(9.8));
  EXPECT_FALSE(imu(-1, 1).orientation);   // as the interface says "not known"
  EXPECT_FALSE(imu(0.1, 0).orientation);  // as many drivers do
}

}  // namespace fovea::message_reader_test
