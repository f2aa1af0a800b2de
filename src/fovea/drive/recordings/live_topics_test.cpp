#include "fovea/drive/recordings/live_topics.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <thread>

#include "../../../../tests/mcap_writer.h"
#include "../../../../tests/temporary_folder.h"
#include "fovea/drive/recordings/convert_bags.h"
#include "fovea/drive/recordings/test_messages.h"
#include "fovea/errors.h"

namespace fovea::live_topics_test {

using namespace test_messages;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr std::chrono::milliseconds kNow{0};

const BagTopic kPoints{"/points", std::string(ros::kPointCloud), "cdr"};
const BagTopic kRaw{"/front/image_raw", std::string(ros::kImage), "cdr"};
const BagTopic kInfo{"/front/camera_info", std::string(ros::kCameraInfo), "cdr"};
const BagTopic kStatic{"/tf_static", std::string(ros::kTransforms), "cdr"};
const BagTopic kOdometry{"/odom", std::string(ros::kOdometry), "cdr"};

std::string odometry(std::uint32_t nanosec, double x) {
  return CdrWriter()
      .header(kSecond, nanosec, "odom")
      .text("base_link")
      .motion({Eigen::Vector3d(x, 0, 0), Eigen::Quaterniond::Identity()})
      .doubles(36)
      .doubles(6)
      .doubles(36)
      .message();
}

struct Message {
  BagTopic topic;
  std::string bytes;
};

/// Calibration and place come with the second scan.
std::vector<Message> some_messages(std::uint32_t scans) {
  std::vector<Message> messages;
  for (std::uint32_t i = 0; i < scans; ++i) {
    messages.push_back({kOdometry, odometry(i * kStep, 0.1 * i)});
    messages.push_back({kOdometry, odometry(i * kStep + kMiddle, 0.1 * i + 0.05)});
    messages.push_back({kRaw, grey_image(i * kStep + kMiddle)});
    messages.push_back({kPoints, cloud(i * kStep, 5 + i)});
    if (i != 1) continue;
    messages.push_back({kInfo, camera_info()});
    messages.push_back({kStatic, transforms()});
  }
  messages.push_back({kOdometry, odometry(scans * kStep + kMiddle, 0.1 * scans)});
  return messages;
}

LiveTopicsOptions some_options() {
  LiveTopicsOptions options;
  options.live.drive.cameras = {0};
  return options;
}

/// The sender waits for the frames: none is dropped.
LiveTopicsOptions paced_options() {
  LiveTopicsOptions options = some_options();
  options.live.waits = true;
  return options;
}

class LiveTopicsTest : public testing::Test {
 protected:
  void begin(const LiveTopicsOptions& options = some_options()) {
    topics_.emplace(options);
    for (const BagTopic& topic : {kPoints, kRaw, kInfo, kStatic, kOdometry}) {
      requested_ += topics_->is_requested(topic) ? 1 : 0;
    }
  }
  void add_all(const std::vector<Message>& messages) {
    for (const Message& message : messages) topics_->add(message.topic, message.bytes);
  }
  LiveSource* source() const { return topics_->wait_for_source(kNow); }

  /// The frames of messages that another thread sends, until the end.
  std::vector<Frame> frames_of(const std::vector<Message>& messages) {
    const std::jthread sender([&] {
      add_all(messages);
      topics_->close();
    });
    LiveSource* live = nullptr;
    while (live == nullptr) live = topics_->wait_for_source(std::chrono::milliseconds(10));
    std::vector<Frame> frames;
    first_ = live->begin({});
    while (auto next = live->next({})) frames.push_back(std::get<Frame>(std::move(next->frame)));
    return frames;
  }

  std::optional<LiveTopics> topics_;
  int requested_ = 0;
  std::unique_ptr<FrameSource> first_;
};

TEST_F(LiveTopicsTest, NamesWhatIsMissingUntilADriveCanBegin) {
  begin();
  EXPECT_EQ(requested_, 5);
  topics_->update();
  EXPECT_THAT(topics_->missing(), HasSubstr("no point clouds"));
  topics_->add(kRaw, grey_image(kMiddle));
  topics_->add(kOdometry, odometry(0, 0));
  for (std::uint32_t i = 0; i < 3; ++i) topics_->add(kPoints, cloud(i * kStep, 5));
  EXPECT_THAT(topics_->missing(), HasSubstr("no CameraInfo /front/camera_info"));
  topics_->add(kInfo, camera_info());
  topics_->update();
  EXPECT_THAT(topics_->missing(), HasSubstr("tf does not say"));
  topics_->add(kStatic, transforms());
  topics_->add(kPoints, cloud(3 * kStep, 5));
  EXPECT_EQ(topics_->missing(), "the first 5 scans of /points");
  EXPECT_EQ(source(), nullptr);
  topics_->add(kPoints, cloud(4 * kStep, 5));
  EXPECT_NE(source(), nullptr);
  EXPECT_FALSE(topics_->is_closed());
  EXPECT_THAT(topics_->chosen(), testing::Contains(HasSubstr("camera 0: 'front'")));
}

TEST_F(LiveTopicsTest, GivesTheFramesOfTheConvertedRecording) {
  const std::vector<Message> messages = some_messages(15);
  begin(paced_options());
  const std::vector<Frame> frames = frames_of(messages);

  const TemporaryFolder folder;
  std::string records;
  const std::vector<BagTopic> topics = {kPoints, kRaw, kInfo, kStatic, kOdometry};
  for (std::size_t i = 0; i < topics.size(); ++i) {
    records += mcap::channel(int(i), topics[i].name, "cdr", topics[i].type);
  }
  for (const Message& message : messages) {
    const auto topic = std::find_if(topics.begin(), topics.end(), [&](const BagTopic& t) {
      return t.name == message.topic.name;
    });
    records += mcap::message(int(topic - topics.begin()), message.bytes);
  }
  std::ofstream(folder / "a.mcap", std::ios::binary) << mcap::file_of(records);
  convert_bags({folder / "a.mcap"}, folder / "drive", false, {}, [](int, int) {});
  const auto drive = open_drive(folder / "drive", some_options().live.drive);

  ASSERT_EQ(frames.size(), 15u);
  for (int i = 0; i < 15; ++i) {
    const Frame expected = std::get<Frame>(drive->load(i));
    const Frame& frame = frames[std::size_t(i)];
    EXPECT_EQ(frame.index, i);
    EXPECT_EQ(frame.stamp, expected.stamp);
    EXPECT_EQ(frame.scan.position, expected.scan.position);
    EXPECT_EQ(frame.scan.intensity, expected.scan.intensity);
    EXPECT_EQ(frame.scan.time, expected.scan.time);
    EXPECT_EQ(frame.images.at(0).data, expected.images.at(0).data);
  }
  ASSERT_TRUE(first_->info().navigation);
  EXPECT_TRUE(drive->info().navigation);
  EXPECT_EQ(first_->info().calibration.cameras[0].cx, drive->info().calibration.cameras[0].cx);
}

TEST_F(LiveTopicsTest, WaitsForATopicThatIsSilentButNotForever) {
  begin();
  const std::vector<Message> messages = some_messages(30);
  EXPECT_TRUE(topics_->is_requested({"/gnss", std::string(ros::kNavSatFix), "cdr"}));
  EXPECT_FALSE(topics_->is_requested({"/text", "std_msgs/msg/String", "cdr"}));
  std::size_t scans = 0;
  for (const Message& message : messages) {
    topics_->add(message.topic, message.bytes);
    scans += message.topic.name == "/points" ? 1 : 0;
    if (scans == 6) {
      EXPECT_EQ(topics_->missing(), "messages of /gnss");
    }
    if (source() != nullptr) break;
  }
  EXPECT_GT(scans, 15u);
  EXPECT_LT(scans, 30u);
}

TEST_F(LiveTopicsTest, CountsMessagesThatCannotBeUsed) {
  begin();
  add_all(some_messages(6));
  ASSERT_NE(source(), nullptr);
  topics_->add(kPoints, cloud(7 * kStep, 5, "elsewhere"));
  topics_->add(kPoints, std::string("\0\1\0\0rubbish", 11));
  EXPECT_EQ(topics_->unusable_counts(), (std::map<std::string, std::size_t>{{"/points", 2}}));
  EXPECT_THAT(topics_->unusable().warnings,
              ElementsAre(HasSubstr("2 messages of /points cannot be used (the first: its frame")));
}

TEST_F(LiveTopicsTest, KeepsTheTopicsOfThePlan) {
  begin();
  add_all(some_messages(6));
  EXPECT_TRUE(topics_->is_requested(kPoints));
  EXPECT_TRUE(topics_->is_requested(kOdometry));
  EXPECT_FALSE(topics_->is_requested({"/points", std::string(ros::kImage), "cdr"}));
  EXPECT_FALSE(topics_->is_requested({"/rear/points", std::string(ros::kPointCloud), "cdr"}));
  EXPECT_FALSE(topics_->is_requested(kInfo));
}

TEST_F(LiveTopicsTest, LeavesOutTopicsThatWereNotChosen) {
  LiveTopicsOptions options = some_options();
  options.topics.lidars = {"/rear/points"};
  options.topics.cameras = {{"rear", "/rear/image_raw"}};
  begin(options);
  EXPECT_EQ(requested_, 3);
  EXPECT_TRUE(topics_->is_requested({"/rear/points", std::string(ros::kPointCloud), "cdr"}));
}

TEST_F(LiveTopicsTest, MemoryIsBoundedWhileItWaits) {
  LiveTopicsOptions options = some_options();
  options.max_waiting = 5000;
  begin(options);
  for (std::uint32_t i = 0; i < 40; ++i) {
    topics_->add(kPoints, cloud(i * kStep, 20));
    topics_->add(kRaw, grey_image(i * kStep + kMiddle));
    if (i == 2) topics_->add(kInfo, camera_info());
    if (i == 2) topics_->add(kOdometry, odometry(0, 0));
    if (i < 39) EXPECT_EQ(source(), nullptr);
    if (i == 38) topics_->add(kStatic, transforms());
  }
  ASSERT_NE(source(), nullptr);
  topics_->close();
  const auto first = source()->begin({});
  ASSERT_NE(first, nullptr);
  const Frame frame = std::get<Frame>(source()->next({})->frame);
  EXPECT_GT(frame.stamp, kSecond * kNsPerSecond + 20 * TimeNs{kStep});
}

TEST_F(LiveTopicsTest, EndsAfterTheDuration) {
  LiveTopicsOptions options = paced_options();
  options.topics.duration = 0.95;
  begin(options);
  std::vector<Message> messages = some_messages(20);
  const std::vector<Frame> frames = frames_of(messages);
  EXPECT_EQ(frames.size(), 10u);
  EXPECT_TRUE(topics_->is_over());
}

TEST_F(LiveTopicsTest, AShortDriveBeginsAtItsEnd) {
  begin();
  add_all(some_messages(3));
  EXPECT_EQ(source(), nullptr);
  topics_->close();
  ASSERT_NE(source(), nullptr);
  EXPECT_TRUE(topics_->is_closed());
  EXPECT_NE(source()->begin({}), nullptr);
}

TEST_F(LiveTopicsTest, TheEndWithoutADriveIsAnError) {
  begin();
  topics_->add(kPoints, cloud(0, 5));
  topics_->add(kRaw, grey_image(0));
  EXPECT_THROW(topics_->close(), InputError);
  EXPECT_TRUE(topics_->is_closed());
  EXPECT_EQ(source(), nullptr);
}

TEST_F(LiveTopicsTest, OptionsThatContradictEachOtherEndIt) {
  LiveTopicsOptions options = some_options();
  options.topics.poses = NavigationSource::kTf;
  options.topics.odometry = "/odom";
  begin(options);
  EXPECT_THROW(add_all(some_messages(3)), ConfigError);
}

}  // namespace fovea::live_topics_test
