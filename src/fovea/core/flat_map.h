// A hash table for what is asked millions of times a frame.
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace fovea {

/// Values by 63-bit keys, in one flat table with open addressing (Knuth, The Art of Computer
/// Programming 3, 6.4): one look into memory, most often. Values should be small, for they move.
template <class Value>
class FlatMap {
 public:
  std::size_t size() const { return size_; }

  /// @return nullptr if there is none; valid until the next try_emplace() or erase()
  const Value* find(std::uint64_t key) const {
    const Slot& slot = slots_[place_of(key)];
    return slot.key == key ? &slot.value : nullptr;
  }
  Value* find(std::uint64_t key) { return const_cast<Value*>(std::as_const(*this).find(key)); }

  /// @param key  below 2^63
  /// @return the key's value, `value` if it had none, and whether it had none; valid as above
  std::pair<Value*, bool> try_emplace(std::uint64_t key, const Value& value = {}) {
    std::size_t place = place_of(key);
    const bool is_new = slots_[place].key == kFree;
    if (is_new) {
      if (2 * ++size_ > slots_.size()) {
        grow();
        place = place_of(key);
      }
      slots_[place] = {key, value};
    }
    return {&slots_[place].value, is_new};
  }

  /// Forgets a key that is there.
  void erase(std::uint64_t key) {
    const std::size_t mask = slots_.size() - 1;
    std::size_t place = place_of(key);
    --size_;
    // What was put behind it for want of room moves up: Knuth's algorithm R.
    for (std::size_t next = (place + 1) & mask; slots_[next].key != kFree;
         next = (next + 1) & mask) {
      const std::size_t home = home_of(slots_[next].key);
      if (((next - home) & mask) < ((next - place) & mask)) continue;  // found where it is
      slots_[place] = slots_[next];
      place = next;
    }
    slots_[place] = Slot();
  }

  void clear() { *this = FlatMap(); }

 private:
  static constexpr int kFirstBits = 6;
  static constexpr std::uint64_t kFree = ~std::uint64_t{0};
  struct Slot {
    std::uint64_t key = kFree;
    Value value{};
  };
  std::size_t home_of(std::uint64_t key) const {
    // Fibonacci hashing: the product's highest bits depend on all of the key's.
    return key * 0x9e3779b97f4a7c15ull >> shift_;
  }
  /// Of the slot with this key, or of the free one where it belongs.
  std::size_t place_of(std::uint64_t key) const {
    std::size_t place = home_of(key);
    while (slots_[place].key != key && slots_[place].key != kFree) {
      place = (place + 1) & (slots_.size() - 1);
    }
    return place;
  }
  void grow() {
    std::vector<Slot> before(2 * slots_.size());
    before.swap(slots_);
    --shift_;
    for (const Slot& slot : before) {
      if (slot.key != kFree) slots_[place_of(slot.key)] = slot;
    }
  }

  int shift_ = 64 - kFirstBits;  // 64 less the binary logarithm of the number of slots
  std::vector<Slot> slots_ =
      std::vector<Slot>(std::size_t{1} << kFirstBits);  // half in use at most
  std::size_t size_ = 0;
};

}  // namespace fovea
