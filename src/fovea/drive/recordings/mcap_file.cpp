#include "fovea/drive/recordings/mcap_file.h"

#include <fmt/format.h>
#include <libdeflate.h>

#include <map>
#include <optional>

#include "fovea/core/printable.h"
#include "fovea/drive/recordings/bag_stream.h"
#include "fovea/drive/recordings/decompress.h"
#include "fovea/drive/recordings/mcap_format.h"
#include "fovea/errors.h"

namespace fovea {
namespace {

/// Numbers (little endian) and texts of a record, one after the other.
class Fields {
 public:
  Fields(std::string_view bytes, const std::string& where) : bytes_(bytes), where_(where) {}

  template <class T>
  T number() {
    T value;
    block(sizeof value).copy(reinterpret_cast<char*>(&value), sizeof value);
    return value;
  }
  std::string_view text() { return block(number<std::uint32_t>()); }
  std::string_view block(std::uint64_t size) {
    if (size > bytes_.size()) {
      throw InputError("a record ends early", where_, "restore the recording from a copy");
    }
    const std::string_view result = bytes_.substr(0, size);
    bytes_.remove_prefix(size);
    return result;
  }
  std::string_view rest() const { return bytes_; }
  bool at_end() const { return bytes_.empty(); }

 private:
  std::string_view bytes_;
  const std::string& where_;
};

class McapReader {
 public:
  McapReader(const std::filesystem::path& file, const std::filesystem::path& shown, BagSink& sink)
      : stream_(file, shown), sink_(sink) {}

  void read() {
    if (stream_.take(std::min<std::uint64_t>(mcap::kMagic.size(), stream_.size())) !=
        mcap::kMagic) {
      throw InputError("this is no MCAP file", stream_.name(), "give a recording of ROS 2");
    }
    while (!ended_) next();
  }

 private:
  /// @param place  up to which it was read
  void end_early(std::uint64_t place) {
    ended_ = true;
    sink_.report_loss(stream_.cut_short_at(place));
  }

  /// Reads a record.
  void next() {
    const std::string where = stream_.here();
    const std::uint64_t begin = stream_.place();
    constexpr std::uint64_t kHead = 9;
    if (kHead > stream_.left()) return end_early(begin);
    Fields head(stream_.take(kHead), where);
    const auto opcode = head.number<std::uint8_t>();
    const auto size = head.number<std::uint64_t>();
    if (size > stream_.left()) return end_early(begin);
    switch (opcode) {
      case mcap::kChunk:
        return read_chunk(stream_.take(size), where);
      case mcap::kSchema:
      case mcap::kChannel:
      case mcap::kMessage:
        return read_record(opcode, stream_.take(size), where);
      case mcap::kFooter:
        stream_.take(size);
        if (mcap::kMagic.size() > stream_.left() ||
            stream_.take(mcap::kMagic.size()) != mcap::kMagic)
          return end_early(begin);
        ended_ = true;
        return;
      default:  // of no interest, or of a later version
        stream_.skip(size);
    }
  }

  void read_chunk(std::string_view bytes, const std::string& where) {
    Fields chunk(bytes, where);
    chunk.block(16);  // times of the first and the last message
    const auto size = chunk.number<std::uint64_t>();
    const auto crc = chunk.number<std::uint32_t>();
    const std::string compression(chunk.text());
    const std::string_view stored = chunk.block(chunk.number<std::uint64_t>());
    if (size > kMaxBagBlock) {
      throw InputError(fmt::format("a chunk has {} bytes", size), where,
                       "write the recording with smaller chunks");
    }
    std::string unpacked;
    std::string_view records = stored;
    if (!compression.empty()) {
      if (compression == "zstd") {
        unpacked = decompress_zstd(stored, size, where);
      } else if (compression == "lz4") {
        unpacked = decompress_lz4(stored, size, where);
      } else {
        throw InputError(fmt::format("chunks are compressed by '{:.40}'", printable(compression)),
                         where, "write the recording with zstd, lz4 or none");
      }
      records = unpacked;
    }
    const bool whole = records.size() == size &&
                       (crc == 0 || libdeflate_crc32(0, records.data(), records.size()) == crc);
    if (!whole) {
      throw InputError("a chunk is damaged (its size or checksum differs)", where,
                       "restore the recording from a copy");
    }
    Fields fields(records, where);
    while (!fields.at_end()) {
      const auto opcode = fields.number<std::uint8_t>();
      read_record(opcode, fields.block(fields.number<std::uint64_t>()), where);
    }
  }

  void read_record(std::uint8_t opcode, std::string_view bytes, const std::string& where) {
    Fields record(bytes, where);
    if (opcode == mcap::kSchema) {
      const auto id = record.number<std::uint16_t>();
      schemas_[id] = record.text();
    } else if (opcode == mcap::kChannel) {
      add_channel(record, where);
    } else if (opcode == mcap::kMessage) {
      const auto channel = channels_.find(record.number<std::uint16_t>());
      if (channel == channels_.end()) {
        throw InputError("a message is of a channel that was not announced", where,
                         "restore the recording from a copy");
      }
      record.block(20);  // sequence, times of receipt and of publishing
      if (channel->second.wanted) return sink_.add(channel->second.topic, record.rest());
      sink_.skip(channel->second.topic);
    }
  }

  void add_channel(Fields record, const std::string& where) {
    const auto id = record.number<std::uint16_t>();
    const auto schema_id = record.number<std::uint16_t>();
    // Announced again in the summary, and in each chunk where it has messages.
    if (channels_.contains(id)) return;
    const auto schema = schemas_.find(schema_id);
    if (schema == schemas_.end() && schema_id != 0) {
      throw InputError("a channel is of a schema that was not announced", where,
                       "restore the recording from a copy");
    }
    BagTopic topic;
    if (schema != schemas_.end()) topic.type = schema->second;
    topic.name = record.text();
    topic.encoding = record.text();
    if (topic.encoding == kRos1Encoding) topic.type = ros2_type(topic.type);
    const bool wanted = sink_.is_requested(topic) && topic.is_readable();
    channels_.emplace(id, Channel{std::move(topic), wanted});
  }

  struct Channel {
    BagTopic topic;
    bool wanted;
  };

  BagStream stream_;
  BagSink& sink_;
  bool ended_ = false;
  std::map<std::uint16_t, std::string> schemas_;
  std::map<std::uint16_t, Channel> channels_;
};

}  // namespace

void read_mcap(const std::filesystem::path& file, const std::filesystem::path& shown,
               BagSink& sink) {
  McapReader(file, shown, sink).read();
}

}  // namespace fovea
