// Figures of a set of evaluated points, gathered frame by frame.
#pragma once

#include "fovea/evaluation/bootstrap.h"
#include "fovea/evaluation/metrics.h"

namespace fovea {

struct SetFigures {
  ErrorFigures figures;
  MeanIntervals intervals;   ///< of the figures' means
  std::size_t left_out = 0;  ///< evaluated points that are not in the set
};

class SetCollector {
 public:
  /// Adds one frame's points that are in the set. @param left_out  those that are not
  void add(const PointErrors& frame, std::size_t left_out = 0);
  SetFigures figures() const;
  const PointErrors& errors() const { return errors_; }

 private:
  PointErrors errors_;
  std::vector<FrameSums> frames_;
  std::size_t left_out_ = 0;
};

}  // namespace fovea
