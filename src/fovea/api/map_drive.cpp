#include "fovea/pipeline/map_drive.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <utility>

#include "fovea/api/drive_content.h"
#include "fovea/api/map_settings_of.h"
#include "fovea/api/mapped_frame.h"
#include "fovea/core/parallel.h"
#include "fovea/drive/command_files.h"
#include "fovea/mapper.h"
#include "fovea/pipeline/config.h"
#include "fovea/pipeline/summary_json.h"

namespace fovea {

MapSettings map_settings_of(const MapperSettings& settings) {
  MapSettings result = load_preset(settings.preset);
  for (const auto& [key, value] : settings.values)
    apply_setting(fmt::format("{}={}", key, value), result);
  return result;
}

MapFigures map_figures(const MapSummary& summary, std::string json) {
  MapFigures figures;
  figures.frames = std::size_t(summary.frames_mapped);
  figures.frames_held_out = std::size_t(summary.frames_held_out);
  figures.frames_skipped = std::size_t(summary.skipped());
  figures.points = summary.points;
  figures.frames_per_second = summary.frames_per_second;
  figures.interrupted = summary.interrupted;
  figures.warnings = summary.warnings;
  figures.json = std::move(json);
  return figures;
}

MapFigures map_drive(const Drive& drive, const std::filesystem::path& output,
                     const MapOptions& options,
                     const std::function<void(const MapProgress&)>& progress) {
  check_files({{drive.content()->folder.string()},
               {{output.string(), ContentKind::kMap, options.force || options.resume}}});
  MapJob job;
  job.output = output;
  job.settings = map_settings_of(options.settings);
  job.hold_out = HoldOut::parse(options.hold_out);
  job.calibrate = options.calibrate;
  job.resume = options.resume;
  job.force = options.force;
  job.stop = options.stop;
  const ThreadLimit limit(options.threads);
  const MapSummary summary = map_drive(*drive.content()->source, job, [&](const RunProgress& now) {
    if (progress) progress({now.done, now.total, now.points, mapped_frame(*now.latest)});
  });
  // A note may quote a file's name in any encoding.
  using Json = nlohmann::ordered_json;
  return map_figures(summary, to_json(summary).dump(2, ' ', false, Json::error_handler_t::replace));
}

}  // namespace fovea
