#include "fovea/drive/recordings/ros1_bag.h"

#include <fmt/format.h>

#include <map>
#include <optional>
#include <vector>

#include "fovea/core/printable.h"
#include "fovea/drive/recordings/bag_stream.h"
#include "fovea/drive/recordings/decompress.h"
#include "fovea/errors.h"

namespace fovea {
namespace {

constexpr std::string_view kRos1Magic = "#ROSBAG V2.0\n";
constexpr std::size_t kLength = 4;  // bytes of a length

enum class Operation : std::uint8_t {
  kMessage = 0x02,
  kBagHeader = 0x03,
  kChunk = 0x05,
  kConnection = 0x07,
};

template <class T>
T read_number(std::string_view bytes) {
  T value;
  bytes.copy(reinterpret_cast<char*>(&value), sizeof value);
  return value;
}

/// The fields of a header: each has a length, a name, '=' and a value.
class RecordHeader {
 public:
  RecordHeader(std::string_view bytes, const std::string& where) : where_(where) {
    while (!bytes.empty()) {
      if (bytes.size() < kLength) throw_damaged();
      const auto size = read_number<std::uint32_t>(bytes);
      bytes.remove_prefix(kLength);
      if (size > bytes.size()) throw_damaged();
      const std::string_view field = bytes.substr(0, size);
      bytes.remove_prefix(size);
      const std::size_t equals = field.find('=');
      if (equals == std::string_view::npos) throw_damaged();
      values_[field.substr(0, equals)] = field.substr(equals + 1);
    }
  }

  std::string_view text(std::string_view name) const {
    const auto found = values_.find(name);
    if (found == values_.end()) throw_damaged();
    return found->second;
  }
  template <class T>
  T number(std::string_view name) const {
    const std::string_view value = text(name);
    if (value.size() != sizeof(T)) throw_damaged();
    return read_number<T>(value);
  }

 private:
  [[noreturn]] void throw_damaged() const {
    throw InputError("the header of a record is damaged", where_,
                     "restore the recording from a copy");
  }

  std::map<std::string_view, std::string_view> values_;
  const std::string& where_;
};

class Ros1BagReader {
 public:
  Ros1BagReader(const std::filesystem::path& file, const std::filesystem::path& shown,
                BagSink& sink)
      : stream_(file, shown), sink_(sink) {}

  void read() {
    const std::string_view magic =
        stream_.take(std::min<std::uint64_t>(kRos1Magic.size(), stream_.size()));
    if (magic != kRos1Magic) {
      throw InputError(fmt::format("bags of format '{:.12}' are not read", printable(magic)),
                       stream_.name(), "turn it into format 2.0 ('rosbag fix')");
    }
    while (stream_.left() > 0 && !is_cut_) read_record();
    if (is_cut_) {
      sink_.report_loss(stream_.cut_short_at(cut_));
    } else if (is_open_) {
      sink_.report_loss(
          fmt::format("{}: the recording was not closed; all {} bytes of it were read",
                      stream_.name(), stream_.size()));
    }
  }

 private:
  void cut_at(std::uint64_t place) {
    is_cut_ = true;
    cut_ = place;
  }

  /// A length and that many bytes; empty if the file ends before.
  std::optional<std::string> take_block() {
    if (stream_.left() < kLength) return std::nullopt;
    const auto size = read_number<std::uint32_t>(stream_.take(kLength));
    if (size > stream_.left()) return std::nullopt;
    return std::string(stream_.take(size));
  }

  void read_record() {
    const std::uint64_t begin = stream_.place();
    const std::string where = stream_.here();
    const std::optional<std::string> header = take_block();
    // A file system may leave zeros behind the end of a file that was not closed.
    if (!header || header->empty() || stream_.left() < kLength) return cut_at(begin);
    const RecordHeader fields(*header, where);
    const auto operation = Operation(fields.number<std::uint8_t>("op"));
    const auto size = read_number<std::uint32_t>(stream_.take(kLength));
    const bool is_whole = size <= stream_.left();
    if (operation == Operation::kChunk) {
      // A recorder enters the size when a chunk is full: 0 in the last one of an open recording.
      const bool is_open = size == 0 && fields.number<std::uint32_t>("size") == 0;
      if (is_open && fields.text("compression") == "none") return;
      const std::string_view chunk = stream_.take(is_open || !is_whole ? stream_.left() : size);
      if (is_open || !is_whole) cut_at(begin);
      return read_chunk(fields, chunk, where);
    }
    if (!is_whole) return cut_at(begin);
    if (operation == Operation::kBagHeader)
      is_open_ = fields.number<std::uint64_t>("index_pos") == 0;
    if (operation == Operation::kMessage || operation == Operation::kConnection) {
      return use_record(operation, fields, stream_.take(size), where);
    }
    stream_.skip(size);  // an index, or of a later version
  }

  void read_chunk(const RecordHeader& fields, std::string_view stored, const std::string& where) {
    const std::string_view compression = fields.text("compression");
    const LossyEnd end = is_cut_ ? LossyEnd::kAllowed : LossyEnd::kRefused;
    std::string records;
    if (compression == "none") {
      records = stored;
    } else if (compression == "bz2") {
      records = decompress_bz2(stored, kMaxBagBlock, where, end);
    } else if (compression == "lz4") {
      records = decompress_lz4(stored, kMaxBagBlock, where, end);
    } else {
      throw InputError(fmt::format("chunks are compressed by '{:.40}'", printable(compression)),
                       where, "write the recording with bz2, lz4 or none ('rosbag decompress')");
    }
    if (!is_cut_ && records.size() != fields.number<std::uint32_t>("size")) {
      throw InputError("a chunk is damaged (its size differs)", where,
                       "restore the recording from a copy");
    }
    std::string_view rest = records;
    while (!rest.empty()) {
      const auto header = next_block(rest);
      const auto data = header ? next_block(rest) : std::nullopt;
      if (!data || header->empty()) {
        if (is_cut_) return;
        throw InputError("a chunk is damaged (a record ends early)", where,
                         "restore the recording from a copy");
      }
      const RecordHeader record(*header, where);
      use_record(Operation(record.number<std::uint8_t>("op")), record, *data, where);
    }
  }
  /// A length and that many bytes; empty if there are fewer.
  static std::optional<std::string_view> next_block(std::string_view& rest) {
    if (rest.size() < kLength) return std::nullopt;
    const auto size = read_number<std::uint32_t>(rest);
    if (size > rest.size() - kLength) return std::nullopt;
    const std::string_view block = rest.substr(kLength, size);
    rest.remove_prefix(kLength + size);
    return block;
  }

  void use_record(Operation operation, const RecordHeader& fields, std::string_view data,
                  const std::string& where) {
    if (operation == Operation::kConnection) add_connection(fields, data, where);
    if (operation != Operation::kMessage) return;
    const auto connection = connections_.find(fields.number<std::uint32_t>("conn"));
    if (connection == connections_.end()) {
      throw InputError("a message is of a connection that was not announced", where,
                       "restore the recording from a copy");
    }
    const auto& [topic, is_requested] = connection->second;
    if (is_requested) return sink_.add(topic, data);
    sink_.skip(topic);
  }

  void add_connection(const RecordHeader& fields, std::string_view data, const std::string& where) {
    const auto id = fields.number<std::uint32_t>("conn");
    if (connections_.contains(id)) return;  // announced again in the index
    const RecordHeader description(data, where);
    const BagTopic topic{std::string(fields.text("topic")), ros2_type(description.text("type")),
                         std::string(kRos1Encoding)};
    connections_.emplace(id, std::pair(topic, sink_.is_requested(topic)));
  }

  BagStream stream_;
  BagSink& sink_;
  bool is_open_ = false, is_cut_ = false;
  std::uint64_t cut_ = 0;                                           // where
  std::map<std::uint32_t, std::pair<BagTopic, bool>> connections_;  // with whether requested
};

}  // namespace

std::string ros2_type(std::string_view ros1_type) {
  if (ros1_type == "tf/tfMessage") return "tf2_msgs/msg/TFMessage";  // the same fields
  const std::size_t slash = ros1_type.find('/');
  if (slash == std::string_view::npos || ros1_type.find('/', slash + 1) != std::string_view::npos) {
    return std::string(ros1_type);
  }
  return fmt::format("{}/msg/{}", ros1_type.substr(0, slash), ros1_type.substr(slash + 1));
}

void read_ros1_bag(const std::filesystem::path& file, const std::filesystem::path& shown,
                   BagSink& sink) {
  Ros1BagReader(file, shown, sink).read();
}

}  // namespace fovea
