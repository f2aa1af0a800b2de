#include "app/html_report/charts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "app/html_report/markup.h"

namespace fovea::app {
namespace {

constexpr double kWidth = 720, kHeight = 260;
constexpr double kLeft = 64, kRight = 14, kTop = 14, kBottom = 48;

void check(const Chart& chart) {
  for (const Series& series : chart.series) {
    if (series.values.size() != chart.x.size()) {
      throw std::invalid_argument("a series has not one value an x");
    }
  }
}

bool has_value(const Chart& chart) {
  return std::any_of(chart.series.begin(), chart.series.end(), [](const Series& series) {
    return std::any_of(series.values.begin(), series.values.end(),
                       [](double v) { return std::isfinite(v); });
  });
}

/// The frame of a chart: from values to the picture's coordinates, axes with round ticks.
class Plot {
 public:
  Plot(const std::string& title, double x_low, double x_high, double y_high)
      : x_low_(x_low), x_high_(x_high > x_low ? x_high : x_low + 1), y_high_(y_high) {
    if (!(y_high_ > 0)) y_high_ = 1;
    y_high_ *= 1.06;
    svg_ =
        fmt::format("<svg class=\"chart\" viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"{}\">\n",
                    kWidth, kHeight, escaped(title));
  }

  double x(double value) const {
    return kLeft + (kWidth - kLeft - kRight) * (value - x_low_) / (x_high_ - x_low_);
  }
  double y(double value) const {
    return kHeight - kBottom - (kHeight - kBottom - kTop) * value / y_high_;
  }
  void add(const std::string& element) { svg_ += element; }

  void text(double px, double py, const char* anchor, const std::string& what,
            const std::string& more = "") {
    svg_ += fmt::format(
        "<text class=\"label\" x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\"{}>{}</text>\n", px, py,
        anchor, more, escaped(what));
  }
  /// @param last_tick  no number stands beyond it
  void axes(const std::string& x_label, const std::string& y_label, bool whole_x,
            double last_tick = std::numeric_limits<double>::infinity()) {
    const double y_step = round_step(y_high_, 5);
    for (int i = 0; i * y_step <= y_high_; ++i) {
      const double py = y(i * y_step);
      svg_ += fmt::format("<line class=\"{}\" x1=\"{}\" x2=\"{}\" y1=\"{:.1f}\" y2=\"{:.1f}\"/>\n",
                          i == 0 ? "axis" : "grid", kLeft, kWidth - kRight, py, py);
      text(kLeft - 8, py + 4, "end", fmt::format("{:.6g}", i * y_step));
    }
    double x_step = round_step(x_high_ - x_low_, 10);
    if (whole_x) x_step = std::max(x_step, 1.0);
    for (double i = std::ceil(x_low_ / x_step); i * x_step <= std::min(x_high_, last_tick); ++i) {
      text(x(i * x_step), kHeight - kBottom + 18, "middle", fmt::format("{:.6g}", i * x_step));
    }
    text(0.5 * (kLeft + kWidth - kRight), kHeight - 6, "middle", x_label);
    const double middle = 0.5 * (kTop + kHeight - kBottom);
    text(13, middle, "middle", y_label,
         fmt::format(" transform=\"rotate(-90 13 {:.1f})\"", middle));
  }
  void level(double value, const std::string& name) {
    if (!(value > 0) || value > y_high_) return;
    svg_ += fmt::format("<line class=\"level\" x1=\"{}\" x2=\"{}\" y1=\"{:.1f}\" y2=\"{:.1f}\"/>\n",
                        kLeft, kWidth - kRight, y(value), y(value));
    text(kWidth - kRight - 4, y(value) - 5, "end", name);
  }
  std::string finish() { return svg_ + "</svg>\n"; }

 private:
  double x_low_, x_high_, y_high_;
  std::string svg_;
};

/// Names of the series, where there are several: colours alone would not tell them apart.
std::string legend(const Chart& chart) {
  if (chart.series.size() < 2) return "";
  std::string html = "<ul class=\"legend\">";
  for (std::size_t s = 0; s < chart.series.size(); ++s) {
    html +=
        fmt::format("<li><i class=\"swatch s{}\"></i>{}</li>", s, escaped(chart.series[s].name));
  }
  return html + "</ul>\n";
}

/// What stands at an x, one value a line, shown under the pointer.
std::string hint(const Chart& chart, std::size_t i, bool sum) {
  std::string text = fmt::format("{} {:g}", chart.x_name, chart.x[i]);
  double total = 0;
  for (const Series& series : chart.series) {
    if (!std::isfinite(series.values[i])) continue;
    total += series.values[i];
    text += fmt::format("\n{}: {:.3g}{}", series.name, series.values[i], chart.unit);
  }
  if (sum) text += fmt::format("\nall: {:.3g}{}", total, chart.unit);
  return text;
}

/// Invisible columns that give their hint under the pointer.
void hints(Plot& plot, const Chart& chart, bool sum) {
  for (std::size_t i = 0; i < chart.x.size(); ++i) {
    const double left =
        i == 0 ? plot.x(chart.x[i]) - 6 : 0.5 * (plot.x(chart.x[i - 1]) + plot.x(chart.x[i]));
    const double right = i + 1 == chart.x.size()
                             ? plot.x(chart.x[i]) + 6
                             : 0.5 * (plot.x(chart.x[i]) + plot.x(chart.x[i + 1]));
    plot.add(
        fmt::format("<rect class=\"hint\" data-at=\"{:g}\" x=\"{:.1f}\" y=\"{}\" width=\"{:.1f}\" "
                    "height=\"{}\"><title>{}</title></rect>\n",
                    chart.x[i], left, kTop, std::max(0.5, right - left), kHeight - kTop - kBottom,
                    escaped(hint(chart, i, sum))));
  }
}

}  // namespace

double round_step(double range, int most) {
  if (!(range > 0) || !std::isfinite(range)) return 1;
  const double exact = range / most;
  const double power = std::pow(10, std::floor(std::log10(exact)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= exact * (1 - 1e-9)) return factor * power;
  }
  return 10 * power;
}

std::string line_chart(const Chart& chart) {
  check(chart);
  if (!has_value(chart)) return "";
  double top = chart.line_at;
  for (const Series& series : chart.series) {
    for (const double v : series.values) top = std::isfinite(v) ? std::max(top, v) : top;
  }
  Plot plot(chart.title, chart.x.front(), chart.x.back(), top);
  plot.axes(chart.x_label, chart.y_label, /*whole_x=*/true);
  plot.level(chart.line_at, chart.line_name);
  for (std::size_t s = 0; s < chart.series.size(); ++s) {
    std::string path, marks;
    bool pen_up = true;
    for (std::size_t i = 0; i < chart.x.size(); ++i) {
      const double value = chart.series[s].values[i];
      if (!std::isfinite(value)) {
        pen_up = true;
        continue;
      }
      const double px = plot.x(chart.x[i]), py = plot.y(value);
      path += fmt::format("{}{:.1f} {:.1f}", pen_up ? "M" : "L", px, py);
      pen_up = false;
      marks += fmt::format("<circle class=\"mark s{}\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{}\"/>\n", s,
                           px, py, chart.x.size() > 60 ? 2 : 4);
    }
    plot.add(fmt::format("<path class=\"line s{}\" d=\"{}\"/>\n{}", s, path, marks));
  }
  hints(plot, chart, /*sum=*/false);
  return legend(chart) + plot.finish();
}

std::string stacked_chart(const Chart& chart) {
  check(chart);
  if (!has_value(chart)) return "";
  const auto value_of = [](double v) { return std::isfinite(v) ? v : 0.0; };
  std::vector<double> floor(chart.x.size(), 0), top = floor;
  for (const Series& series : chart.series) {
    for (std::size_t i = 0; i < top.size(); ++i) top[i] += value_of(series.values[i]);
  }
  const double highest = *std::max_element(top.begin(), top.end());
  Plot plot(chart.title, chart.x.front(), chart.x.back(), std::max(highest, chart.line_at));
  plot.axes(chart.x_label, chart.y_label, /*whole_x=*/true);
  for (std::size_t s = 0; s < chart.series.size(); ++s) {
    std::string up, back;
    for (std::size_t i = 0; i < chart.x.size(); ++i) {
      const double ceiling = floor[i] + value_of(chart.series[s].values[i]);
      up += fmt::format("{}{:.1f} {:.1f}", i == 0 ? "M" : "L", plot.x(chart.x[i]), plot.y(ceiling));
      back.insert(0, fmt::format("L{:.1f} {:.1f}", plot.x(chart.x[i]), plot.y(floor[i])));
      floor[i] = ceiling;
    }
    plot.add(fmt::format("<path class=\"area s{}\" d=\"{}{}Z\"/>\n", s, up, back));
  }
  plot.level(chart.line_at, chart.line_name);
  hints(plot, chart, /*sum=*/true);
  return legend(chart) + plot.finish();
}

std::string histogram_chart(const Histogram& histogram) {
  std::size_t all = 0;
  for (const std::size_t n : histogram.counts) all += n;
  if (all == 0) return "";
  const auto share = [&](std::size_t n) {
    return 100 * static_cast<double>(n) / static_cast<double>(all);
  };
  std::size_t shown = 0, below = 0;  // bins, and points in them
  while (shown < histogram.counts.size() && share(below) < 99) below += histogram.counts[shown++];
  const bool rest = below < all;
  double highest = share(all - below);
  for (std::size_t b = 0; b < shown; ++b) highest = std::max(highest, share(histogram.counts[b]));

  const double bins = static_cast<double>(shown) + (rest ? 2 : 0);
  Plot plot(histogram.title, 0, bins * histogram.width, highest);
  plot.axes(histogram.x_label, "% of the points", /*whole_x=*/false,
            static_cast<double>(shown) * histogram.width);
  const auto bar = [&](double left, double width, std::size_t n, const std::string& what,
                       const char* type) {
    plot.add(fmt::format(
        "<rect class=\"{}\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\">"
        "<title>{}</title></rect>\n",
        type, plot.x(left) + 0.5, plot.y(share(n)), plot.x(left + width) - plot.x(left) - 1,
        plot.y(0) - plot.y(share(n)), escaped(fmt::format("{}: {:.2f}%", what, share(n)))));
  };
  for (std::size_t b = 0; b < shown; ++b) {
    const double left = static_cast<double>(b) * histogram.width;
    bar(left, histogram.width, histogram.counts[b],
        fmt::format("{:g} to {:g}", left, left + histogram.width), "bar s0");
  }
  if (rest) {
    const double beyond = static_cast<double>(shown) * histogram.width;
    bar(beyond + histogram.width, histogram.width, all - below,
        fmt::format("{:g} and more", beyond), "bar s5");
    plot.text(plot.x(beyond + 1.5 * histogram.width), plot.y(share(all - below)) - 5, "end",
              fmt::format("{:g} and more", beyond));
  }
  const auto mark = [&](double value, const char* name, double height) {
    if (!(value >= 0) || value > bins * histogram.width) return;
    plot.add(fmt::format(
        "<line class=\"level\" x1=\"{0:.1f}\" x2=\"{0:.1f}\" y1=\"{1}\" y2=\"{2:.1f}\"/>\n",
        plot.x(value), kTop, plot.y(0)));
    plot.text(plot.x(value) + 5, height, "start", fmt::format("{} {:.1f}", name, value));
  };
  mark(histogram.median, "median", kTop + 12);
  mark(histogram.mean, "mean", kTop + 28);
  return plot.finish();
}

}  // namespace fovea::app
