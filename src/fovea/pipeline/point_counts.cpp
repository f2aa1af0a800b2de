#include "fovea/pipeline/point_counts.h"

#include <fmt/format.h>

#include <array>
#include <utility>

namespace fovea {
namespace {

constexpr const char *kUsed = "points_scan", *kDropped = "points_dropped";
/// Figures of records; absent if zero.
constexpr std::array<std::pair<const char*, std::size_t DroppedPoints::*>, 4> kReasons = {
    {{"points_dropped_no_return", &DroppedPoints::no_return},
     {"points_dropped_not_finite", &DroppedPoints::not_finite},
     {"points_dropped_out_of_reach", &DroppedPoints::out_of_reach},
     {"points_dropped_off_time", &DroppedPoints::off_time}}};

std::size_t count_of(const FrameRecord& record, const char* figure) {
  const auto found = record.figures.find(figure);
  return found == record.figures.end() ? 0 : static_cast<std::size_t>(found->second);
}

}  // namespace

void count_points(const ScanStats& scan, std::map<std::string, double>& figures) {
  figures[kUsed] = as_figure(scan.points);
  figures[kDropped] = as_figure(scan.dropped.total());
  for (const auto& [figure, reason] : kReasons) {
    const std::size_t count = scan.dropped.*reason;
    if (count > 0) figures[figure] = as_figure(count);
  }
}

void PointCounts::add(const FrameRecord& record) {
  used_ += count_of(record, kUsed);
  for (const auto& [figure, reason] : kReasons) dropped_.*reason += count_of(record, figure);
}

bool PointCounts::is_notable() const {
  constexpr double kNotable = 0.01;
  const std::size_t lost = dropped_.total() - dropped_.no_return;
  return double(lost) > kNotable * double(used_ + lost);
}

std::string PointCounts::note() const {
  const std::size_t dropped = dropped_.total(), all = used_ + dropped;
  if (dropped == 0) return "";
  return fmt::format("{} of {} points of the scans are dropped ({:.2g} %): {}", dropped, all,
                     100 * double(dropped) / double(all), reasons_of(dropped_));
}

}  // namespace fovea
