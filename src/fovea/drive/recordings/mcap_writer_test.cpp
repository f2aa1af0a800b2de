#include "fovea/drive/recordings/mcap_writer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "../../../../tests/temporary_folder.h"
#include "fovea/drive/recordings/mcap_file.h"
#include "fovea/errors.h"

namespace fovea::mcap_writer_test {

using testing::ElementsAre;

const BagTopic kPoints{"/points", "sensor_msgs/msg/PointCloud2", "cdr"};
const BagTopic kImu{"/imu", "sensor_msgs/msg/Imu", "ros1"};

class Sink : public BagSink {
 public:
  bool is_requested(const BagTopic& topic) override {
    topics.push_back(topic.name + " " + topic.type + " " + topic.encoding);
    return true;
  }
  void add(const BagTopic& topic, std::string_view message) override {
    messages.push_back(topic.name + " " + std::string(message));
  }
  void report_loss(const std::string& problem) override { losses.push_back(problem); }
  std::vector<std::string> topics, messages, losses;
};

TEST(McapWriter, ItsFileReadsBack) {
  const TemporaryFolder folder;
  McapWriter writer(folder / "a.mcap");
  writer.add(kPoints, "one", 1);
  writer.add(kImu, std::string(100'000, 'x'), 2);
  writer.add(kPoints, "", 3);
  writer.finish();
  Sink sink;
  read_mcap(folder / "a.mcap", folder / "a.mcap", sink);
  EXPECT_THAT(sink.topics, ElementsAre("/points sensor_msgs/msg/PointCloud2 cdr",
                                       "/imu sensor_msgs/msg/Imu ros1"));
  EXPECT_THAT(sink.messages,
              ElementsAre("/points one", "/imu " + std::string(100'000, 'x'), "/points "));
  EXPECT_TRUE(sink.losses.empty());
}

TEST(McapWriter, AFileWithoutAnEndIsReadUpToThere) {
  const TemporaryFolder folder;
  McapWriter writer(folder / "a.mcap");
  writer.add(kPoints, "one", 1);
  writer.flush();
  Sink sink;
  read_mcap(folder / "a.mcap", folder / "a.mcap", sink);
  EXPECT_THAT(sink.messages, ElementsAre("/points one"));
  EXPECT_EQ(sink.losses.size(), 1u);
}

TEST(McapWriter, ATopicMayComeBackWithAnotherEncoding) {
  const TemporaryFolder folder;
  McapWriter writer(folder / "a.mcap");
  writer.add(kPoints, "one", 1);
  writer.add({kPoints.name, kPoints.type, "ros1"}, "two", 2);
  writer.finish();
  Sink sink;
  read_mcap(folder / "a.mcap", folder / "a.mcap", sink);
  EXPECT_THAT(sink.topics, ElementsAre("/points sensor_msgs/msg/PointCloud2 cdr",
                                       "/points sensor_msgs/msg/PointCloud2 ros1"));
}

TEST(McapWriter, AnotherFileIsNotReplaced) {
  const TemporaryFolder folder;
  std::ofstream(folder / "a.mcap") << "of the user";
  EXPECT_THROW(McapWriter(folder / "a.mcap"), OutputError);
}

}  // namespace fovea::mcap_writer_test
