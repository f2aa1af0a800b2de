#include "fovea/evaluation/color_rules_report.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

namespace fovea {

nlohmann::ordered_json to_json(const std::vector<ColorRuleScore>& scores) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const ColorRuleScore& score : scores) {
    nlohmann::ordered_json json;
    json["rule"] = to_string(score.rule);
    json["oracle"] = score.rule == ColorRule::kFloor;
    json["points_coloured"] = nullptr;
    if (score.points_coloured) json["points_coloured"] = *score.points_coloured;
    json["points"] = score.figures.points;
    json["te_mean"] = score.figures.te_mean;
    json["te_median"] = score.figures.te_median;
    json["te_within_20"] = score.figures.te_within_20;
    json["te_gain_mean"] = score.figures.te_gain_mean;
    json["mtme"] = score.figures.mtme;
    json["sharpness"] = nullptr;
    if (score.sharpness) json["sharpness"] = *score.sharpness;
    list.push_back(std::move(json));
  }
  return list;
}

std::string to_text(const std::vector<ColorRuleScore>& scores) {
  if (scores.empty()) return "";
  std::string text = fmt::format(
      "\ncolour rules, {} held-out points whose nearest map point every rule coloured\n"
      "  {:<12}{:>9}{:>9}{:>10}{:>9}{:>9}{:>11}{:>12}\n",
      scores.front().figures.points, "rule", "TE mean", "median", "within 20", "gain", "MTME",
      "sharpness", "coloured");
  for (const ColorRuleScore& score : scores) {
    const ErrorFigures& f = score.figures;
    text +=
        fmt::format("  {:<12}{:>9.2f}{:>9.2f}{:>10.3f}{:>9.2f}{:>9.3f}{:>11}{:>12}\n",
                    to_string(score.rule), f.te_mean, f.te_median, f.te_within_20, f.te_gain_mean,
                    f.mtme, score.sharpness ? fmt::format("{:.3f}", *score.sharpness) : "-",
                    score.points_coloured ? std::to_string(*score.points_coloured) : "oracle");
  }
  return text +
         "The floor is an oracle: it takes of all views that see a point the one nearest to "
         "the held-out colour.\n";
}

}  // namespace fovea
