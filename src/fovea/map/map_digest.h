// The hash that says whether two maps are the same (docs/map-format.md). Private to map/.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>

struct XXH3_state_s;

namespace fovea {

/// XXH3, 128 bits, over values that each carry a byte for their kind, so that no two sequences of
/// tables, rows and values give the same bytes.
class MapDigest {
 public:
  MapDigest();
  ~MapDigest();

  void section(std::string_view table);
  /// Begins a row; more values may follow.
  template <class... Values>
  void row(const Values&... values) {
    tag('R');
    (value(values), ...);
  }
  void value(std::int64_t number);
  void value(double number);
  void value(std::string_view text);
  void value(std::span<const std::byte> bytes);
  void null() { tag('n'); }

  /// 32 hexadecimal digits.
  std::string hex() const;

 private:
  void tag(char kind);
  void add(const void* data, std::size_t size);

  std::unique_ptr<XXH3_state_s, void (*)(XXH3_state_s*)> state_;
};

}  // namespace fovea
