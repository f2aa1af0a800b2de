// Hash of a sequence of values: the digest of a map and the checksums of its rows
// (docs/map-format.md).
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>

struct XXH3_state_s;

namespace fovea {

/// XXH3 over values that each carry a byte for their kind, so that no two sequences of tables, rows
/// and values give the same bytes.
class ValueHash {
 public:
  ValueHash();
  ~ValueHash();

  void section(std::string_view table);
  /// Begins a row; its values follow.
  void row() { tag('R'); }
  void value(std::int64_t number);
  void value(double number);
  void value(std::string_view text);
  void value(std::span<const std::byte> bytes);
  void null() { tag('n'); }

  /// The 64-bit hash.
  std::uint64_t hash64() const;
  /// The 128-bit hash: 32 hexadecimal digits.
  std::string hex128() const;

 private:
  void tag(char kind);
  void add(const void* data, std::size_t size);

  std::unique_ptr<XXH3_state_s, void (*)(XXH3_state_s*)> state_;
};

}  // namespace fovea
