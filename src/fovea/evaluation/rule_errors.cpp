#include "fovea/evaluation/rule_errors.h"

namespace fovea {

double RuleErrors::mean(double sum) const {
  return points > 0 ? sum / static_cast<double>(points) : ErrorFigures::kNone;
}

ErrorsByRule errors_by_rule(const PointErrors& errors, const std::vector<std::uint32_t>& nearest,
                            const std::vector<std::uint8_t>& reason) {
  ErrorsByRule by_rule{};
  if (reason.empty()) return by_rule;
  for (std::size_t i = 0; i < nearest.size(); ++i) {
    const std::uint8_t rule = rule_number(reason[nearest[i]]);
    if (rule >= kPointRules) continue;
    ++by_rule[rule].points;
    by_rule[rule].position += errors.position[i];
    by_rule[rule].color += errors.color[i];
  }
  return by_rule;
}

void append(ErrorsByRule& to, const ErrorsByRule& other) {
  for (std::size_t rule = 0; rule < kPointRules; ++rule) {
    to[rule].points += other[rule].points;
    to[rule].position += other[rule].position;
    to[rule].color += other[rule].color;
  }
}

}  // namespace fovea
