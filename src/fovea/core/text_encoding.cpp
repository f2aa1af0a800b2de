#include "fovea/core/text_encoding.h"

#include <array>

#include "fovea/errors.h"

namespace fovea {
namespace {

using namespace std::string_view_literals;

struct Encoding {
  std::string_view first_bytes;
  const char* name;
};
/// The mark of UTF-32 begins with that of UTF-16.
constexpr std::array<Encoding, 4> kNotRead = {{{"\xFF\xFE\0\0"sv, "UTF-32"},
                                               {"\0\0\xFE\xFF"sv, "UTF-32"},
                                               {"\xFF\xFE"sv, "UTF-16"},
                                               {"\xFE\xFF"sv, "UTF-16"}}};

/// UTF-16 without a mark: every second byte of an ASCII character is zero.
bool is_unmarked_utf16(std::string_view text) {
  return text.size() >= 4 && (text[0] == 0) != (text[1] == 0) && (text[0] == 0) == (text[2] == 0) &&
         (text[1] == 0) == (text[3] == 0);
}

}  // namespace

std::string_view without_byte_order_mark(std::string_view text, std::string_view name) {
  const auto reject = [&](std::string_view encoding) {
    throw InputError("the text is " + std::string(encoding), name, "save the file as UTF-8");
  };
  for (const Encoding& encoding : kNotRead) {
    if (text.starts_with(encoding.first_bytes)) reject(encoding.name);
  }
  if (is_unmarked_utf16(text)) reject("UTF-16");
  constexpr std::string_view kUtf8 = "\xEF\xBB\xBF";
  if (text.starts_with(kUtf8)) text.remove_prefix(kUtf8.size());
  return text;
}

}  // namespace fovea
