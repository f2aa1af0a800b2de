#include "tools/paper/paper_charts.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "fovea/core/output_file.h"
#include "tools/paper/bar_chart.h"
#include "tools/paper/paper_numbers.h"
#include "tools/paper/row_table.h"

namespace fovea::paper {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kMethods[3] = {"gicp", "icp", "plane"};
constexpr const char* kMethodNames[3] = {"GICP", "point to point", "point to plane"};

/// Row of a method (0-2) at a column of the charts (0 is the baseline, then 0xUp to 3xUp).
std::string row_name(int method, int column) {
  if (column == 0) return fmt::format("baseline-{}", kMethods[method]);
  return fmt::format("E{}", 4 * method + column - 1);
}

struct Figure {
  const char* id;
  const char* title;
  const char* y_label;
  const char* path;  ///< of a row's JSON
  double factor;
  double PaperScore::* published;
};
constexpr Figure kFigures[4] = {
    {"scan-matching", "Scan-matching error", "m", "/all/scan_matching/mean", 1,
     &PaperScore::scan_matching},
    {"time", "Registration, a frame (the paper: the whole sequence)", "ms",
     "/all/map/latency_ms/register/p50", 1, &PaperScore::time},
    {"map-error", "Map error ME, in-sample", "m", "/all/in_sample/me_mean", 1,
     &PaperScore::me_mean},
    {"texture-error", "Texture error TE, in-sample", "0-441", "/all/in_sample/te_mean", 1,
     &PaperScore::te_mean},
};

template <class Value>
BarChart chart_of(const std::string& title, const std::string& y_label, Value&& value) {
  BarChart chart{title, y_label, {"baseline", "0xUp", "1xUp", "2xUp", "3xUp"}, {}};
  for (int method = 0; method < 3; ++method) {
    BarSeries series{kMethodNames[method], {}};
    for (int column = 0; column < 5; ++column)
      series.values.push_back(value(row_name(method, column)));
    chart.series.push_back(std::move(series));
  }
  return chart;
}

void write_text(const std::filesystem::path& file, const std::string& text) {
  OutputFile output(file, /*force=*/true);
  output.stream() << text;
  output.commit();
}

/// One chart of ours; the name of its file.
std::string write_chart(const DriveResults& drive, const Figure& f,
                        const std::filesystem::path& folder) {
  const BarChart chart = chart_of(f.title, f.y_label, [&](const std::string& name) {
    const Json* row = find_row(drive, name);
    return row != nullptr ? f.factor * figure(*row, f.path) : kNoFigure;
  });
  const std::string file = fmt::format("{}-{}.svg", f.id, drive.name);
  write_text(folder / file, to_svg(chart));
  return file;
}

std::string write_published_chart(const Figure& f, const std::filesystem::path& folder,
                                  PaperScore PaperRow::* sequence, const char* name) {
  const char* y_label = f.published == &PaperScore::time ? "s" : f.y_label;
  const BarChart chart =
      chart_of(fmt::format("The paper, sequence {}", name), y_label, [&](const std::string& row) {
        for (const PaperRow& published : paper_table_2()) {
          if (published.name == row) return published.*sequence.*f.published;
        }
        return kNoFigure;
      });
  const std::string file = fmt::format("{}-paper-{}.svg", f.id, name);
  write_text(folder / file, to_svg(chart));
  return file;
}

}  // namespace

const Json* find_row(const DriveResults& drive, const std::string& name) {
  const auto found = std::find_if(drive.rows.begin(), drive.rows.end(),
                                  [&](const Json& row) { return row.at("row") == name; });
  return found != drive.rows.end() ? &*found : nullptr;
}

std::string write_charts(const std::vector<DriveResults>& drives,
                         const std::filesystem::path& folder) {
  std::string text;
  for (const Figure& f : kFigures) {
    text += fmt::format("### {}\n\n", f.title);
    for (const DriveResults& drive : drives) {
      text += fmt::format("![{} on {}]({})\n", f.title, drive.name, write_chart(drive, f, folder));
    }
    text += fmt::format("![the paper, 0095]({})\n",
                        write_published_chart(f, folder, &PaperRow::seq_0095, "0095"));
    text += fmt::format("![the paper, 0001]({})\n\n",
                        write_published_chart(f, folder, &PaperRow::seq_0001, "0001"));
  }
  return text;
}

}  // namespace fovea::paper
