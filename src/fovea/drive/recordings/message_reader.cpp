#include "fovea/drive/recordings/message_reader.h"

#include <fmt/format.h>

#include "fovea/drive/recordings/bag_sink.h"
#include "fovea/errors.h"

namespace fovea {

static_assert(std::endian::native == std::endian::little);

MessageReader::MessageReader(std::string_view message, std::string_view encoding, std::string where)
    : is_ros1_(encoding == kRos1Encoding), body_(message), where_(std::move(where)) {
  if (is_ros1_) return;
  constexpr std::size_t kEncapsulation = 4;
  if (message.size() < kEncapsulation) throw_too_short();
  constexpr char kBigEndian = 0, kLittleEndian = 1;
  const char kind = message[1];
  if (message[0] != 0 || (kind != kBigEndian && kind != kLittleEndian)) {
    throw InputError(
        fmt::format("the representation {:02x}{:02x} of messages is not read",
                    static_cast<unsigned char>(message[0]), static_cast<unsigned char>(kind)),
        where_, "write the recording with plain CDR");
  }
  swapped_ = kind == kBigEndian;
  body_ = message.substr(kEncapsulation);
}

std::string_view MessageReader::text() {
  std::string_view text = bytes();
  if (!text.empty() && text.back() == '\0') text.remove_suffix(1);
  return text;
}

std::string_view MessageReader::bytes() { return aligned(1, count(1)); }

std::size_t MessageReader::count(std::size_t min_bytes) {
  const auto count = number<std::uint32_t>();
  if (count > (body_.size() - at_) / min_bytes) throw_too_short();
  return count;
}

std::string_view MessageReader::aligned(std::size_t alignment, std::size_t size) {
  const std::size_t begin = is_ros1_ ? at_ : (at_ + alignment - 1) / alignment * alignment;
  if (begin > body_.size() || size > body_.size() - begin) throw_too_short();
  at_ = begin + size;
  return body_.substr(begin, size);
}

void MessageReader::throw_too_short() const {
  throw InputError("a message ends early", where_, "restore the recording from a copy");
}

}  // namespace fovea
