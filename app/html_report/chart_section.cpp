#include "app/html_report/chart_section.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <map>

#include "app/html_report/charts.h"
#include "app/html_report/markup.h"
#include "app/html_report/page_layout.h"
#include "app/html_report/trajectory_chart.h"

namespace fovea::app {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// A figure of every view, a series a camera.
Chart by_frame(const EvaluationReport& report, const std::string& name, const std::string& unit,
               const std::function<double(const ErrorFigures&)>& figure) {
  Chart chart;
  chart.title = name + " of every scored frame";
  chart.x_label = "frame";
  chart.y_label = unit.empty() ? name : name + "," + unit;
  chart.x_name = "frame";
  chart.unit = unit;
  std::map<int, std::map<int, double>> values;  // by frame, by camera
  for (const ViewReport& view : report.views) {
    values[view.frame][view.camera] = view.figures.points > 0 ? figure(view.figures) : kNone;
  }
  for (const auto& [frame, cameras] : values) chart.x.push_back(frame);
  for (const int camera : report.cameras) {
    Series series{fmt::format("camera {}", camera), {}};
    for (const auto& [frame, cameras] : values) {
      const auto found = cameras.find(camera);
      series.values.push_back(found == cameras.end() ? kNone : found->second);
    }
    chart.series.push_back(std::move(series));
  }
  return chart;
}

/// Stages of mapping over the frames; without x where the map has no times.
Chart latency(const ScoredMap& map, const DriveInfo& drive) {
  constexpr std::array kStages{"decode", "upsample", "register", "fovea",
                               "filter", "texture",  "store"};
  Chart chart;
  chart.title = "Time of each stage over the frames";
  chart.x_label = "frame";
  chart.y_label = "ms";
  chart.x_name = "frame";
  chart.unit = " ms";
  chart.line_at = 1000 * drive.sweep.period;
  chart.line_name = fmt::format("{:.0f} ms: the next scan is here", chart.line_at);
  for (const char* stage : kStages) chart.series.push_back({stage, {}});
  for (const FrameRecord& frame : map.frames) {
    if (frame.milliseconds.empty()) continue;
    chart.x.push_back(frame.index);
    for (Series& series : chart.series) {
      const auto found = frame.milliseconds.find(series.name);
      series.values.push_back(found == frame.milliseconds.end() ? kNone : found->second);
    }
  }
  return chart;
}

std::string histogram_panel(const EvaluationReport& report) {
  Histogram histogram;
  histogram.title = "Scored points by TE";
  histogram.x_label = "TE (Euclidean in RGB)";
  histogram.counts = report.te_histogram;
  histogram.width = kTeBin;
  histogram.mean = report.figures.te_mean;
  histogram.median = report.figures.te_median;
  return chart_panel("How wrong are the colours?",
                     fmt::format("All {} scored points by TE; the last bar is the worst percent.",
                                 count(report.figures.points)),
                     histogram_chart(histogram));
}

}  // namespace

std::string latency_panel(const ScoredMap& map, const DriveInfo& drive) {
  const Chart chart = latency(map, drive);
  if (chart.x.empty()) {
    return "<div class=\"panel\"><h3>Time of each frame</h3><p class=\"note\">The map does not say "
           "how long its frames took: only Fovea's own maps do.</p></div>\n";
  }
  return chart_panel(
      "Time of each frame",
      "Wall time of the stages while the map was made. Decoding, registration and mapping of "
      "neighbouring frames run side by side; held-out frames end after registration.",
      stacked_chart(chart));
}

std::string chart_section(const ScoredMap& map, const DriveInfo& drive,
                          const EvaluationReport& report) {
  const bool north_up = drive.origin.has_value() && map.statuses_known;
  std::string html = chart_panel(
      "The drive from above",
      "Refined poses as a line, GPS/INS dashed where the map has it; the scored frames as dots, "
      "darker is better. A dot leads to its picture.",
      trajectory_chart(map.frames, report, north_up));
  html += "<div class=\"pair\" style=\"margin-top:1rem\">\n";
  html +=
      chart_panel("TE, frame by frame", "Mean difference of colour.",
                  line_chart(by_frame(report, "TE", "", [](const auto& f) { return f.te_mean; })));
  html += chart_panel(
      "ME, frame by frame", "Mean distance to the nearest map point.",
      line_chart(by_frame(report, "ME", " cm", [](const auto& f) { return 100 * f.me_mean; })));
  html += histogram_panel(report) + latency_panel(map, drive) + "</div>\n";
  return html;
}

}  // namespace fovea::app
