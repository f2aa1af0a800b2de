#include "fovea/drive/recordings/mcap_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zstd.h>

#include <fstream>
#include <vector>

#include "../../../../tests/lz4_frame.h"
#include "../../../../tests/mcap_writer.h"
#include "../../../../tests/temporary_folder.h"
#include "fovea/drive/recordings/bag.h"
#include "fovea/drive/recordings/decompress.h"
#include "fovea/errors.h"

namespace fovea::mcap_file_test {

using namespace mcap;
using testing::ElementsAre;
using testing::HasSubstr;

std::string zstd(const std::string& bytes) {
  std::string packed(ZSTD_compressBound(bytes.size()), '\0');
  packed.resize(ZSTD_compress(packed.data(), packed.size(), bytes.data(), bytes.size(), 1));
  return packed;
}
/// Notes "TOPIC:MESSAGE" of all topics but /other.
class Listener : public BagSink {
 public:
  bool is_requested(const BagTopic& topic) override {
    types.push_back(topic.type);
    return topic.name != "/other";
  }
  void add(const BagTopic& topic, std::string_view bytes) override {
    heard.push_back(topic.name + ":" + std::string(bytes));
  }
  void report_loss(const std::string& problem) override { losses.push_back(problem); }
  std::vector<std::string> heard, types, losses;
};

class McapFile : public testing::Test {
 protected:
  std::vector<std::string> read(const std::string& bytes) {
    std::ofstream(folder_ / "bag.mcap", std::ios::binary) << bytes;
    Listener listener;
    read_bag_file(folder_ / "bag.mcap", folder_ / "", listener);
    losses_ = listener.losses, types_ = listener.types;
    return listener.heard;
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
  std::vector<std::string> losses_, types_;  // of the last read()
};

const std::string kRecords = channel(1, "/a") + message(1, "one") + channel(2, "/other") +
                             message(2, "no") + message(1, "two");

TEST_F(McapFile, ReadsMessagesInChunksOfEveryCompressionAndOutside) {
  const auto all = ElementsAre("/a:one", "/a:two", "/a:three");
  const std::string more = message(1, "three");
  EXPECT_THAT(read(file_of(kRecords + more)), all);
  EXPECT_THAT(read(file_of(chunk(kRecords, "", kRecords) + more)), all);
  EXPECT_THAT(read(file_of(chunk(kRecords, "zstd", zstd(kRecords)) + chunk(more, "", more))), all);
  EXPECT_THAT(read(file_of(chunk(kRecords, "lz4", lz4(kRecords)) + more)), all);
}

TEST_F(McapFile, MessagesThatWereCompressedOneByOneAreRead) {
  EXPECT_THAT(read(file_of(channel(1, "/a") + message(1, zstd("one")))), ElementsAre("/a:one"));
}

TEST_F(McapFile, SizesAtTheBlocksOfDecompressionAreRead) {
  constexpr std::size_t kBlock = std::size_t{1} << 18;
  for (const std::size_t size : {std::size_t{0}, kBlock - 1, kBlock, kBlock + 1, 2 * kBlock}) {
    const std::string bytes(size, 'x');
    EXPECT_EQ(decompress_zstd(zstd(bytes), size, "t"), bytes) << size;
    EXPECT_EQ(decompress_lz4(lz4(bytes), size, "t"), bytes) << size;
    if (size > 0) {
      EXPECT_THROW(decompress_zstd(zstd(bytes), size - 1, "t"), InputError);
    }
    std::ofstream(folder_ / "a.zst", std::ios::binary) << zstd(bytes);
    const DecompressedFile plain(folder_ / "a.zst", folder_ / "");
    EXPECT_EQ(std::filesystem::file_size(plain.path()), size);
  }
}

TEST_F(McapFile, AWholeFileThatIsCompressedIsRead) {
  EXPECT_THAT(read(zstd(file_of(kRecords))), ElementsAre("/a:one", "/a:two"));
  EXPECT_THAT(folder_.names(), ElementsAre("bag.mcap"));
}

TEST_F(McapFile, ADamagedMessageIsHandedOnAsItIs) {
  const std::string damaged = zstd("one").substr(0, 8);
  EXPECT_THAT(read(file_of(channel(1, "/a") + message(1, damaged) + message(1, "two"))),
              ElementsAre("/a:" + damaged, "/a:two"));
}

TEST_F(McapFile, OtherRecordsAndEncodingsArePassedOver) {
  const std::string records = record(9, "attachment") + record(200, "of the future") +
                              channel(3, "/json", "json") + message(3, "{}") + kRecords;
  EXPECT_THAT(read(file_of(records)), ElementsAre("/a:one", "/a:two"));
}

TEST_F(McapFile, SaysWhatIsWrong) {
  EXPECT_THAT(error_of(file_of(chunk(kRecords, "br", kRecords))), HasSubstr("by 'br'"));
  EXPECT_THAT(error_of(file_of(chunk(kRecords, "", kRecords, 7))), HasSubstr("checksum"));
  EXPECT_THAT(error_of(file_of(chunk(kRecords + "x", "zstd", zstd(kRecords)))),
              HasSubstr("checksum"));
  EXPECT_THAT(error_of(file_of(chunk("", "zstd", zstd(kRecords)))), HasSubstr("zstd"));
  EXPECT_THAT(error_of(file_of(chunk(kRecords, "lz4", lz4(kRecords).substr(0, 20)))),
              HasSubstr("LZ4"));
  EXPECT_THAT(error_of(file_of(message(9, "x"))), HasSubstr("not announced"));
  EXPECT_THAT(error_of("a text"), HasSubstr("no recording"));
  EXPECT_THAT(error_of(""), HasSubstr("no recording"));
}

TEST_F(McapFile, AFileCutShortIsReadUpToItsEnd) {
  const std::string whole = file_of(chunk(kRecords, "zstd", zstd(kRecords)) + kRecords);
  const std::size_t chunk_end =
      file_of("").size() - (9 + 4 + 9 + 20 + 8) + chunk(kRecords, "zstd", zstd(kRecords)).size();
  for (std::size_t size = 8; size < whole.size(); ++size) {
    const std::size_t messages = read(whole.substr(0, size)).size();
    EXPECT_THAT(losses_, ElementsAre(HasSubstr("cut short"))) << size;
    EXPECT_GE(messages, size < chunk_end ? 0u : 2u) << size;
  }
  EXPECT_EQ(read(whole).size(), 4u);
  EXPECT_TRUE(losses_.empty());
  EXPECT_NE(error_of(whole.substr(0, 5)), "");
}

TEST_F(McapFile, TypesOfRos1HaveTheirNamesInRos2) {
  read(file_of(channel(1, "/a", "ros1", "sensor_msgs/Imu") + message(1, "one")));
  EXPECT_THAT(types_, ElementsAre("sensor_msgs/msg/Imu"));
}

TEST_F(McapFile, SizesThatCannotBeAreNotBelieved) {
  std::string huge = file_of(kRecords);
  huge.replace(8 + 1, 8, number(~std::uint64_t{0}));
  EXPECT_TRUE(read(huge).empty());
  EXPECT_THAT(losses_, ElementsAre(HasSubstr("cut short")));
  const std::string claims = record(6, std::string(16, '\0') + number(~std::uint64_t{0}) +
                                           number(0u) + text("zstd") + number(std::uint64_t{0}));
  EXPECT_THAT(error_of(file_of(claims)), HasSubstr("smaller chunks"));
}

}  // namespace fovea::mcap_file_test
