#include "fovea/map/value_hash.h"

#include <fmt/format.h>
#include <xxhash.h>

#include <new>

namespace fovea {

ValueHash::ValueHash()
    : state_(XXH3_createState(), [](XXH3_state_t* state) { XXH3_freeState(state); }) {
  if (state_ == nullptr) throw std::bad_alloc();
  // One reset serves both lengths: they differ only in how they finish.
  XXH3_128bits_reset(state_.get());
}
ValueHash::~ValueHash() = default;

void ValueHash::add(const void* data, std::size_t size) {
  if (size > 0) XXH3_128bits_update(state_.get(), data, size);
}

void ValueHash::tag(char kind) { add(&kind, 1); }

void ValueHash::section(std::string_view table) {
  tag('S');
  value(table);
}

void ValueHash::value(std::int64_t number) {
  tag('i');
  add(&number, sizeof(number));
}

void ValueHash::value(double number) {
  tag('r');
  add(&number, sizeof(number));
}

void ValueHash::value(std::string_view text) {
  tag('t');
  const auto size = static_cast<std::int64_t>(text.size());
  add(&size, sizeof(size));
  add(text.data(), text.size());
}

void ValueHash::value(std::span<const std::byte> bytes) {
  tag('b');
  const auto size = static_cast<std::int64_t>(bytes.size());
  add(&size, sizeof(size));
  add(bytes.data(), bytes.size());
}

std::uint64_t ValueHash::hash64() const { return XXH3_64bits_digest(state_.get()); }

std::string ValueHash::hex128() const {
  const XXH128_hash_t hash = XXH3_128bits_digest(state_.get());
  return fmt::format("{:016x}{:016x}", hash.high64, hash.low64);
}

}  // namespace fovea
