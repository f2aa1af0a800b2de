#include "fovea/pipeline/frame_result.h"

#include <map>

#include "fovea/mapping/blank_image.h"
#include "fovea/pipeline/point_counts.h"

namespace fovea {
namespace {

using Figures = std::map<std::string, double>;

void report(const RegistrationStats& stats, Figures& figures) {
  figures["registration_points"] = as_figure(stats.points);
  if (stats.vertical_fit) figures["registration_vertical_fit"] = *stats.vertical_fit;
  if (!stats.alignment) return;
  figures["registration_iterations"] = stats.alignment->iterations;
  figures["registration_pairs"] = as_figure(stats.alignment->pairs);
  figures["registration_rms"] = stats.alignment->rms_m;
  figures["registration_degenerate"] = stats.alignment->degenerate_directions;
  figures["registration_failed"] = stats.alignment->has_failed ? 1 : 0;
  figures["correction_translation"] = stats.alignment->correction_m;
  figures["correction_rotation"] = stats.alignment->correction_rad;
}

void report(const TrackingStats& stats, Figures& figures) {
  if (stats.registration) report(*stats.registration, figures);
  if (stats.is_lost) figures["registration_lost"] = 1;
  if (stats.has_restarted) figures["track_restarted"] = 1;
  if (stats.is_pose_unknown) figures["pose_unknown"] = 1;
  if (stats.has_navigation_jumped) figures["navigation_jumped"] = 1;
  if (stats.has_imu_dropped) figures["imu_dropped"] = 1;
}

void report(const FovealStats& stats, Figures& figures) {
  figures["points_foveal"] = as_figure(stats.measured);
  figures["points_upsampled"] = as_figure(stats.upsampled);
  figures["points_oblique"] = as_figure(stats.oblique);
  figures["filter_occluding"] = as_figure(stats.occluding);
}

void report(const RayFilterStats& stats, Figures& figures) {
  figures["points_map_in_view"] = as_figure(stats.map_points);
  figures["filter_visible"] = as_figure(stats.visible);
  figures["filter_occluded"] = as_figure(stats.occluded);
  figures["filter_shared"] = as_figure(stats.shared);
}

void report(const DynamicStats& stats, Figures& figures) {
  figures["moving_removed"] = as_figure(stats.removed);
  figures["filter_moving"] = as_figure(stats.dropped);
}

void report(const ColorStats& stats, Figures& figures) {
  figures["points_recolored"] = as_figure(stats.recolored);
  if (stats.compared == 0) return;
  figures["texture_compared"] = as_figure(stats.compared);
  figures["texture_error"] = stats.error;
}

Figures figures_of(const FrameResult& result) {
  Figures figures;
  count_points(result.scan, figures);
  report(result.tracking, figures);
  if (const auto accuracy = result.poses.navigation_accuracy) {
    figures["navigation_accuracy"] = *accuracy;
  }
  if (result.skips_texture) figures["texture_skipped"] = 1;
  if (result.blank_images > 0) figures["images_blank"] = result.blank_images;
  if (result.foveal) report(*result.foveal, figures);
  if (result.hidden) figures["filter_hidden"] = as_figure(*result.hidden);
  if (result.ray_filter) report(*result.ray_filter, figures);
  if (result.dynamic) report(*result.dynamic, figures);
  if (result.colors) report(*result.colors, figures);
  if (result.added) figures["points_added"] = as_figure(*result.added);
  if (result.unseen) figures["points_unseen"] = as_figure(*result.unseen);
  return figures;
}

}  // namespace

double RegistrationStats::overlap() const {
  if (!alignment || points == 0) return 1;
  return double(alignment->pairs) / double(points);
}

double TrackingStats::overlap() const { return registration ? registration->overlap() : 1; }

bool TrackingStats::is_weak() const {
  if (is_lost) return true;
  if (!registration || !registration->alignment) return false;
  return registration->alignment->has_failed || registration->alignment->degenerate_directions > 0;
}

FrameResult started_result(const Frame& frame, bool held_out) {
  FrameResult result;
  result.index = frame.index;
  result.stamp = frame.stamp;
  result.status = held_out ? FrameStatus::kHeldOut : FrameStatus::kMapped;
  result.scan = {frame.scan.size(), frame.dropped_points};
  return result;
}

bool has_content(const Image& image, FrameResult& result) {
  if (image.empty()) return false;
  if (!is_blank(image)) return true;
  ++result.blank_images;
  return false;
}

FrameRecord record_of(const FrameResult& result) {
  FrameRecord record;
  record.index = result.index;
  record.stamp = result.stamp;
  record.status = result.status;
  record.note = result.note;
  record.T_local_lidar = result.poses.T_local_lidar;
  record.T_local_lidar_navigation = result.poses.T_local_lidar_navigation;
  record.T_odom_lidar = result.poses.T_odom_lidar;
  record.submap = result.poses.submap;
  record.revisit = result.poses.revisit;
  record.motion = result.poses.motion;
  record.figures = figures_of(result);
  record.milliseconds = result.clock.milliseconds();
  return record;
}

FrameResult tracked_result(const FrameRecord& record) {
  const auto figure = [&](const char* name) -> std::optional<double> {
    const auto found = record.figures.find(name);
    return found == record.figures.end() ? std::nullopt : std::optional(found->second);
  };
  FrameResult result;
  result.index = record.index;
  result.stamp = record.stamp;
  result.status = record.status;
  result.poses = {record.T_local_lidar, record.T_local_lidar_navigation,
                  record.T_odom_lidar,  record.submap,
                  record.revisit,       record.motion};
  result.skips_texture = record.has("texture_skipped");
  result.poses.navigation_accuracy = figure("navigation_accuracy");
  result.tracking.is_lost = record.has("registration_lost");
  result.tracking.has_restarted = record.has("track_restarted");
  if (const auto points = figure("registration_points")) {
    RegistrationStats& registration = result.tracking.registration.emplace();
    registration.points = static_cast<std::size_t>(*points);
    if (const auto pairs = figure("registration_pairs")) {
      AlignmentStats& alignment = registration.alignment.emplace();
      alignment.pairs = static_cast<std::size_t>(*pairs);
      alignment.has_failed = record.has("registration_failed");
      alignment.degenerate_directions =
          static_cast<int>(figure("registration_degenerate").value_or(0));
    }
  }
  return result;
}

}  // namespace fovea
