#include "fovea/evaluation/compare_color_rules.h"

#include <map>

#include "fovea/core/parallel.h"
#include "fovea/errors.h"
#include "fovea/evaluation/sharpness.h"
#include "fovea/evaluation/surface_normals.h"
#include "fovea/evaluation/training_views.h"

namespace fovea {
namespace {

constexpr std::size_t kFramesAtOnce = 4;  // in memory
constexpr std::uint32_t kNone = 0xffffffffu;

/// What a comparison asks, and what all its steps need to know.
struct Comparison {
  const FrameSource& drive;
  std::vector<std::size_t> places;  // of the cameras in the drive's calibration
  std::vector<PlacedFrame> scored;
  std::vector<FrameRecord> training;
  ColoredPoints points;
};

/// A held-out view: its evaluated points, the map point nearest to each, and the floor.
struct HeldOutView {
  EvaluatedView view;
  std::vector<std::uint32_t> nearest;
  std::vector<float> distance;  // m
  std::vector<Rgb> floor;       // the best that a training view gave ...
  std::vector<float> floor_error;
};

/// Evaluated points by the map point nearest to them: those of point i are
/// members[first[i]] ... members[first[i + 1] - 1].
struct Askers {
  struct Asker {
    std::uint32_t view, point;
  };
  std::vector<std::uint32_t> first;
  std::vector<Asker> members;
};

/// Calls f(i) for frames, some at a time, so that no more are in memory.
template <class F>
void for_each_batch(std::size_t count, F&& f) {
  for (std::size_t begin = 0; begin < count; begin += kFramesAtOnce) {
    f(begin, std::min(kFramesAtOnce, count - begin));
  }
}

void improve_floor(HeldOutView& view, std::uint32_t point, Rgb color) {
  const float error = color_error(view.view.color[point], to_float(color), view.view.grey);
  if (error >= view.floor_error[point]) return;
  view.floor_error[point] = error;
  view.floor[point] = color;
}

std::vector<HeldOutView> load_held_out(const Comparison& c) {
  const KdTree tree(c.points.position);
  const DriveInfo& info = c.drive.info();
  std::vector<std::vector<HeldOutView>> by_frame(c.scored.size());
  parallel_for(c.scored.size(), 1, [&](std::size_t i) {
    const PlacedFrame& placed = c.scored[i];
    if (placed.index < info.begin || placed.index >= info.end) return;
    const LoadedFrame loaded = c.drive.load(placed.index);
    if (!std::holds_alternative<Frame>(loaded)) return;
    const Frame& frame = std::get<Frame>(loaded);
    const PointCloud scan = compensated_scan(frame.scan, placed, info);
    for (const std::size_t place : c.places) {
      if (frame.images.at(place).empty()) continue;
      HeldOutView held_out;
      const Camera camera = info.camera_at(place, placed.index).at_image(placed.motion);
      held_out.view =
          evaluated_view(frame.scan, scan, placed, camera, frame.images.at(place), c.points.origin);
      for (const Eigen::Vector3f& p : held_out.view.position) {
        const KdTree::Neighbor neighbor = tree.nearest(p);
        held_out.nearest.push_back(neighbor.index);
        held_out.distance.push_back(std::sqrt(neighbor.squared_distance));
      }
      held_out.floor.resize(held_out.nearest.size());
      held_out.floor_error.assign(held_out.nearest.size(), std::numeric_limits<float>::infinity());
      for (std::uint32_t p = 0; p < held_out.nearest.size(); ++p) {
        // The map's own colour is some training view's, though not always of one that still sees
        // the point once the whole map stands.
        improve_floor(held_out, p, to_rgb(c.points.color[held_out.nearest[p]]));
      }
      held_out.view.position = {};
      by_frame[i].push_back(std::move(held_out));
    }
  });
  std::vector<HeldOutView> views;
  for (auto& frame : by_frame) std::move(frame.begin(), frame.end(), std::back_inserter(views));
  return views;
}

Askers sort_by_nearest(const std::vector<HeldOutView>& views, std::size_t points) {
  Askers askers;
  askers.first.assign(points + 1, 0);
  for (const HeldOutView& view : views) {
    for (const std::uint32_t point : view.nearest) ++askers.first[point + 1];
  }
  for (std::size_t i = 0; i < points; ++i) askers.first[i + 1] += askers.first[i];
  askers.members.resize(askers.first.back());
  std::vector<std::uint32_t> next(askers.first.begin(), askers.first.end() - 1);
  for (std::uint32_t v = 0; v < views.size(); ++v) {
    for (std::uint32_t i = 0; i < views[v].nearest.size(); ++i) {
      askers.members[next[views[v].nearest[i]]++] = {v, i};
    }
  }
  return askers;
}

/// Shows one view to all points; each point's state, and the floor of its askers, belongs to one
/// thread.
void show(const TrainingView& view, const ColoredPoints& points,
          const std::vector<Eigen::Vector3f>& normals, const Askers& askers,
          std::vector<ColorState>& states, std::vector<HeldOutView>& held_out) {
  const Eigen::Isometry3f T_cam_map =
      RigidMotion(view.T_cam_local * Eigen::Translation3d(points.origin)).cast<float>();
  const Eigen::Vector3f center = T_cam_map.inverse().translation();
  parallel_for(points.runs.size(), 4, [&](std::size_t r) {
    const PointRun& run = points.runs[r];
    if (run.distance_to(center) > kViewReach) return;
    for (std::uint32_t i = run.begin; i < run.end; ++i) {
      const auto seen = observation_of(view, T_cam_map, points.position[i], normals[i]);
      if (!seen) continue;
      observe(states[i], *seen, i);
      if (!seen->visible) continue;
      for (std::uint32_t k = askers.first[i]; k < askers.first[i + 1]; ++k) {
        improve_floor(held_out[askers.members[k].view], askers.members[k].point, seen->color);
      }
    }
  });
}

std::vector<ColorState> show_training_frames(const Comparison& c,
                                             std::vector<HeldOutView>& held_out) {
  const std::vector<float> spacing = sample_spacing(c.points.position);
  const std::vector<Eigen::Vector3f> normals = surface_normals(c.points.position);
  const Askers askers = sort_by_nearest(held_out, c.points.position.size());
  std::vector<ColorState> states(c.points.position.size());
  std::optional<TimeNs> first;
  for (const FrameRecord& record : c.training) {
    if (!first) first = c.drive.stamp(record.index);  // of the first that has one
  }
  for_each_batch(c.training.size(), [&](std::size_t begin, std::size_t count) {
    std::vector<std::vector<TrainingView>> batch(count);
    parallel_for(count, 1, [&](std::size_t i) {
      batch[i] = load_training_views(c.drive, c.training[begin + i], c.places, c.points, spacing,
                                     first.value_or(0));
    });
    for (const auto& views : batch) {
      for (const TrainingView& view : views) {
        show(view, c.points, normals, askers, states, held_out);
      }
    }
  });
  return states;
}

/// The points that every rule coloured, with all their colours.
struct RuleColors {
  ColoredPoints points;              // without colours
  std::vector<std::uint32_t> place;  // of each map point among them, or kNone
  std::map<ColorRule, std::vector<LogColor>> color;
  std::map<ColorRule, std::size_t> coloured;  // of all map points
};

RuleColors apply_rules(const ColoredPoints& points, const std::vector<ColorState>& states) {
  RuleColors colors;
  colors.points.origin = points.origin;
  colors.place.assign(states.size(), kNone);
  for (std::uint32_t i = 0; i < states.size(); ++i) {
    if (states[i].visible_views == 0) continue;  // those without an occlusion test ask for less
    colors.place[i] = static_cast<std::uint32_t>(colors.points.position.size());
    colors.points.position.push_back(points.position[i]);
  }
  colors.points.runs = make_runs(colors.points.position, 1024);
  for (const ColorRule rule : kColorRules) {
    if (rule == ColorRule::kFloor) continue;
    std::vector<LogColor>& own = colors.color[rule];
    for (std::size_t i = 0; i < states.size(); ++i) {
      std::optional<LogColor> color = points.color[i];
      if (rule != ColorRule::kFovea) color = color_by(rule, states[i]);
      if (color) ++colors.coloured[rule];
      if (colors.place[i] != kNone) own.push_back(color.value());
    }
  }
  return colors;
}

PointErrors errors_by(ColorRule rule, const HeldOutView& held_out, const RuleColors& colors) {
  EvaluatedView view;
  view.grey = held_out.view.grey;
  NearestSamples nearest;
  for (std::size_t i = 0; i < held_out.nearest.size(); ++i) {
    const std::uint32_t place = colors.place[held_out.nearest[i]];
    if (place == kNone) continue;
    view.color.push_back(held_out.view.color[i]);
    view.pixel.push_back(held_out.view.pixel[i]);
    nearest.distance.push_back(held_out.distance[i]);
    nearest.color.push_back(to_float(rule == ColorRule::kFloor ? LogColor(held_out.floor[i])
                                                               : colors.color.at(rule)[place]));
  }
  return point_errors(view, nearest, fit_gains(view.color, nearest.color, view.grey));
}

/// Draws the points by every rule into the held-out views.
std::map<ColorRule, GradientSums> compare_sharpness(const Comparison& c, RuleColors& colors) {
  const std::vector<float> spacing = sample_spacing(colors.points.position);
  const DriveInfo& info = c.drive.info();
  SplatOptions options;  // as evaluate() draws
  options.min_depth = kEvaluatedDepth;
  options.max_depth = kEvaluatedFar;
  std::map<ColorRule, GradientSums> sums;
  for_each_batch(c.scored.size(), [&](std::size_t begin, std::size_t count) {
    std::vector<std::vector<Image>> images(count);
    parallel_for(count, 1, [&](std::size_t i) {
      const int index = c.scored[begin + i].index;
      if (index < info.begin || index >= info.end) return;
      LoadedFrame loaded = c.drive.load(index);
      if (auto* frame = std::get_if<Frame>(&loaded)) images[i] = std::move(frame->images);
    });
    for (auto& [rule, color] : colors.color) {
      std::swap(colors.points.color, color);
      std::vector<GradientSums> parts(count);
      parallel_for(count, 1, [&](std::size_t i) {
        for (const std::size_t place : c.places) {
          if (images[i].empty() || images[i].at(place).empty()) continue;
          const Camera camera =
              info.camera_at(place, c.scored[begin + i].index).at_image(c.scored[begin + i].motion);
          const RigidMotion T_cam_local =
              camera.T_cam_lidar * c.scored[begin + i].T_local_lidar.inverse();
          parts[i] += compare_gradients(splat(colors.points, spacing, camera, T_cam_local, options),
                                        images[i].at(place));
        }
      });
      for (const GradientSums& part : parts) sums[rule] += part;
      std::swap(colors.points.color, color);
    }
  });
  return sums;
}

}  // namespace

std::vector<ColorRuleScore> compare_color_rules(const ScoredMap& map, const FrameSource& drive,
                                                const ProtocolOptions& options) {
  if (options.protocol != Protocol::kHeldOut) {
    throw ConfigError("colour rules are compared on frames that none of them has seen",
                      std::string("protocol ") + to_string(options.protocol),
                      "use the protocol held-out");
  }
  map.points_local.check();
  Comparison c{drive,
               select_cameras(map, drive.info(), options),
               select_frames(map, drive, options),
               {},
               colored_points(map.points_local)};
  c.training = training_frames(map, drive.info(), c.scored, options.hold_out);
  if (c.points.position.empty()) {
    throw InputError("the map has no coloured point", "colour rules",
                     "score a map whose points have colours");
  }
  std::vector<HeldOutView> held_out = load_held_out(c);
  RuleColors colors = apply_rules(c.points, show_training_frames(c, held_out));
  std::map<ColorRule, GradientSums> sharpness = compare_sharpness(c, colors);

  std::vector<ColorRuleScore> scores;
  for (const ColorRule rule : kColorRules) {
    PointErrors errors;
    for (const HeldOutView& view : held_out) errors.append(errors_by(rule, view, colors));
    if (errors.position.empty()) {
      throw InputError("no held-out point lies near one that a training view sees",
                       std::to_string(c.training.size()) + " training frames",
                       "check that the map and its poses belong to this drive");
    }
    ColorRuleScore score{rule, std::nullopt, summarize(errors), std::nullopt};
    if (rule != ColorRule::kFloor) {
      score.points_coloured = colors.coloured[rule];
      score.sharpness = sharpness[rule].sharpness();
    }
    scores.push_back(score);
  }
  return scores;
}

}  // namespace fovea
