#include "app/reproduce/results_page.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "app/reproduce/bar_chart.h"
#include "app/reproduce/paper_numbers.h"
#include "fovea/base/output_file.h"
#include "fovea/base/version.h"

namespace fovea::app {
namespace {

using Json = nlohmann::ordered_json;
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// A figure by its path ("/held_out/held_out/te_mean"); NaN where there is none.
double figure(const Json& row, const std::string& path) {
  const Json::json_pointer pointer(path);
  if (!row.contains(pointer)) return kNone;
  const Json& value = row.at(pointer);
  return value.is_number() ? value.get<double>() : kNone;
}

std::string cell(double value, int digits) {
  return std::isfinite(value) ? fmt::format("{:.{}f}", value, digits) : "-";
}

struct Column {
  const char* title;
  const char* path;
  int digits;
  double factor = 1;
};

std::string table(const DriveResults& drive, const std::vector<Column>& columns) {
  std::string text = "| row |", line = "| --- |";
  for (const Column& column : columns) {
    text += fmt::format(" {} |", column.title);
    line += " --- |";
  }
  text += fmt::format("\n{}\n", line);
  for (const Json& row : drive.rows) {
    text += fmt::format("| {} |", row.at("row").get<std::string>());
    for (const Column& column : columns) {
      text += fmt::format(" {} |", cell(column.factor * figure(row, column.path), column.digits));
    }
    text += "\n";
  }
  return text;
}

// ---- charts

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
  double PaperScore::*published;
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

const Json* find_row(const DriveResults& drive, const std::string& name) {
  const auto found = std::find_if(drive.rows.begin(), drive.rows.end(),
                                  [&](const Json& row) { return row.at("row") == name; });
  return found != drive.rows.end() ? &*found : nullptr;
}

/// One chart of ours; the name of its file.
std::string write_chart(const DriveResults& drive, const Figure& f,
                        const std::filesystem::path& folder) {
  const BarChart chart = chart_of(f.title, f.y_label, [&](const std::string& name) {
    const Json* row = find_row(drive, name);
    return row != nullptr ? f.factor * figure(*row, f.path) : kNone;
  });
  const std::string file = fmt::format("{}-{}.svg", f.id, drive.name);
  write_text(folder / file, to_svg(chart));
  return file;
}

std::string write_published_chart(const Figure& f, const std::filesystem::path& folder,
                                  PaperScore PaperRow::*sequence, const char* name) {
  const char* y_label = f.published == &PaperScore::time ? "s" : f.y_label;
  const BarChart chart =
      chart_of(fmt::format("The paper, sequence {}", name), y_label, [&](const std::string& row) {
        for (const PaperRow& published : paper_table_2()) {
          if (published.name == row) return published.*sequence.*f.published;
        }
        return kNone;
      });
  const std::string file = fmt::format("{}-paper-{}.svg", f.id, name);
  write_text(folder / file, to_svg(chart));
  return file;
}

// ---- sections

std::string table_1(const std::vector<DriveResults>& drives) {
  std::string text =
      "## Table I: time to upsample\n\n"
      "Median of seven runs on one thread, in ms, from the points of one scan in view to about as "
      "many as the column says (measured ones\n"
      "included). The paper's own times and those it gives for moving least squares (PCL's MLS) "
      "are as published, on other machines.\n\n"
      "| points | 10k | 30k | 90k | 180k | 450k |\n| --- | --- | --- | --- | --- | --- |\n| MLS, "
      "published |";
  for (const PaperUpsampling& c : paper_table_1()) text += fmt::format(" {:.0f} |", 1000 * c.mls);
  text += "\n| the paper's, published |";
  for (const PaperUpsampling& c : paper_table_1())
    text += fmt::format(" {:.0f} |", 1000 * c.proposed);
  for (const DriveResults& drive : drives) {
    text += fmt::format("\n| Fovea, {} |", drive.name);
    for (const UpsamplingTime& t : drive.upsampling)
      text += fmt::format(" {:.1f} |", 1000 * t.seconds);
    text += "\n| (given, produced, rate) |";
    for (const UpsamplingTime& t : drive.upsampling) {
      text += fmt::format(" {}, {}, {} |", t.given, t.points, t.rate);
    }
  }
  return text + "\n\n";
}

std::string table_2(const DriveResults& drive) {
  std::string text = fmt::format(
      "### {}\n\nIn-sample, scans placed by the refined poses, beside the paper's sequences 0095 "
      "and 0001 (`ME` m, deviation; `TE`, deviation; `MTME`).\n\n",
      drive.name);
  text +=
      "| row | ME | | TE | | MTME | 0095: ME | | TE | | MTME | 0001: ME | | TE | | MTME |\n"
      "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | "
      "--- |\n";
  const auto published = [](const PaperScore& s) {
    return fmt::format(" {:.3f} | {:.3f} | {:.2f} | {:.2f} | {:.3f} |", s.me_mean, s.me_std,
                       s.te_mean, s.te_std, s.mtme);
  };
  for (const PaperRow& paper : paper_table_2()) {
    const Json* row = find_row(drive, std::string(paper.name));
    if (row == nullptr) continue;
    const auto ours = [&](const char* key, int digits) {
      return cell(figure(*row, fmt::format("/all/in_sample/{}", key)), digits);
    };
    text += fmt::format("| {} | {} | {} | {} | {} | {} |{}{}\n", paper.name, ours("me_mean", 4),
                        ours("me_std", 4), ours("te_mean", 2), ours("te_std", 1), ours("mtme", 3),
                        published(paper.seq_0095), published(paper.seq_0001));
  }
  text +=
      "\nWith uncoloured points counted as black, as the paper seems to have done for its "
      "baselines, and with scans placed by the navigation\n"
      "(the only reading under which a baseline's ME is not zero):\n\n";
  text += table(drive, {{"ME, black", "/all/in_sample/paper_like/me_mean", 4},
                        {"TE, black", "/all/in_sample/paper_like/te_mean", 1},
                        {"MTME, black", "/all/in_sample/paper_like/mtme", 3},
                        {"ME, navigation", "/all/in_sample_nav/me_mean", 4},
                        {"TE, navigation", "/all/in_sample_nav/te_mean", 1},
                        {"MTME, navigation", "/all/in_sample_nav/mtme", 3},
                        {"scan matching m", "/all/scan_matching/mean", 4},
                        {"points M", "/all/map/points", 2, 1e-6}});
  return text + "\n";
}

std::string held_out(const DriveResults& drive) {
  return fmt::format("### {}\n\n{}\n", drive.name,
                     table(drive, {{"ME m", "/held_out/held_out/me_mean", 4},
                                   {"TE", "/held_out/held_out/te_mean", 2},
                                   {"median", "/held_out/held_out/te_median", 1},
                                   {"within 20", "/held_out/held_out/te_within_20", 3},
                                   {"TE, fitted gain", "/held_out/held_out/te_gain_mean", 2},
                                   {"MTME", "/held_out/held_out/mtme", 3},
                                   {"cover 5 cm", "/held_out/held_out/coverage_5cm", 3},
                                   {"cover 20 cm", "/held_out/held_out/coverage_20cm", 3},
                                   {"violations", "/held_out/held_out/free_space_violations", 4},
                                   {"sharpness", "/held_out/held_out/sharpness", 2},
                                   {"points M", "/held_out/map/points", 2, 1e-6},
                                   {"frame ms p50", "/held_out/map/latency_ms/frame/p50", 0},
                                   {"p95", "/held_out/map/latency_ms/frame/p95", 0}}));
}

constexpr const char* kWhyTwo =
    "## Why in-sample and held-out figures differ\n\n"
    "The paper scores a map by the scans that built it. A map that keeps every point then scores "
    "ME = TE = 0, whatever it looks like: each scan finds\n"
    "itself. What is above zero is what filtering removed: a row that drops more scores worse. "
    "In-sample figures therefore order the rows by how\n"
    "much they keep, and they are given here because the paper's table cannot be compared "
    "otherwise.\n\n"
    "Held-out figures ask what a user asks: here is a place that the vehicle drove past, with "
    "every eighth frame kept from the map; how far is the map from what\n"
    "that frame saw, in metres and in colour? Wrong poses, colours bled across edges, holes and "
    "ghosts all count. No single figure is a win: ME falls when\n"
    "a map is fattened (free-space violations tell), TE falls when colours are blurred (sharpness "
    "tells) or hard points dropped (coverage tells).\n\n";

}  // namespace

Json results_json(const std::vector<DriveResults>& drives) {
  Json json;
  json["fovea"] = version();
  json["drives"] = Json::array();
  for (const DriveResults& drive : drives) {
    Json upsampling = Json::array();
    for (const UpsamplingTime& t : drive.upsampling) {
      upsampling.push_back({{"wanted", t.wanted},
                            {"given", t.given},
                            {"points", t.points},
                            {"rate", t.rate},
                            {"seconds", t.seconds}});
    }
    json["drives"].push_back({{"name", drive.name},
                              {"cameras", drive.cameras},
                              {"frames", drive.frames},
                              {"upsampling", upsampling},
                              {"rows", drive.rows}});
  }
  return json;
}

std::string write_results_page(const std::vector<DriveResults>& drives, const std::string& command,
                               const std::filesystem::path& folder) {
  std::string text = fmt::format("# Results\n\n    {}\n\n", command);
  for (const DriveResults& drive : drives) {
    text += fmt::format("- {}: {} frames, camera {}\n", drive.name, drive.frames,
                        fmt::join(drive.cameras, ", "));
  }
  text += fmt::format(
      "\n{}## Held out: quality\n\nEvery 8th frame adds nothing to the map and scores it.\n\n",
      kWhyTwo);
  for (const DriveResults& drive : drives) text += held_out(drive);
  text += table_1(drives) + "## Table II: the paper's rows, in-sample\n\n";
  for (const DriveResults& drive : drives) text += table_2(drive);
  text += "## The four charts\n\nBars far above the others are cut and carry their value.\n\n";
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

}  // namespace fovea::app
