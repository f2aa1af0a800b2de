// The frame that each point of a tile comes from: points are added frame by frame, so that a few
// runs tell it of all.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace fovea {

/// A column of frame indices, of up to 2^32 - 1 points; of any order, but small where equal ones
/// lie side by side.
class FrameRuns {
 public:
  using value_type = std::int32_t;
  struct Run {
    std::int32_t frame = 0;
    std::uint32_t end = 0;  ///< one past its last point
    friend bool operator==(const Run&, const Run&) = default;
  };

  FrameRuns() = default;
  explicit FrameRuns(std::span<const std::int32_t> frames) {
    for (const std::int32_t frame : frames) push_back(frame);
  }

  bool empty() const { return runs_.empty(); }
  std::size_t size() const { return runs_.empty() ? 0 : runs_.back().end; }
  /// Of point i; in a time that grows with the logarithm of the number of runs.
  std::int32_t operator[](std::size_t i) const { return runs_[run_of(i)].frame; }
  std::int32_t back() const { return runs_.back().frame; }
  /// In order, no two neighbours of one frame.
  const std::vector<Run>& runs() const { return runs_; }

  void push_back(std::int32_t frame) {
    if (runs_.empty() || runs_.back().frame != frame) {
      runs_.push_back({frame, static_cast<std::uint32_t>(size())});
    }
    ++runs_.back().end;
  }
  /// Keeps only the points at `indices` (ascending).
  void keep(std::span<const std::uint32_t> indices);
  /// Calls f(i, frame) for the points from `first` on, in order, while it returns true.
  template <class F>
  void for_each_from(std::size_t first, F&& f) const {
    if (first >= size()) return;
    std::size_t i = first;
    for (std::size_t run = run_of(first); run < runs_.size(); ++run) {
      for (; i < runs_[run].end; ++i) {
        if (!f(i, runs_[run].frame)) return;
      }
    }
  }
  /// @param frames  as many as there are points
  void copy_to(std::span<std::int32_t> frames) const;

  friend bool operator==(const FrameRuns&, const FrameRuns&) = default;

 private:
  std::size_t run_of(std::size_t i) const;

  std::vector<Run> runs_;
};

}  // namespace fovea
