#include "app/reproduce/rows.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <fstream>

#include "app/reports.h"
#include "fovea/base/version.h"
#include "fovea/evaluation/evaluate.h"
#include "fovea/evaluation/scan_matching.h"
#include "fovea/pipeline/config.h"
#include "fovea/pipeline/map_drive.h"

namespace fovea::app {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kHoldOut = "8:4";

MapperOptions options_of(const std::string& row) {
  const std::vector<std::string> presets = preset_names();
  if (std::find(presets.begin(), presets.end(), row) != presets.end()) return load_preset(row);
  MapperOptions options = load_preset("default");
  apply_variant(row, options);
  return options;
}

/// What figures hang on besides the drive.
std::string fingerprint(const MapperOptions& options, const FrameSource& drive) {
  const DriveInfo& info = drive.info();
  std::vector<int> cameras;
  for (const Camera& camera : info.calibration.cameras) cameras.push_back(camera.index);
  return fmt::format("# fovea {}\n# {}, frames {} to {}, cameras {}\n{}", version(),
                     info.path.string(), info.begin, info.end, fmt::join(cameras, ", "),
                     to_toml(options));
}

Json score(const ScoredMap& map, const FrameSource& drive, Protocol protocol) {
  ProtocolOptions options;
  options.protocol = protocol;
  for (const Camera& camera : drive.info().calibration.cameras) {
    options.cameras.push_back(camera.index);
  }
  Json json = Json::parse(to_json(evaluate(map, drive, options)));
  json.erase("frames");  // the table of every frame is for `fovea evaluate`
  return json;
}

class RowRun {
 public:
  RowRun(const FrameSource& drive, const std::string& row, const std::filesystem::path& folder,
         const std::stop_token& stop)
      : drive_(drive), row_(row), map_file_(folder / (row + ".fovea")), stop_(stop) {}

  /// Null if it was stopped.
  Json run(const MapperOptions& options) {
    Json all = map(options, HoldOut());
    if (stop_.stop_requested()) return nullptr;
    {
      const ScoredMap scored = load_scored_map(map_file_, {});
      all["in_sample"] = score(scored, drive_, Protocol::kInSample);
      if (drive_.info().navigation) {
        all["in_sample_nav"] = score(scored, drive_, Protocol::kInSampleNavigation);
      }
      const ScanMatching matching = scan_matching(scored, drive_);
      all["scan_matching"] = {
          {"mean", matching.mean}, {"points", matching.points}, {"pairs", matching.pairs}};
    }
    Json held = map(options, HoldOut::parse(kHoldOut));
    if (stop_.stop_requested()) return nullptr;
    held["held_out"] = score(load_scored_map(map_file_, {}), drive_, Protocol::kHeldOut);
    std::filesystem::remove(map_file_);
    return {
        {"row", row_}, {"config", fingerprint(options, drive_)}, {"all", all}, {"held_out", held}};
  }

 private:
  Json map(const MapperOptions& options, const HoldOut& hold_out) const {
    MapJob job;
    job.output = map_file_;
    job.options = options;
    job.hold_out = hold_out;
    job.force = true;
    job.stop = stop_;
    return {{"map", to_json(map_drive(drive_, job, [](const MapProgress&) {}))}};
  }

  const FrameSource& drive_;
  const std::string& row_;
  std::filesystem::path map_file_;
  std::stop_token stop_;
};

}  // namespace

std::vector<std::string> reproduced_rows() {
  std::vector<std::string> rows = variant_names();
  rows.emplace_back("paper");
  rows.emplace_back("default");
  return rows;
}

Json run_row(const FrameSource& drive, const std::string& row, const std::filesystem::path& folder,
             const std::stop_token& stop) {
  const MapperOptions options = options_of(row);
  const std::filesystem::path file = folder / (row + ".json");
  if (std::ifstream stream(file); stream) {
    const Json kept = Json::parse(stream, nullptr, /*allow_exceptions=*/false);
    if (kept.is_object() && kept.value("config", "") == fingerprint(options, drive)) return kept;
  }
  Json result = RowRun(drive, row, folder, stop).run(options);
  if (!result.is_null()) {
    OutputFile output(file, /*force=*/true);
    write_json(output, result);
  }
  return result;
}

}  // namespace fovea::app
