// Frames that an evaluation scores: read one by one, scored in parallel.
#pragma once

#include <mutex>
#include <variant>
#include <vector>

#include "fovea/core/parallel.h"
#include "fovea/core/process_memory.h"
#include "fovea/evaluation/evaluate.h"

namespace fovea {

/// A frame of the drive, or the reason why it cannot be scored.
std::variant<Frame, UnscoredFrame> load_scored_frame(const FrameSource& drive, int index);

/// score(frame) of each frame, in the order of frames.
template <class Score>
auto score_frames(const std::vector<PlacedFrame>& frames, const EvaluationProgress& progress,
                  Score&& score) {
  std::vector<decltype(score(frames.front()))> scores(frames.size());
  std::mutex progress_mutex;
  std::size_t done = 0;
  parallel_for(frames.size(), 1, [&](std::size_t i) {
    scores[i] = score(frames[i]);
    release_free_memory();  // each frame has blocks of other sizes, and the allocator keeps them
    if (!progress) return;
    const std::lock_guard lock(progress_mutex);
    progress(++done, frames.size());
  });
  return scores;
}

}  // namespace fovea
