// A hash table for millions of searches in each frame.
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace fovea {

/// Maps 63-bit keys to values, like std::unordered_map. One flat table with open addressing and
/// linear probing (Knuth, The Art of Computer Programming 3, 6.4): a search usually reads one cache
/// line. Values should be small, since the table moves them.
template <class Value>
class FlatMap {
 public:
  std::size_t size() const { return size_; }

  /// @return nullptr if the key has no value; valid until the next try_emplace() or erase()
  const Value* find(std::uint64_t key) const {
    const Slot& slot = slots_[place_of(key)];
    return slot.key == key ? &slot.value : nullptr;
  }
  Value* find(std::uint64_t key) { return const_cast<Value*>(std::as_const(*this).find(key)); }

  /// @param key  below 2^63
  /// @return the value of the key and whether the key is new; a new key gets `value`. The pointer
  /// is valid until the next try_emplace() or erase().
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

  /// Removes a key that has a value.
  void erase(std::uint64_t key) {
    const std::size_t mask = slots_.size() - 1;
    std::size_t place = place_of(key);
    --size_;
    // Later entries of the same probe sequence move up: Knuth's algorithm R.
    for (std::size_t next = (place + 1) & mask; slots_[next].key != kFree;
         next = (next + 1) & mask) {
      const std::size_t home = home_of(slots_[next].key);
      if (((next - home) & mask) < ((next - place) & mask)) continue;  // still reachable
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
    // Fibonacci hashing: the highest bits of the product depend on all bits of the key.
    return key * 0x9e3779b97f4a7c15ull >> shift_;
  }
  /// Place of the slot with this key, or of the free slot for it.
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

  int shift_ = 64 - kFirstBits;  // 64 minus the binary logarithm of the number of slots
  std::vector<Slot> slots_ =
      std::vector<Slot>(std::size_t{1} << kFirstBits);  // at most half are in use
  std::size_t size_ = 0;
};

}  // namespace fovea
