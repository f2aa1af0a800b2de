#include "fovea/mapping/fusion/exposure_graph.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>

#include "fovea/core/median.h"

namespace fovea {
namespace {

constexpr int kGreen = 1;
// Standard deviations, stops.
constexpr double kChainPerMeter = 0.0004;  // between submaps that follow each other
constexpr double kDriftPerMeter = 0.0002;
constexpr double kRevisit = 0.01;      // of a revisited place
constexpr double kMetered = 0.03;      // of images with a known exposure
constexpr double kTypicalTint = 0.05;  // of red and blue against green
constexpr double kTypicalColor = 0.1;  // of the most frequent color
constexpr double kAnchor = 0.0001;     // of the first submap
constexpr double kRobust = 1.5;        // width of Huber's kernel, standard deviations
constexpr int kRounds = 5;
/// If no loop closes, the gains of older submaps stay.
constexpr std::size_t kRecentSubmaps = 256;
/// Of a camera whose exposure has hardly changed: sRGB's.
constexpr double kUsualSlope = 1 / 2.4;

double square(double value) { return value * value; }

double robust_weight(double error, double deviation) {
  return std::min(1.0, kRobust * deviation / std::max(std::abs(error), 1e-9)) / square(deviation);
}

}  // namespace

/// Normal equations of the submaps from `first` on, and of the drift; submaps before are fixed.
class ExposureGraph::Equations {
 public:
  Equations(std::size_t first, const std::vector<double>& gains, double drift)
      : first_(first),
        gains_(gains),
        drift_(drift),
        b_(Eigen::VectorXd::Zero(Eigen::Index(gains.size() - first + 1))) {}

  /// gain[submap] = value
  void add(std::size_t submap, double value, double weight) {
    if (submap >= first_) add({{place(submap), 1}}, value - gains_[submap], weight);
  }
  /// drift = value
  void add_drift(double value, double weight) { add({{last(), 1}}, value - drift_, weight); }
  /// gain[later] - gain[earlier] - length * drift = value
  void add(std::size_t earlier, std::size_t later, double length, double value, double weight) {
    const double error = value - gains_[later] + gains_[earlier] + length * drift_;
    std::vector<Term> terms;
    if (earlier >= first_) terms.push_back({place(earlier), -1});
    if (later >= first_) terms.push_back({place(later), 1});
    if (length > 0) terms.push_back({last(), -length});
    add(terms, error, weight);
  }
  /// Changes of the gains, then of the drift.
  Eigen::VectorXd solve() const {
    Eigen::SparseMatrix<double> H(b_.size(), b_.size());
    H.setFromTriplets(entries_.begin(), entries_.end());
    return Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>, Eigen::Lower>(H).solve(b_);
  }

 private:
  struct Term {
    Eigen::Index place;  // ascending
    double factor;
  };
  Eigen::Index place(std::size_t submap) const { return Eigen::Index(submap - first_); }
  Eigen::Index last() const { return b_.size() - 1; }
  void add(const std::vector<Term>& terms, double error, double weight) {
    for (std::size_t i = 0; i < terms.size(); ++i) {
      b_[terms[i].place] += weight * terms[i].factor * error;
      for (std::size_t j = 0; j <= i; ++j) {
        entries_.emplace_back(int(terms[i].place), int(terms[j].place),
                              weight * terms[i].factor * terms[j].factor);
      }
    }
  }

  std::size_t first_;
  const std::vector<double>& gains_;
  double drift_;
  std::vector<Eigen::Triplet<double>> entries_;  // of the lower triangle
  Eigen::VectorXd b_;
};

bool ExposureGraph::Camera::is_metered() const {
  return std::all_of(levels.begin(), levels.end(),
                     [](const Level& level) { return level.exposures == level.images; });
}

double ExposureGraph::Camera::slope() const {
  constexpr double kEnough = 0.1;  // squared stops
  return squares > kEnough ? std::clamp(products / squares, 0.2, 1.5) : kUsualSlope;
}

void ExposureGraph::add_submap(double length) {
  gains_.push_back(gains_.empty() ? LogGain(LogGain::Zero()) : gains_.back());
  lengths_.push_back(length);
}

void ExposureGraph::add(const ImageLevel& image) {
  Camera& camera = cameras_[image.camera];
  camera.levels.resize(gains_.size());
  Level& level = camera.levels.back();
  level.gain += image.gain.cast<double>();
  ++level.images;
  if (image.color) {
    level.color += image.color->cast<double>();
    ++level.colors;
  }
  if (image.exposure) {
    level.exposure += *image.exposure;
    ++level.exposures;
    if (camera.last && camera.last->exposure) {
      const double change = *image.exposure - *camera.last->exposure;
      camera.products += change * double((image.gain - camera.last->gain).mean());
      camera.squares += change * change;
    }
  }
  camera.last = image;
}

void ExposureGraph::add_revisit(std::size_t earlier, std::size_t later, const LogGain& difference) {
  revisits_.push_back({earlier, later, difference});
}

std::vector<ExposureGraph::Prior> ExposureGraph::priors_of(const Camera& camera, int channel,
                                                           const std::vector<double>& gains) const {
  std::vector<Prior> priors;
  std::vector<double> constants;  // of the camera, as each submap has it
  constants.reserve(camera.levels.size());
  const bool is_metered = camera.is_metered();
  for (std::size_t submap = 0; submap < camera.levels.size(); ++submap) {
    const Level& level = camera.levels[submap];
    // What the gain of the submap is, but for a constant.
    double gain = 0;
    double deviation = is_metered ? kMetered : kTypicalColor;
    if (channel != kGreen && level.colors > 0) {
      // White balance is in no exposure, but the tint of the road is the same everywhere.
      const double tint = (level.color[channel] - level.color[kGreen]) / level.colors;
      gain = double(gains_[submap][kGreen]) - tint;
      deviation = kTypicalTint;
    } else if (is_metered && level.images > 0) {
      gain = (level.gain[channel] - camera.slope() * level.exposure) / level.images;
    } else if (!is_metered && level.colors > 0) {
      gain = -level.color[channel] / level.colors;
    } else {
      continue;
    }
    priors.push_back({submap, gain, deviation});
    constants.push_back(gain - gains[submap]);
  }
  if (priors.empty()) return {};
  const double constant = median_of(std::move(constants));
  for (Prior& prior : priors) prior.gain -= constant;
  return priors;
}

void ExposureGraph::optimize_channel(int channel, std::size_t first) {
  std::vector<double> gains;
  gains.reserve(gains_.size());
  for (const LogGain& gain : gains_) gains.push_back(double(gain[channel]));
  for (int round = 0; round < kRounds; ++round) {
    Equations equations(first, gains, drift_[channel]);
    equations.add(0, 0, 1 / square(kAnchor));
    equations.add_drift(0, 1 / square(kDriftPerMeter));
    for (std::size_t submap = std::max<std::size_t>(first, 1); submap < gains.size(); ++submap) {
      const double deviation = kChainPerMeter * std::max(lengths_[submap], 1.0);
      equations.add(submap - 1, submap, lengths_[submap], 0, 1 / square(deviation));
    }
    for (const Revisit& revisit : revisits_) {
      if (revisit.later < first) continue;
      // Both show one surface: earlier + its gain = later + its gain.
      equations.add(revisit.earlier, revisit.later, 0, -double(revisit.difference[channel]),
                    1 / square(kRevisit));
    }
    for (const auto& [number, camera] : cameras_) {
      for (const Prior& prior : priors_of(camera, channel, gains)) {
        const double error = prior.gain - gains[prior.submap];
        equations.add(prior.submap, prior.gain, robust_weight(error, prior.deviation));
      }
    }
    const Eigen::VectorXd change = equations.solve();
    for (std::size_t submap = first; submap < gains.size(); ++submap) {
      gains[submap] += change[Eigen::Index(submap - first)];
    }
    drift_[channel] += change[change.size() - 1];
  }
  for (std::size_t submap = first; submap < gains.size(); ++submap) {
    gains_[submap][channel] = static_cast<float>(gains[submap]);
  }
}

void ExposureGraph::optimize() {
  if (gains_.empty()) return;
  const bool is_local = used_revisits_ == revisits_.size() && gains_.size() > kRecentSubmaps;
  const std::size_t first = is_local ? gains_.size() - kRecentSubmaps : 0;
  for (const int channel : {kGreen, 0, 2}) optimize_channel(channel, first);
  used_revisits_ = revisits_.size();
}

}  // namespace fovea
