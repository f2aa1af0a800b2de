#include "fovea/pipeline/summary_json.h"

#include <nlohmann/json.hpp>

#include "fovea/pipeline/calibration_json.h"

namespace fovea {

nlohmann::ordered_json to_json(const StageLatency& latency) {
  return {{"p50", latency.p50}, {"p95", latency.p95}, {"max", latency.max}};
}

nlohmann::ordered_json to_json(const LiveFigures& figures) {
  return {{"scans", figures.scans},
          {"scans_dropped", figures.scans_dropped},
          {"scans_out_of_order", figures.scans_out_of_order},
          {"scans_missing", figures.scans_missing},
          {"images", figures.images},
          {"images_late", figures.images_late},
          {"images_missing", figures.images_missing},
          {"images_unused", figures.images_unused},
          {"poses", figures.poses},
          {"poses_late", figures.poses_late}};
}

nlohmann::ordered_json to_json(const MapSummary& summary) {
  nlohmann::ordered_json latency;
  for (const char* stage : {"decode", "upsample", "register", "fovea", "filter", "texture", "store",
                            "calibration", "wait", "frame"}) {
    // A stage that never ran, such as the filter of a baseline, has the time 0.
    const auto found = summary.latency_ms.find(stage);
    const StageLatency l = found != summary.latency_ms.end() ? found->second : StageLatency{};
    latency[stage] = to_json(l);
  }
  auto images_missing = nlohmann::ordered_json::object();  // by camera
  for (const auto& [camera, count] : summary.images_missing) {
    images_missing[std::to_string(camera)] = count;
  }
  const bool at_rate = summary.rate > 0;
  return {{"frames", summary.frames_mapped},
          {"frames_held_out", summary.frames_held_out},
          {"frames_skipped", summary.frames_skipped},
          {"images_missing", images_missing},
          {"scans_missing", summary.scans_missing},
          {"registrations_failed", summary.registrations_failed},
          {"loops_closed", summary.loops_closed},
          {"points", summary.points},
          {"points_read", summary.points_read},
          {"points_dropped",
           {{"no_return", summary.points_dropped.no_return},
            {"not_finite", summary.points_dropped.not_finite},
            {"out_of_reach", summary.points_dropped.out_of_reach},
            {"off_time", summary.points_dropped.off_time}}},
          {"fps", summary.frames_per_second},
          {"rate_hz", at_rate ? nlohmann::ordered_json(summary.rate) : nullptr},
          {"late_frames", at_rate ? nlohmann::ordered_json(summary.late_frames) : nullptr},
          {"textures_skipped", summary.textures_skipped},
          {"peak_rss_mb", summary.peak_rss_mb},
          {"interrupted", summary.interrupted},
          {"latency_ms", latency},
          {"calibration", to_json(summary.calibration.cameras, summary.calibrated)},
          {"imu_calibration", to_json(summary.calibration.imu)},
          {"notes", summary.notes},
          {"warnings", summary.warnings}};
}

}  // namespace fovea
