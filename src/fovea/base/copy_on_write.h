// A value that several hold and that is copied only when one of them changes it: snapshots for
// other threads at no cost.
#pragma once

#include <atomic>
#include <cstddef>
#include <memory>
#include <utility>

namespace fovea {

/// Handles may be copied, read and dropped in any threads; one handle belongs to one thread at a
/// time.
template <class T>
class CopyOnWrite {
 public:
  CopyOnWrite() : CopyOnWrite(T()) {}
  explicit CopyOnWrite(T value) : box_(new Box{std::move(value)}) {}
  CopyOnWrite(const CopyOnWrite& other) : box_(other.box_) { ++box_->owners; }
  CopyOnWrite(CopyOnWrite&& other) noexcept : box_(std::exchange(other.box_, nullptr)) {}
  CopyOnWrite& operator=(CopyOnWrite other) noexcept {
    std::swap(box_, other.box_);
    return *this;
  }
  ~CopyOnWrite() { release(); }

  const T& operator*() const { return box_->value; }
  const T* operator->() const { return &box_->value; }

  /// To be changed: a copy of its own where others hold the value, too.
  T& write() {
    // What the last other owner read, it read before it let go: hence the order of its decrement
    // and this look (not std::shared_ptr's use_count, which promises none).
    if (box_->owners.load(std::memory_order_acquire) != 1) {
      *this = CopyOnWrite(box_->value);
    }
    return box_->value;
  }

 private:
  struct Box {
    T value;
    std::atomic<std::size_t> owners{1};
  };
  void release() {
    if (box_ != nullptr && box_->owners.fetch_sub(1, std::memory_order_acq_rel) == 1) delete box_;
  }

  Box* box_;
};

}  // namespace fovea
