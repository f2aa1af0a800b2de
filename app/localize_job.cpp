#include "app/localize_job.h"

#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <utility>

#include "app/map_arguments.h"
#include "app/print.h"
#include "fovea/errors.h"
#include "fovea/localization/pose_table.h"
#include "fovea/map/map_meta.h"
#include "fovea/pipeline/summary_json.h"

namespace fovea::app {
namespace {

bool writes_table(const LocalizeArguments& arguments) {
  return std::filesystem::path(arguments.output).extension() == ".csv";
}

}  // namespace

std::unique_ptr<SurfaceSource> Place::surfaces() const {
  return city ? city_surface_source(*city) : map_surface_source(*map);
}

Place open_place(const std::string& path) {
  Place place;
  if (is_city(path)) {
    place.city = open_city(path);
    place.origin = place.city->origin;
  } else {
    place.map.emplace(open_map(path));
    place.origin = map_origin(place.map->meta());
  }
  return place;
}

CommandFiles files_of(const LocalizeArguments& arguments) {
  CommandFiles files;
  files.inputs = {arguments.drive.drive, arguments.map};
  files.inputs.insert(files.inputs.end(), arguments.truths.begin(), arguments.truths.end());
  if (arguments.guess != kNavigationGuess && arguments.guess != kFirstGuess) {
    files.inputs.push_back(arguments.guess);
  }
  const ContentKind kind = writes_table(arguments) ? ContentKind::kPoseTable : ContentKind::kPoses;
  files.outputs = {{arguments.output, kind, arguments.force},
                   {arguments.report, ContentKind::kReport, /*force=*/true}};
  return files;
}

nlohmann::ordered_json to_json(const LocalizedDrive& localized, const std::string& guess) {
  nlohmann::ordered_json latency = nlohmann::ordered_json::object();
  for (const auto& [stage, times] : localized.latency_ms) {
    latency[stage] = fovea::to_json(times);
  }
  double health = 0;
  for (const Localization& frame : localized.frames) {
    if (frame.state == LocalizationState::kLocalized) health += frame.health;
  }
  const int localized_frames = localized.count(LocalizationState::kLocalized);
  return {{"guess", guess},
          {"frames", localized.frames.size()},
          {"localized", localized_frames},
          {"lost", localized.count(LocalizationState::kLost)},
          {"outside", localized.count(LocalizationState::kOutside)},
          {"skipped", localized.count(LocalizationState::kSkipped)},
          {"found", localized.found()},
          {"health_mean", localized_frames > 0 ? health / localized_frames : 0},
          {"fps", localized.frames_per_second},
          {"peak_rss_mb", localized.peak_rss_mb},
          {"latency_ms", latency}};
}

Messages missing_poses(const LocalizedDrive& localized) {
  Messages messages;
  for (const auto& [state, meaning] :
       {std::pair(LocalizationState::kLost, "lost: the scan fits nowhere that was tried"),
        {LocalizationState::kOutside, "outside: the map has nothing there"}}) {
    const int count = localized.count(state);
    if (count > 0) {
      messages.warn(fmt::format("{} frame{} {}", count, count == 1 ? "" : "s", meaning));
    }
  }
  return messages;
}

void require_poses(const LocalizedDrive& localized, const LocalizeArguments& arguments) {
  if (localized.count(LocalizationState::kLocalized) > 0) return;
  const bool outside =
      localized.count(LocalizationState::kOutside) > localized.count(LocalizationState::kLost);
  throw InputError(
      fmt::format("no scan could be localized: {}",
                  outside ? "the drive lies outside the map" : "the scans fit nowhere in the map"),
      fmt::format("{} in {}", arguments.drive.drive, arguments.map),
      "give a map of the place, or a better --guess");
}

void write_poses(const LocalizedDrive& localized, int begin, int end,
                 const LocalizeArguments& arguments, OutputFile& output) {
  if (writes_table(arguments)) {
    write_pose_table(localized.frames, output.stream());
  } else {
    write_pose_lines(localized.frames, begin, end, output.stream());
  }
}

void print_summary(const LocalizeArguments& arguments, const LocalizedDrive& localized) {
  print_out("{}: {} of {} frames localized (guess: {}), {:.1f} frames/s, {:.0f} MB peak\n",
            arguments.output, localized.count(LocalizationState::kLocalized),
            localized.frames.size(), arguments.guess, localized.frames_per_second,
            localized.peak_rss_mb);
}

}  // namespace fovea::app
