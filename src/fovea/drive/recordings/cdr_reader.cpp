#include "fovea/drive/recordings/cdr_reader.h"

#include <fmt/format.h>

#include "fovea/core/errors.h"

namespace fovea {

static_assert(std::endian::native == std::endian::little);

CdrReader::CdrReader(std::string_view message, std::string where) : where_(std::move(where)) {
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

std::string_view CdrReader::text() {
  std::string_view text = bytes();
  if (!text.empty() && text.back() == '\0') text.remove_suffix(1);
  return text;
}

std::string_view CdrReader::bytes() { return aligned(1, count(1)); }

std::size_t CdrReader::count(std::size_t min_bytes) {
  const auto count = number<std::uint32_t>();
  if (count > (body_.size() - at_) / min_bytes) throw_too_short();
  return count;
}

std::string_view CdrReader::aligned(std::size_t alignment, std::size_t size) {
  const std::size_t begin = (at_ + alignment - 1) / alignment * alignment;
  if (begin > body_.size() || size > body_.size() - begin) throw_too_short();
  at_ = begin + size;
  return body_.substr(begin, size);
}

void CdrReader::throw_too_short() const {
  throw InputError("a message ends early", where_, "restore the recording from a copy");
}

}  // namespace fovea
