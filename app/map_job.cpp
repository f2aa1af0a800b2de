#include "app/map_job.h"

#include "app/print.h"
#include "fovea/core/machine_error.h"
#include "fovea/errors.h"
#include "fovea/map/map_store.h"
#include "fovea/pipeline/config.h"

namespace fovea::app {
namespace {

MapSettings resolve_settings(const MapArguments& arguments) {
  MapSettings settings = load_preset(arguments.preset);
  if (!arguments.config.empty()) apply_config_file(arguments.config, settings);
  if (!arguments.variant.empty()) settings = with_variant(arguments.variant, settings);
  for (const std::string& setting : arguments.settings) apply_setting(setting, settings);
  return settings;
}

void print_summary(const MapSummary& summary, const MapArguments& arguments) {
  print_out("{}: {} points from {} frames", arguments.output, summary.points,
            summary.frames_mapped);
  if (summary.frames_held_out > 0) print_out(", {} held out", summary.frames_held_out);
  print_out(", {:.1f} frames/s, {:.0f} MB peak\n", summary.frames_per_second, summary.peak_rss_mb);
  if (summary.rate > 0) {
    print_out("at {} Hz: {} frame{} late: not yet in the map when the next one was due\n",
              summary.rate, summary.late_frames, summary.late_frames == 1 ? "" : "s");
  }
  if (!summary.first_damage.empty()) {
    print_out("the first damaged frame: {}\n", summary.first_damage);
  }
  if (summary.loops_closed > 0) {
    print_out("loops closed: {} scans were registered to places seen before\n",
              summary.loops_closed);
  }
}

}  // namespace

CommandFiles files_of(const MapArguments& arguments) {
  CommandFiles files;
  files.inputs = {arguments.config};
  files.outputs = {{arguments.output, ContentKind::kMap, arguments.force || arguments.resume},
                   {arguments.report, ContentKind::kReport, /*force=*/true}};
  return files;
}

MapJob job_of(const MapArguments& arguments) {
  MapJob job;
  job.output = arguments.output;
  job.settings = resolve_settings(arguments);
  job.variant = arguments.variant;
  job.hold_out = parse_hold_out(arguments.hold_out);
  job.rate = arguments.rate;
  job.memory = arguments.memory;
  job.calibrate = arguments.calibrate;
  job.allow_dropped = arguments.allow_dropped;
  job.force = arguments.force;
  job.scratch = arguments.scratch;
  job.resume = arguments.resume;
  return job;
}

void print_run(const MapSummary& summary, const Messages& calibration,
               const MapArguments& arguments, Session& session) {
  session.warnings.add(summary, "note: ", arguments.quiet);
  if (!arguments.quiet) print_summary(summary, arguments);
  session.warnings.add(calibration, "", arguments.quiet);
}

void print_interruption(const MapSummary& summary, const MapArguments& arguments) {
  std::FILE* const out = arguments.quiet ? stderr : stdout;
  if (summary.interrupted) {
    print_to(out, "interrupted: {} keeps the frames mapped so far, --resume continues\n",
             arguments.output);
  } else {
    print_to(out, "interrupted: {} is whole\n", arguments.output);
  }
}

void rethrow_with_log_remedy(const OutputError& error, const std::string& map) {
  const std::string remedy = log_remedy(map);
  if (log_of_map(map).empty() || error.remedy() == remedy) throw;
  const bool of_machine = dynamic_cast<const MachineError*>(&error) != nullptr;
  throw_error<OutputError>(of_machine, error.problem(), error.where(),
                           error.remedy() + "; " + remedy);
}

}  // namespace fovea::app
