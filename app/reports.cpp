#include "app/reports.h"

#include <nlohmann/json.hpp>

namespace fovea::app {

nlohmann::ordered_json to_json(const MapSummary& summary) {
  nlohmann::ordered_json latency;
  for (const char* stage :
       {"decode", "upsample", "register", "fovea", "filter", "texture", "store", "frame"}) {
    // A stage that never ran (say, the filter of a baseline) took no time.
    const auto found = summary.latency_ms.find(stage);
    const StageLatency l = found != summary.latency_ms.end() ? found->second : StageLatency{};
    latency[stage] = {{"p50", l.p50}, {"p95", l.p95}, {"max", l.max}};
  }
  return {{"frames", summary.frames_mapped},
          {"frames_held_out", summary.frames_held_out},
          {"frames_skipped", summary.frames_skipped},
          {"registrations_failed", summary.registrations_failed},
          {"loops_closed", summary.loops_closed},
          {"points", summary.points},
          {"fps", summary.frames_per_second},
          {"peak_rss_mb", summary.peak_rss_mb},
          {"interrupted", summary.interrupted},
          {"latency_ms", latency},
          {"notes", summary.notes}};
}

void write_json(OutputFile& file, const nlohmann::ordered_json& json) {
  file.stream() << json.dump(2) << '\n';
  file.commit();
}

}  // namespace fovea::app
