#include "tools/paper/results_page.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "fovea/platform.h"
#include "tools/paper/ablations.h"
#include "tools/paper/paper_charts.h"
#include "tools/paper/paper_numbers.h"
#include "tools/paper/row_table.h"

namespace fovea::paper {
namespace {

using Json = nlohmann::ordered_json;

/// The paper's variants and the presets.
std::vector<const Json*> paper_rows(const DriveResults& drive) {
  std::vector<const Json*> rows;
  for (const Json& row : drive.rows) {
    if (find_ablation(row.at("row")) == nullptr) rows.push_back(&row);
  }
  return rows;
}

std::string table_1(const std::vector<DriveResults>& drives, const std::optional<MlsTimes>& mls) {
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
  if (!mls) return text + "\n\n";
  return text + mls_rows(*mls) +
         fmt::format(
             "\n\nPCL's MLS as measured here by `upsampling_bench` ([benchmarks](../bench)): "
             "neighbourhoods of {:g} m, surfaces of order {}, search tree included.\n\n",
             mls->search_radius, mls->polynomial_order);
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
  text += row_table(paper_rows(drive), {{"ME, black", "/all/in_sample/paper_like/me_mean", 4},
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
                     row_table(paper_rows(drive), held_out_columns()));
}

/// Rows that change one thing of the default, below the default.
std::string ablation_tables(const DriveResults& drive) {
  const Json* reference = find_row(drive, "default");
  const bool simulated =
      reference != nullptr && reference->contains(Json::json_pointer("/held_out/truth"));
  std::vector<Column> columns = held_out_columns();
  if (simulated) {
    columns.insert(columns.end(), {{"pose error cm", "/held_out/truth/pose_aligned_m/mean", 1, 100},
                                   {"accuracy mm", "/held_out/truth/accuracy_mean", 1, 1000},
                                   {"ghosts %", "/held_out/truth/ghost_share", 2, 100}});
  }
  std::string text = fmt::format("### {}\n\n", drive.name), part;
  std::vector<const Json*> rows;
  const auto close_part = [&] {
    if (rows.size() > 1) text += fmt::format("{}:\n\n{}\n", part, row_table(rows, columns));
    rows.assign(reference != nullptr ? 1 : 0, reference);
  };
  for (const Json& row : drive.rows) {
    const Ablation* ablation = find_ablation(row.at("row"));
    if (ablation == nullptr) continue;
    if (ablation->part != part) close_part();
    part = ablation->part;
    rows.push_back(&row);
  }
  close_part();
  return text;
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

constexpr const char* kAblations =
    "Each row is the default preset but for one setting (`fovea map --set`), held out like the "
    "table above. Simulated drives are scored against their\n"
    "truth besides: mean pose error after aligning the trajectories, distance of map points to the "
    "true surfaces, share of points of things that moved.\n\n";

}  // namespace

std::string report_file(const std::string& drive) { return "report-" + drive + ".html"; }

std::vector<std::string> results_warnings(const std::vector<DriveResults>& drives) {
  std::vector<std::string> warnings;
  for (const DriveResults& drive : drives) {
    for (const Json& row : drive.rows) {
      for (const char* run : {"/all/map/warnings", "/held_out/map/warnings"}) {
        const nlohmann::ordered_json::json_pointer path(run);
        if (!row.contains(path)) continue;
        for (const Json& warning : row.at(path)) {
          std::string text = fmt::format("{}, {}: {}", drive.name, row.at("row").get<std::string>(),
                                         warning.get<std::string>());
          if (std::find(warnings.begin(), warnings.end(), text) == warnings.end()) {
            warnings.push_back(std::move(text));
          }
        }
      }
    }
  }
  return warnings;
}

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
  json["warnings"] = results_warnings(drives);
  return json;
}

std::string write_results_page(const std::vector<DriveResults>& drives,
                               const std::optional<MlsTimes>& mls, const std::string& command,
                               const std::filesystem::path& folder) {
  std::string text = fmt::format("# Results\n\n    {}\n\n", command);
  for (const DriveResults& drive : drives) {
    text += fmt::format("- {}: {} frames, camera {}\n", drive.name, drive.frames,
                        fmt::join(drive.cameras, ", "));
  }
  for (const DriveResults& drive : drives) {
    if (!std::filesystem::exists(folder / report_file(drive.name))) continue;
    text += fmt::format("\nPictures of the default row, held out: [{0}]({0})\n",
                        report_file(drive.name));
  }
  text += fmt::format(
      "\n{}## Held out: quality\n\nEvery 8th frame adds nothing to the map and scores it.\n\n",
      kWhyTwo);
  for (const DriveResults& drive : drives) text += held_out(drive);
  text += fmt::format("## Ablations: one thing changed\n\n{}", kAblations);
  for (const DriveResults& drive : drives) text += ablation_tables(drive);
  text += table_1(drives, mls) + "## Table II: the paper's rows, in-sample\n\n";
  for (const DriveResults& drive : drives) text += table_2(drive);
  text += "## The four charts\n\nBars far above the others are cut and carry their value.\n\n";
  text += write_charts(drives, folder);
  return text;
}

}  // namespace fovea::paper
