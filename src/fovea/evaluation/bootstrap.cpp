#include "fovea/evaluation/bootstrap.h"

#include <algorithm>

#include "fovea/core/random.h"

namespace fovea {
namespace {

constexpr std::size_t kResamples = 2000;
constexpr std::uint64_t kSeed = 1979;

Interval middle_95(std::vector<double>& means) {
  std::sort(means.begin(), means.end());
  constexpr std::size_t kTail = kResamples / 40;
  return {means[kTail], means[kResamples - 1 - kTail]};
}

}  // namespace

FrameSums frame_sums(const PointErrors& errors) {
  FrameSums sums;
  sums.points = errors.position.size();
  for (std::size_t i = 0; i < sums.points; ++i) {
    const double me = errors.position[i],
                 te = errors.color.empty() ? ErrorFigures::kNone : errors.color[i];
    sums.me += me;
    sums.te += te;
    sums.mtme += me * te;
    sums.te_cross += errors.color_cross.empty() ? ErrorFigures::kNone : errors.color_cross[i];
  }
  return sums;
}

MeanIntervals bootstrap_means(const std::vector<FrameSums>& frames) {
  std::vector<FrameSums> filled;
  for (const FrameSums& frame : frames) {
    if (frame.points > 0) filled.push_back(frame);
  }
  if (filled.size() < 2) return {};
  std::vector<double> me, te, mtme, te_cross;
  for (std::size_t resample = 0; resample < kResamples; ++resample) {
    Random random = Random::of_item(kSeed, 0, resample);
    FrameSums drawn;
    for (std::size_t i = 0; i < filled.size(); ++i) {
      const FrameSums& frame = filled[random.below(filled.size())];
      drawn.points += frame.points;
      drawn.me += frame.me;
      drawn.te += frame.te;
      drawn.mtme += frame.mtme;
      drawn.te_cross += frame.te_cross;
    }
    const auto points = static_cast<double>(drawn.points);
    me.push_back(drawn.me / points);
    te.push_back(drawn.te / points);
    mtme.push_back(drawn.mtme / points);
    te_cross.push_back(drawn.te_cross / points);
  }
  return {middle_95(me), middle_95(te), middle_95(mtme), middle_95(te_cross)};
}

}  // namespace fovea
