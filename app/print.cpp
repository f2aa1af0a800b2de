#include "app/print.h"

#include <nlohmann/json.hpp>

namespace fovea::app {
namespace {

/// Escapes the control characters that the library leaves in strings: DEL and U+0080 to U+009F.
std::string with_escapes(std::string_view json) {
  std::string escaped;
  while (!json.empty()) {
    const Character character = first_character(json);
    const auto last = static_cast<unsigned char>(json[character.bytes - 1]);
    const bool is_escaped = character.is_control && last >= 0x7f && character.bytes <= 2;
    if (is_escaped) {
      escaped += fmt::format("\\u{:04x}", last);
    } else {
      escaped += json.substr(0, character.bytes);
    }
    json.remove_prefix(character.bytes);
  }
  return escaped;
}

}  // namespace

void print_lines(std::string_view text) { fmt::print("{}", printable_lines(text)); }

void print_json_value(const nlohmann::ordered_json& json) {
  constexpr int kIndent = 2;
  fmt::print("{}\n", with_escapes(json.dump(kIndent, ' ', /*ensure_ascii=*/false,
                                            nlohmann::json::error_handler_t::replace)));
}

}  // namespace fovea::app
