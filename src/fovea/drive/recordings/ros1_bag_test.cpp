#include "fovea/drive/recordings/ros1_bag.h"

#include <bzlib.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <vector>

#include "../../../../tests/lz4_frame.h"
#include "../../../../tests/ros1_bag_writer.h"
#include "../../../../tests/temporary_folder.h"
#include "fovea/drive/recordings/bag.h"
#include "fovea/drive/recordings/decompress.h"
#include "fovea/errors.h"

namespace fovea::ros1_bag_test {

using namespace ros1;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

std::string bz2(const std::string& bytes) {
  std::string packed(bytes.size() + bytes.size() / 100 + 600, '\0');
  auto size = unsigned(packed.size());
  std::string source = bytes;
  BZ2_bzBuffToBuffCompress(packed.data(), &size, source.data(), unsigned(source.size()), 9, 0, 0);
  packed.resize(size);
  return packed;
}
/// Notes "TOPIC:MESSAGE" of all topics but /other.
class Listener : public BagSink {
 public:
  bool is_requested(const BagTopic& topic) override {
    topics.push_back(topic);
    return topic.name != "/other";
  }
  void add(const BagTopic& topic, std::string_view bytes) override {
    messages.push_back(topic.name + ":" + std::string(bytes));
  }
  void skip(const BagTopic& topic) override { messages.push_back(topic.name); }
  void report_loss(const std::string& problem) override { losses.push_back(problem); }

  std::vector<std::string> messages, losses;
  std::vector<BagTopic> topics;
};

class Ros1Bag : public testing::Test {
 protected:
  Listener read(const std::string& bytes) {
    std::ofstream(folder_ / "a.bag", std::ios::binary) << bytes;
    Listener listener;
    read_bag_file(folder_ / "a.bag", folder_ / "", listener);
    return listener;
  }
  std::string error_of(const std::string& bytes) {
    try {
      read(bytes);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }

  TemporaryFolder folder_;
};

const std::string kRecords = connection(0, "/a", "sensor_msgs/Imu") + connection(1, "/other") +
                             message(0, "one") + message(1, "x") + message(0, "two");

TEST_F(Ros1Bag, ReadsRecordsWithAndWithoutChunks) {
  for (const std::string& content :
       {kRecords, chunk(kRecords, "none", kRecords), chunk(kRecords, "bz2", bz2(kRecords)),
        chunk(kRecords, "lz4", lz4(kRecords))}) {
    // Behind the chunks stands the index, which announces the connections again.
    const Listener read_ones =
        read(file_of(content + record({{"op", "\x04"}, {"conn", number(0u)}}, "index") +
                     connection(0, "/a", "sensor_msgs/Imu")));
    EXPECT_THAT(read_ones.messages, ElementsAre("/a:one", "/other", "/a:two"));
    EXPECT_THAT(read_ones.losses, IsEmpty());
    ASSERT_EQ(read_ones.topics.size(), 2u);
    EXPECT_EQ(read_ones.topics[0].type, "sensor_msgs/msg/Imu");
    EXPECT_EQ(read_ones.topics[0].encoding, kRos1Encoding);
  }
}

TEST_F(Ros1Bag, TypesHaveTheirNamesInRos2) {
  EXPECT_EQ(ros2_type("sensor_msgs/PointCloud2"), "sensor_msgs/msg/PointCloud2");
  EXPECT_EQ(ros2_type("sensor_msgs/msg/PointCloud2"), "sensor_msgs/msg/PointCloud2");
  EXPECT_EQ(ros2_type("tf/tfMessage"), "tf2_msgs/msg/TFMessage");
  EXPECT_EQ(ros2_type(""), "");
}

// Wherever a file ends, the messages before are read, and the loss is reported.
TEST_F(Ros1Bag, AFileCutShortIsReadUpToItsEnd) {
  const std::string second = connection(2, "/b") + message(2, "three");
  for (const auto& [compression, stored] :
       {std::pair{"none", second}, std::pair{"bz2", bz2(second)}, std::pair{"lz4", lz4(second)}}) {
    const std::string first = file_of(chunk(kRecords, "lz4", lz4(kRecords)));
    const std::string whole = first + chunk(second, compression, stored);
    for (std::size_t size = first.size() + 1; size < whole.size(); ++size) {
      const Listener cut = read(whole.substr(0, size));
      ASSERT_GE(cut.messages.size(), 3u) << compression << size;
      ASSERT_THAT(cut.losses, ElementsAre(HasSubstr("cut short"))) << compression << size;
    }
    EXPECT_THAT(read(whole).losses, IsEmpty());
  }
  const std::string beginning = file_of(kRecords);
  for (std::size_t size = std::string("#ROSBAG V2.0\n").size() + 1; size < beginning.size();
       ++size) {
    // A file that ends between two records shows nothing of it.
    EXPECT_EQ(error_of(beginning.substr(0, size)), "") << size;
  }
}

TEST_F(Ros1Bag, ZerosAreTheEndOfAFile) {
  const Listener cut =
      read(file_of(chunk(kRecords, "none", kRecords), 0) + std::string(5000, '\0'));
  EXPECT_EQ(cut.messages.size(), 3u);
  EXPECT_THAT(cut.losses, ElementsAre(HasSubstr("cut short")));
}

// Its recorder was killed: no index, and the last chunk has no size yet.
TEST_F(Ros1Bag, ARecordingThatWasNotClosedIsReadWhole) {
  for (const auto& [compression, stored] :
       {std::pair{"none", kRecords}, std::pair{"bz2", bz2(kRecords)},
        std::pair{"lz4", lz4(kRecords)}}) {
    const Listener open = read(file_of(chunk("", compression, "") + stored, /*index_pos=*/0));
    EXPECT_THAT(open.messages, ElementsAre("/a:one", "/other", "/a:two")) << compression;
    EXPECT_EQ(open.losses.size(), 1u);
  }
}

TEST_F(Ros1Bag, NamesTheFaults) {
  EXPECT_THAT(error_of("#ROSBAG V1.2\n"), HasSubstr("V1.2"));
  EXPECT_THAT(error_of(file_of(chunk(kRecords, "br", kRecords))), HasSubstr("by 'br'"));
  EXPECT_THAT(error_of(file_of(chunk(kRecords + "x", "lz4", lz4(kRecords)))),
              HasSubstr("size differs"));
  EXPECT_THAT(error_of(file_of(chunk(kRecords, "bz2", bz2(kRecords).substr(0, 60)))),
              HasSubstr("bz2"));
  EXPECT_THAT(error_of(file_of(chunk(kRecords, "bz2", "no bz2"))), HasSubstr("bz2"));
  const std::string half = kRecords.substr(0, kRecords.size() - 2);
  EXPECT_THAT(error_of(file_of(chunk(half, "none", half))), HasSubstr("ends early"));
  EXPECT_THAT(error_of(file_of(message(9, "x"))), HasSubstr("not announced"));
  EXPECT_THAT(error_of(file_of(record({{"no_op", "x"}}, ""))), HasSubstr("header"));
  EXPECT_THAT(error_of(file_of(block("\xff\xff\xff\x7fop=") + block(""))), HasSubstr("header"));
  EXPECT_THAT(error_of(file_of(record({{"op", "xx"}}, ""))), HasSubstr("header"));
}

}  // namespace fovea::ros1_bag_test
