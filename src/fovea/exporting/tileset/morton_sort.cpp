#include "fovea/exporting/tileset/morton_sort.h"

#include <algorithm>
#include <span>

namespace fovea {
namespace {

/// What all runs together read ahead.
constexpr std::size_t kBufferBytes = std::size_t{64} << 20;
constexpr std::size_t kMinBufferPoints = 256, kMaxBufferPoints = std::size_t{1} << 16;

}  // namespace

MortonSort::MortonSort(const std::filesystem::path& folder, std::size_t run_points)
    : run_points_(std::max<std::size_t>(run_points, 1)), file_(folder) {}

void MortonSort::add(const CubePoint& point) {
  pending_.push_back(point);
  if (pending_.size() == run_points_) write_run();
}

void MortonSort::write_run() {
  std::sort(pending_.begin(), pending_.end(), morton_less);
  file_.append(pending_);
  runs_.push_back({written_, written_ + pending_.size()});
  written_ += pending_.size();
  pending_.clear();
}

bool MortonSort::refill(Run& run) const {
  const std::size_t wanted = std::min(std::clamp(kBufferBytes / sizeof(CubePoint) / runs_.size(),
                                                 kMinBufferPoints, kMaxBufferPoints),
                                      run.end - run.begin);
  run.buffer.resize(wanted);
  run.at = 0;
  file_.read(run.begin * sizeof(CubePoint), std::span(run.buffer));
  run.begin += wanted;
  return wanted > 0;
}

auto MortonSort::later() const {
  return [this](std::size_t a, std::size_t b) {
    return morton_less(runs_[b].buffer[runs_[b].at], runs_[a].buffer[runs_[a].at]);
  };
}

void MortonSort::finish() {
  if (!pending_.empty()) write_run();
  std::vector<CubePoint>().swap(pending_);  // merging needs the memory
  for (std::size_t i = 0; i < runs_.size(); ++i) {
    if (refill(runs_[i])) heap_.push_back(i);
  }
  std::make_heap(heap_.begin(), heap_.end(), later());
}

bool MortonSort::next(CubePoint& point) {
  if (heap_.empty()) return false;
  std::pop_heap(heap_.begin(), heap_.end(), later());
  Run& run = runs_[heap_.back()];
  point = run.buffer[run.at++];
  if (run.at < run.buffer.size() || refill(run)) {
    std::push_heap(heap_.begin(), heap_.end(), later());
  } else {
    heap_.pop_back();
  }
  return true;
}

}  // namespace fovea
