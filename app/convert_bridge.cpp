#include "app/convert_bridge.h"

#include <fmt/format.h>

#include <chrono>
#include <cstdint>

#include "app/bridge_status.h"
#include "app/print.h"
#include "app/progress_bar.h"
#include "fovea/drive/bridge/bridge_recording.h"
#include "fovea/errors.h"

namespace fovea::app {
namespace {

namespace fs = std::filesystem;

std::string line_of(const bridge::RecordingProgress& progress) {
  if (progress.scans == 0) return "";
  return fmt::format("recorded: {} scans, {} images; Ctrl-C ends the recording", progress.scans,
                     progress.images);
}

/// OUTPUT.mcap, also of "OUTPUT/".
fs::path recording_of(const fs::path& output) {
  fs::path folder = output.lexically_normal();
  if (!folder.has_filename()) folder = folder.parent_path();
  return folder.string() + ".mcap";
}

void check_output(const BridgeConversion& conversion) {
  if (conversion.force || !fs::exists(fs::symlink_status(conversion.output))) return;
  throw OutputError("the output exists already", conversion.output.string(),
                    "remove it, choose another name, or use --force");
}

}  // namespace

ConvertFigures convert_bridge(const BridgeConversion& conversion, Session& session) {
  check_output(conversion);
  bridge::RecordingJob job;
  job.bridge.address = bridge::parse_address(conversion.address);
  job.bridge.reconnect = std::chrono::milliseconds(std::int64_t(1000 * conversion.reconnect));
  job.options = conversion.options;
  job.output = recording_of(conversion.output);
  BridgeStatus status(conversion.quiet);
  const bridge::BridgeFigures recorded = record_bridge(
      job, session.interrupt.stop_gently(), [&](const bridge::RecordingProgress& progress) {
        status.show(progress.is_connected, progress.missing, line_of(progress));
      });
  session.interrupt.stop_at_once();
  if (!conversion.quiet) print_err("the recording is {}\n", job.output.string());
  ProgressBar bar(conversion.quiet, "messages");
  ConvertFigures figures =
      convert_bags({job.output}, conversion.output, conversion.force, conversion.options,
                   [&](int done, int total) { bar.draw(done, total); });
  figures.append(recorded);
  return figures;
}

void list_bridge(const std::string& address) {
  bridge::BridgeOptions options;
  options.address = bridge::parse_address(address);
  for (const BagTopic& topic : bridge::list_topics(options, std::chrono::seconds(2))) {
    print_out("{}  {}, {}\n", topic.name, topic.type, topic.encoding);
  }
}

}  // namespace fovea::app
