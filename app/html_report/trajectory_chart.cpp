#include "app/html_report/trajectory_chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "app/html_report/charts.h"
#include "app/html_report/color_classes.h"
#include "app/html_report/markup.h"

namespace fovea::app {
namespace {

constexpr double kWidth = 720, kMinHeight = 150, kMaxHeight = 460, kMargin = 34;

/// From metres to the picture, one scale for both axes.
class Ground {
 public:
  explicit Ground(const std::vector<Eigen::Vector2d>& points) {
    Eigen::Vector2d high = points.front();
    low_ = high;
    for (const Eigen::Vector2d& p : points) {
      low_ = low_.cwiseMin(p);
      high = high.cwiseMax(p);
    }
    const Eigen::Vector2d extent = (high - low_).cwiseMax(1e-3);
    scale_ = std::min((kWidth - 2 * kMargin) / extent.x(), (kMaxHeight - 2 * kMargin) / extent.y());
    height_ = std::max(kMinHeight, extent.y() * scale_ + 2 * kMargin);
    offset_ = 0.5 * (Eigen::Vector2d(kWidth, height_) - scale_ * extent);
  }
  double height() const { return height_; }
  double scale() const { return scale_; }  ///< units a metre
  Eigen::Vector2d at(const Eigen::Vector2d& p) const {
    const Eigen::Vector2d q = scale_ * (p - low_) + offset_;
    return {q.x(), height_ - q.y()};
  }

 private:
  Eigen::Vector2d low_, offset_;
  double scale_ = 1, height_ = kMinHeight;
};

std::string path_of(const std::vector<Eigen::Vector2d>& points, const Ground& ground) {
  std::string path;
  for (const Eigen::Vector2d& p : points) {
    const Eigen::Vector2d q = ground.at(p);
    path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? "M" : "L", q.x(), q.y());
  }
  return path;
}

/// Mean TE of a frame over its points in all scored cameras.
std::map<int, double> te_by_frame(const EvaluationReport& report) {
  std::map<int, std::pair<double, double>> sums;
  for (const ViewReport& view : report.views) {
    if (view.figures.points == 0) continue;
    const auto points = static_cast<double>(view.figures.points);
    sums[view.frame].first += points * view.figures.te_mean;
    sums[view.frame].second += points;
  }
  std::map<int, double> means;
  for (const auto& [frame, sum] : sums) means[frame] = sum.first / sum.second;
  return means;
}

std::string scale_bar(const Ground& ground) {
  const double metres = round_step(kWidth / ground.scale(), 8);
  const double y = ground.height() - 12;
  return fmt::format(
      "<path class=\"axis\" d=\"M{0:.1f} {2:.1f}v5H{1:.1f}v-5\"/>\n"
      "<text class=\"label\" x=\"{3:.1f}\" y=\"{4:.1f}\">{5:g} m</text>\n",
      kMargin, kMargin + metres * ground.scale(), y, kMargin + metres * ground.scale() + 8, y + 6,
      metres);
}

}  // namespace

std::string ground_track_chart(const GroundTrack& track, const ErrorScale& scale) {
  if (track.line.size() < 2) return "";
  std::vector<Eigen::Vector2d> all = track.line;
  all.insert(all.end(), track.dashed.begin(), track.dashed.end());
  const Ground ground(all);
  std::string svg = fmt::format(
      "<svg class=\"chart\" viewBox=\"0 0 {} {:.0f}\" role=\"img\" aria-label=\"The drive from "
      "above\">\n",
      kWidth, ground.height());
  if (!track.dashed.empty()) {
    svg += fmt::format("<path class=\"navigation\" d=\"{}\"/>\n", path_of(track.dashed, ground));
  }
  svg += fmt::format("<path class=\"track\" d=\"{}\"/>\n", path_of(track.line, ground));
  for (const GroundTrack::Spot& spot : track.spots) {
    const Eigen::Vector2d q = ground.at(spot.place);
    svg += fmt::format(
        "<circle class=\"spot h{}\" data-at=\"{}\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{}\">"
        "<title>{}</title></circle>\n",
        scale.class_of(spot.value), spot.frame, q.x(), q.y(), track.spots.size() > 60 ? 4 : 7,
        escaped(spot.hint));
  }
  const Eigen::Vector2d start = ground.at(track.line.front());
  svg += fmt::format(
      "<text class=\"label\" x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\">start</text>\n",
      std::clamp(start.x(), 20.0, kWidth - 20), std::max(12.0, start.y() - 13));
  if (track.north_up) {
    svg += fmt::format(
        "<path class=\"axis\" d=\"M{0} 30V10l-4 7m4 -7l4 7\"/>"
        "<text class=\"label\" x=\"{0}\" y=\"42\" text-anchor=\"middle\">N</text>\n",
        kWidth - 18);
  }
  return svg + scale_bar(ground) + "</svg>\n";
}

std::string trajectory_chart(const std::vector<FrameRecord>& frames, const EvaluationReport& report,
                             bool north_up) {
  GroundTrack track;
  track.north_up = north_up;
  const std::map<int, double> te = te_by_frame(report);
  for (const FrameRecord& frame : frames) {
    track.line.emplace_back(frame.T_local_lidar.translation().head<2>());
    if (frame.T_local_lidar_navigation) {
      track.dashed.emplace_back(frame.T_local_lidar_navigation->translation().head<2>());
    }
    if (const auto scored = te.find(frame.index); scored != te.end()) {
      track.spots.push_back({frame.index, track.line.back(), scored->second,
                             fmt::format("frame {}: TE {:.1f}", frame.index, scored->second)});
    }
  }
  return ground_track_chart(track, kTeScale);
}

}  // namespace fovea::app
