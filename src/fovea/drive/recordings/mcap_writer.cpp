#include "fovea/drive/recordings/mcap_writer.h"

#include <array>
#include <bit>
#include <cerrno>
#include <limits>

#include "fovea/core/output_file.h"
#include "fovea/drive/recordings/mcap_format.h"
#include "fovea/errors.h"
#include "fovea/platform.h"

namespace fovea {
namespace {

static_assert(std::endian::native == std::endian::little, "MCAP has little-endian numbers");

/// Numbers and texts of a record.
class Content {
 public:
  template <class T>
  Content& number(T value) {
    const auto raw = std::bit_cast<std::array<char, sizeof(T)>>(value);
    bytes_.append(raw.data(), raw.size());
    return *this;
  }
  Content& text(std::string_view value) {
    number(static_cast<std::uint32_t>(value.size()));
    bytes_ += value;
    return *this;
  }
  operator std::string_view() const { return bytes_; }  // implicit: it is these bytes

 private:
  std::string bytes_;
};

}  // namespace

McapWriter::McapWriter(const std::filesystem::path& path)
    : path_(check_output_path(path, /*force=*/false)), stream_(path_, std::ios::binary) {
  stream_ << mcap::kMagic;
  put(mcap::kHeader, Content().text("").text(std::string("fovea ") + version()));
  flush();
}

void McapWriter::put(std::uint8_t opcode, std::string_view content, std::string_view data) {
  const std::uint64_t size = content.size() + data.size();
  stream_ << std::string_view(Content().number(opcode).number(size)) << content << data;
}

void McapWriter::check() {
  if (!stream_) throw_output_error(path_, errno);
}

void McapWriter::flush() {
  errno = 0;
  stream_.flush();
  check();
}

std::uint16_t McapWriter::channel_of(const BagTopic& topic) {
  const auto [channel, is_new] = channels_.try_emplace({topic.name, topic.type, topic.encoding},
                                                       std::uint16_t(channels_.size() + 1));
  const std::uint16_t id = channel->second;
  if (!is_new) return id;
  if (channels_.size() > std::numeric_limits<std::uint16_t>::max()) {
    throw OutputError("the recording has too many topics", topic.name, "record fewer topics");
  }
  const std::string_view schema_encoding =
      topic.encoding == kRos1Encoding ? std::string_view("ros1msg") : std::string_view("ros2msg");
  put(mcap::kSchema, Content().number(id).text(topic.type).text(schema_encoding).text(""));
  put(mcap::kChannel,
      Content().number(id).number(id).text(topic.name).text(topic.encoding).text(""));
  return id;
}

void McapWriter::add(const BagTopic& topic, std::string_view message, TimeNs time) {
  constexpr std::uint32_t kSequence = 0;  // not known
  errno = 0;
  const std::uint16_t channel = channel_of(topic);
  put(mcap::kMessage, Content().number(channel).number(kSequence).number(time).number(time),
      message);
  check();
}

void McapWriter::finish() {
  put(mcap::kDataEnd, Content().number(std::uint32_t{0}));  // no checksum
  put(mcap::kFooter,
      Content().number(std::uint64_t{0}).number(std::uint64_t{0}).number(std::uint32_t{0}));
  stream_ << mcap::kMagic;
  flush();
}

}  // namespace fovea
