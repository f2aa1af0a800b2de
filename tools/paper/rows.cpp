#include "tools/paper/rows.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "app/html_report/report_page.h"
#include "fovea/core/input_file.h"
#include "fovea/core/output_file.h"
#include "fovea/core/path_name.h"
#include "fovea/core/unfinished_output.h"
#include "fovea/drive/calibrated_drive.h"
#include "fovea/evaluation/evaluate.h"
#include "fovea/evaluation/evaluate_truth.h"
#include "fovea/evaluation/scan_matching.h"
#include "fovea/pipeline/config.h"
#include "fovea/pipeline/map_drive.h"
#include "fovea/pipeline/summary_json.h"
#include "fovea/platform.h"
#include "tools/paper/ablations.h"

namespace fovea::paper {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kHoldOut = "8:4";

struct RowPlan {
  MapSettings settings;
  PoseSource pose_source = PoseSource::kRefine;
  bool in_sample = true;  ///< false: an ablation, of which only quality is asked
};

RowPlan plan_of(const std::string& row) {
  const std::vector<std::string> presets = preset_names();
  if (std::find(presets.begin(), presets.end(), row) != presets.end()) return {load_preset(row)};
  RowPlan plan{load_preset("default")};
  if (const Ablation* ablation = find_ablation(row); ablation != nullptr) {
    for (const std::string& setting : ablation->settings) apply_setting(setting, plan.settings);
    if (ablation->navigation_poses) plan.pose_source = PoseSource::kNavigation;
    plan.in_sample = false;
  } else {
    plan.settings = with_variant(row, plan.settings);
  }
  return plan;
}

/// What figures hang on besides the drive.
std::string fingerprint(const RowPlan& plan, const FrameSource& drive) {
  const DriveInfo& info = drive.info();
  std::vector<int> cameras;
  for (const Camera& camera : info.calibration.cameras) cameras.push_back(camera.index);
  return fmt::format("# fovea {}\n# {}, frames {} to {}, cameras {}, poses {}\n{}", version(),
                     info.path.string(), info.begin, info.end, fmt::join(cameras, ", "),
                     plan.pose_source == PoseSource::kRefine ? "refined" : "navigation",
                     to_toml(plan.settings));
}

/// The table of every frame is for `fovea evaluate`.
Json without_frames(const std::string& report) {
  Json json = Json::parse(report);
  json.erase("frames");
  return json;
}

ProtocolOptions protocol_options(const FrameSource& drive, Protocol protocol) {
  ProtocolOptions options;
  options.protocol = protocol;
  for (const Camera& camera : drive.info().calibration.cameras) {
    options.cameras.push_back(camera.index);
  }
  return options;
}

Json score(const ScoredMap& map, const FrameSource& drive, Protocol protocol) {
  return without_frames(to_json(evaluate(map, drive, protocol_options(drive, protocol))));
}

class RowRun {
 public:
  RowRun(const FrameSource& drive, const std::string& row, const std::filesystem::path& folder,
         std::filesystem::path page)
      : drive_(drive), row_(row), map_file_(folder / (row + ".fovea")), page_(std::move(page)) {}

  Json run(const RowPlan& plan) {
    // The row's map is scratch; a signal removes it with what SQLite keeps next to it.
    std::vector<std::filesystem::path> files{map_file_};
    for (const char* ending : {"-wal", "-shm", "-journal"}) {
      files.push_back(std::filesystem::path(map_file_) += ending);
    }
    const UnfinishedOutput scratch(map_file_, files, [] {});
    Json result = {{"row", row_}, {"config", fingerprint(plan, drive_)}};
    if (plan.in_sample) result["all"] = run_all(plan);
    result["held_out"] = run_held_out(plan);
    std::filesystem::remove(map_file_);
    return result;
  }

 private:
  Json run_all(const RowPlan& plan) {
    Json all = map(plan, HoldOut());
    const ScoredMap scored = load_scored_map(map_file_, {});
    all["in_sample"] = score(scored, drive_, Protocol::kInSample);
    if (drive_.info().navigation) {
      all["in_sample_nav"] = score(scored, drive_, Protocol::kInSampleNavigation);
    }
    const ScanMatching matching = scan_matching(scored, drive_);
    all["scan_matching"] = {
        {"mean", matching.mean}, {"points", matching.points}, {"pairs", matching.pairs}};
    return all;
  }

  Json run_held_out(const RowPlan& plan) {
    Json held = map(plan, HoldOut::parse(kHoldOut));
    const ScoredMap scored = load_scored_map(map_file_, {});
    held["held_out"] = score_held_out(scored);
    if (std::filesystem::exists(recorded_folder(drive_.info().path) / "truth/truth.json")) {
      held["truth"] = without_frames(to_json(evaluate_truth(scored, drive_, {})));
    }
    return held;
  }

  Json map(const RowPlan& plan, const HoldOut& hold_out) const {
    MapJob job;
    job.output = map_file_;
    job.settings = plan.settings;
    job.pose_source = plan.pose_source;
    job.hold_out = hold_out;
    job.force = true;
    return {{"map", to_json(map_drive(drive_, job, [](const RunProgress&) {}))}};
  }

  Json score_held_out(const ScoredMap& map) const {
    const ProtocolOptions options = protocol_options(drive_, Protocol::kHeldOut);
    const EvaluationReport report = evaluate(map, drive_, options);
    if (!page_.empty()) {
      OutputFile page(page_, /*force=*/true);
      page.stream() << app::report_page(
          {map, drive_, options, report, row_, name_of(drive_.info().path)});
      page.commit();
    }
    return without_frames(to_json(report));
  }

  const FrameSource& drive_;
  const std::string& row_;
  std::filesystem::path map_file_, page_;
};

}  // namespace

std::vector<std::string> reproduced_rows() {
  std::vector<std::string> rows = variant_names();
  rows.emplace_back("paper");
  rows.emplace_back("default");
  for (const Ablation& row : ablations()) rows.push_back(row.name);
  return rows;
}

void check_row(const std::string& row) { plan_of(row); }

Json run_row(const FrameSource& drive, const std::string& row, const std::filesystem::path& folder,
             const std::filesystem::path& page) {
  const RowPlan plan = plan_of(row);
  if (plan.pose_source == PoseSource::kNavigation && !drive.info().navigation) return nullptr;
  const std::filesystem::path file = folder / (row + ".json");
  const bool has_page = page.empty() || std::filesystem::exists(page);
  if (std::filesystem::exists(file) && has_page) {
    const Json kept = Json::parse(InputFile(file, kDescriptionFile).bytes(), nullptr,
                                  /*allow_exceptions=*/false);
    if (kept.is_object() && kept.value("config", "") == fingerprint(plan, drive)) return kept;
  }
  Json result = RowRun(drive, row, folder, page).run(plan);
  OutputFile output(file, /*force=*/true);
  output.stream() << result.dump(2) << '\n';
  output.commit();
  return result;
}

}  // namespace fovea::paper
