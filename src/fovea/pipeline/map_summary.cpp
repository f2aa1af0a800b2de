#include "fovea/pipeline/map_summary.h"

#include <sys/resource.h>

#include <algorithm>
#include <cmath>

namespace fovea {
namespace {

StageLatency latency_of(std::vector<double> milliseconds) {
  std::sort(milliseconds.begin(), milliseconds.end());
  const auto at = [&](double share) {
    return milliseconds[static_cast<std::size_t>(
        std::lround(share * double(milliseconds.size() - 1)))];
  };
  return {at(0.5), at(0.95), milliseconds.back()};
}

double peak_rss_mb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

}  // namespace

int MapSummary::skipped() const {
  int total = 0;
  for (const auto& [reason, count] : frames_skipped) total += count;
  return total;
}

MapSummary summarise(const std::vector<FrameRecord>& records, std::size_t first_new,
                     const DriveInfo& drive) {
  MapSummary summary;
  summary.notes = drive.notes;
  std::map<std::string, std::vector<double>> by_stage;
  for (std::size_t i = 0; i < records.size(); ++i) {
    const FrameRecord& record = records[i];
    switch (record.status) {
      case FrameStatus::kMapped:
        ++summary.frames_mapped;
        break;
      case FrameStatus::kHeldOut:
        ++summary.frames_held_out;
        break;
      case FrameStatus::kSkipped:
        ++summary.frames_skipped[record.note.substr(0, record.note.find(':'))];
        break;
    }
    const auto failed = record.figures.find("registration_failed");
    if (failed != record.figures.end() && failed->second > 0) ++summary.registrations_failed;
    if (i < first_new) continue;
    for (const auto& [stage, ms] : record.milliseconds) by_stage[stage].push_back(ms);
  }
  for (auto& [stage, times] : by_stage) summary.latency_ms[stage] = latency_of(std::move(times));
  summary.peak_rss_mb = peak_rss_mb();
  return summary;
}

}  // namespace fovea
