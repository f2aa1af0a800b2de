#include "fovea/evaluation/evaluate.h"

#include <nlohmann/json.hpp>
#include <utility>

#include "fovea/core/parallel.h"
#include "fovea/evaluate.h"
#include "fovea/evaluation/evaluate_truth.h"
#include "fovea/pipeline/drive_match.h"
#include "fovea/pipeline/stored_calibration.h"

namespace fovea {
namespace {

constexpr const char* kTruth = "truth";

std::optional<double> number_of(const nlohmann::json& json, const char* key) {
  const auto found = json.find(key);
  if (found == json.end() || !found->is_number()) return std::nullopt;
  return found->get<double>();
}

}  // namespace

Evaluation evaluate_map(const std::filesystem::path& map, const std::filesystem::path& drive,
                        const EvaluationOptions& options,
                        const std::function<void(std::size_t, std::size_t)>& progress) {
  const bool by_truth = options.protocol == kTruth;
  ProtocolOptions protocol{.cameras = options.cameras,
                           .hold_out = HoldOut::parse(options.hold_out)};
  if (!by_truth) protocol.protocol = parse_protocol(options.protocol);
  const ThreadLimit limit(options.threads);
  ScoredMap scored = load_scored_map(map, {.poses = std::nullopt});
  DriveOptions wanted;
  wanted.cameras = options.cameras.empty() ? scored.cameras : options.cameras;
  std::unique_ptr<FrameSource> source = open_drive(drive, wanted);
  if (!options.foreign) {
    const DriveMatch match = match_drive(MapReader(map), *source, map);
    if (!match.keeps_numbers) choose_frames(match.number_in_drive, scored);
  }
  const bool is_corrected = has_stored_calibration(scored.meta);
  if (is_corrected) source = with_stored_calibration(std::move(source), scored.meta, map);
  Evaluation evaluation;
  if (by_truth) {
    evaluation.json = to_json(evaluate_truth(std::move(scored), *source, {}));
  } else {
    EvaluationReport report = evaluate(std::move(scored), *source, protocol, progress);
    report.calibration = is_corrected ? map.string() : "drive";
    evaluation.json = to_json(report);
  }
  const nlohmann::json figures = nlohmann::json::parse(evaluation.json);
  evaluation.mapping_error = number_of(figures, "me_mean");
  evaluation.texture_error = number_of(figures, "te_mean");
  evaluation.coverage_5cm = number_of(figures, "coverage_5cm");
  return evaluation;
}

}  // namespace fovea
