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
  explicit RunColumn(std::span<const Value> values) { append(values); }

  bool empty() const { return runs_.empty(); }
  std::size_t size() const { return runs_.empty() ? 0 : runs_.back().end; }
  /// In a time that grows with the logarithm of the number of runs.
  Value operator[](std::size_t i) const { return runs_[run_of(i)].value; }
  Value back() const { return runs_.back().value; }
  /// In order, no two neighbours of one value.
  const std::vector<Run>& runs() const { return runs_; }

  void push_back(Value value, std::uint32_t count = 1) {
    if (runs_.empty() || runs_.back().value != value) {
      // What is in reserve takes memory, too.
      if (runs_.size() == runs_.capacity()) runs_.reserve(runs_.size() + runs_.size() / 4 + 4);
      runs_.push_back({value, static_cast<std::uint32_t>(size())});
    }
    runs_.back().end += count;
  }
  void append(std::span<const Value> values) {
    for (auto at = values.begin(); at != values.end();) {
      // A NaN equals nothing, itself neither.
      const auto end =
          std::find_if(at + 1, values.end(), [&](const Value& value) { return value != *at; });
      push_back(*at, static_cast<std::uint32_t>(end - at));
      at = end;
    }
  }
  /// Keeps only what is at `indices` (ascending).
  void keep(std::span<const std::uint32_t> indices) {
    RunColumn kept;
    auto at = indices.begin();
    for (const Run& run : runs_) {
      const auto next =
          std::find_if(at, indices.end(), [&](std::uint32_t index) { return index >= run.end; });
      if (next != at) kept.push_back(run.value, static_cast<std::uint32_t>(next - at));
      at = next;
    }
    *this = std::move(kept);
  }
  /// Puts a value in the place of those at `indices` (ascending).
  void put(std::span<const std::uint32_t> indices, Value value) {
    RunColumn changed;
    auto at = indices.begin();
    for_each_run([&](std::uint32_t begin, std::uint32_t end, Value before) {
      for (std::uint32_t i = begin; i < end;) {
        const std::uint32_t next = at == indices.end() ? end : std::min(*at, end);
        if (next > i) changed.push_back(before, next - i);
        i = next;
        if (i < end) {
          changed.push_back(value);
          ++i;
          ++at;
        }
      }
    });
    *this = std::move(changed);
  }
  /// Calls f(begin, end, value) for each run, in order.
  template <class F>
  void for_each_run(F&& f) const {
    for_each_run_from(0, [&](std::uint32_t begin, std::uint32_t end, Value value) {
      f(begin, end, value);
      return true;
    });
  }
  /// Calls f(begin, end, value) for each run, or what is left of it, from place `first` on, while
  /// it returns true.
  template <class F>
  void for_each_run_from(std::size_t first, F&& f) const {
    if (first >= size()) return;
    auto begin = static_cast<std::uint32_t>(first);
    for (std::size_t run = run_of(first); run < runs_.size(); ++run) {
      if (!f(begin, runs_[run].end, runs_[run].value)) return;
      begin = runs_[run].end;
    }
  }
  /// @param values  as many as there are
  void copy_to(std::span<Value> values) const {
    for_each_run([&](std::uint32_t begin, std::uint32_t end, Value value) {
      std::fill(values.begin() + begin, values.begin() + end, value);
    });
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
