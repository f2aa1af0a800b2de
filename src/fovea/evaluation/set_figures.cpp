#include "fovea/evaluation/set_figures.h"

namespace fovea {

void SetCollector::add(const PointErrors& frame, std::size_t left_out) {
  errors_.append(frame);
  frames_.push_back(frame_sums(frame));
  left_out_ += left_out;
}

SetFigures SetCollector::figures() const {
  return {summarize(errors_), bootstrap_means(frames_), left_out_};
}

}  // namespace fovea
