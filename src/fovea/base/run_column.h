// A column of values of which mostly many that follow each other are equal.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace fovea {

/// Keeps where each run of equal values ends: of any order, but small where equal ones lie side by
/// side. Up to 2^32 - 1 values.
template <class Value>
class RunColumn {
 public:
  using value_type = Value;
  struct Run {
    Value value{};
    std::uint32_t end = 0;  ///< one past its last place
    friend bool operator==(const Run&, const Run&) = default;
  };

  RunColumn() = default;
  explicit RunColumn(std::span<const Value> values) {
    for (const Value value : values) push_back(value);
  }

  bool empty() const { return runs_.empty(); }
  std::size_t size() const { return runs_.empty() ? 0 : runs_.back().end; }
  /// In a time that grows with the logarithm of the number of runs.
  Value operator[](std::size_t i) const { return runs_[run_of(i)].value; }
  Value back() const { return runs_.back().value; }
  /// In order, no two neighbours of one value.
  const std::vector<Run>& runs() const { return runs_; }

  void push_back(Value value, std::uint32_t count = 1) {
    if (runs_.empty() || runs_.back().value != value) {
      runs_.push_back({value, static_cast<std::uint32_t>(size())});
    }
    runs_.back().end += count;
  }
  /// Keeps only what is at `indices` (ascending).
  void keep(std::span<const std::uint32_t> indices) {
    RunColumn kept;
    auto run = runs_.begin();
    for (const std::uint32_t i : indices) {
      while (i >= run->end) ++run;
      kept.push_back(run->value);
    }
    *this = std::move(kept);
  }
  /// Calls f(i, value) from place `first` on, in order, while it returns true.
  template <class F>
  void for_each_from(std::size_t first, F&& f) const {
    if (first >= size()) return;
    std::size_t i = first;
    for (std::size_t run = run_of(first); run < runs_.size(); ++run) {
      for (; i < runs_[run].end; ++i) {
        if (!f(i, runs_[run].value)) return;
      }
    }
  }
  /// @param values  as many as there are
  void copy_to(std::span<Value> values) const {
    auto to = values.begin();
    for (const Run& run : runs_) {
      const auto end = values.begin() + run.end;
      std::fill(to, end, run.value);
      to = end;
    }
  }

  friend bool operator==(const RunColumn&, const RunColumn&) = default;

 private:
  std::size_t run_of(std::size_t i) const {
    const auto run = std::upper_bound(runs_.begin(), runs_.end(), i,
                                      [](std::size_t at, const Run& r) { return at < r.end; });
    return static_cast<std::size_t>(run - runs_.begin());
  }

  std::vector<Run> runs_;
};

}  // namespace fovea
