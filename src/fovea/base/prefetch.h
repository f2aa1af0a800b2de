// A stage of a pipeline: the next item is made while the one before is used.
#pragma once

#include <functional>
#include <optional>
#include <utility>

#include "fovea/base/parallel.h"

namespace fovea {

/// Items made one after the other, one ahead of the one who takes them, by the threads of the
/// parallel loops: stages chained by a `make` that takes from the stage before share these, and
/// whichever stage has more to do gets more of them. Items come in the order in which they were
/// made, so that the result does not depend on who waits for whom. (What must wait, as for a clock,
/// needs a thread of its own: `Producer`.)
template <class T>
class Prefetch {
 public:
  /// Makes the next item, or nothing at the end. As `Background` asks, it waits for nothing but
  /// loops and other stages.
  using Make = std::function<std::optional<T>()>;

  /// @param ahead  false: next() makes each item when it is asked for
  Prefetch(bool ahead, Make make) : ahead_(ahead), make_(std::move(make)) {
    if (ahead_) begin();
  }

  /// The next item; nothing after the last one. What `make` throws is thrown here, after the items
  /// made before it, and ends them.
  std::optional<T> next() {
    if (!ahead_) return make_();
    making_.wait();
    std::optional<T> item = std::exchange(item_, std::nullopt);
    if (item) begin();
    return item;
  }

 private:
  void begin() {
    making_.run([this] { item_ = make_(); });
  }

  const bool ahead_;
  const Make make_;
  std::optional<T> item_;
  Background making_;  // last: uses all of the above
};

}  // namespace fovea
