#include "app/convert_bridge.h"

#include <chrono>
#include <optional>

#include "app/print.h"
#include "app/progress_bar.h"
#include "fovea/core/errors.h"
#include "fovea/drive/bridge/bridge_recording.h"

namespace fovea::app {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

/// Prints what a recording lacks, and then how it grows: a line each time something changes, and
/// each ten seconds.
class RecordingStatus {
 public:
  explicit RecordingStatus(bool quiet) : quiet_(quiet) {}

  void show(const bridge::RecordingProgress& progress) {
    if (quiet_ || (last_ == progress.missing && Clock::now() < next_)) return;
    const bool is_first = !last_;
    last_ = progress.missing;
    next_ = Clock::now() + std::chrono::seconds(10);
    if (!progress.missing.empty()) {
      print_err("waits: {}\n", progress.missing);
    } else if (!is_first) {
      print_err("{} scans, {} images; Ctrl-C ends the recording\n", progress.scans,
                progress.images);
    }
  }

 private:
  bool quiet_;
  std::optional<std::string> last_;
  Clock::time_point next_ = Clock::now();
};

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
  job.output = conversion.output.lexically_normal().string() + ".mcap";
  job.force = conversion.force;
  RecordingStatus status(conversion.quiet);
  const bridge::BridgeFigures recorded =
      record_bridge(job, session.interrupt.stop_gently(),
                    [&](const bridge::RecordingProgress& progress) { status.show(progress); });
  ConvertFigures figures;
  try {
    ProgressBar bar(conversion.quiet, "messages");
    figures = convert_bags({job.output}, conversion.output, conversion.force, conversion.options,
                           [&](int done, int total) { bar.draw(done, total); });
  } catch (const Error& error) {
    session.warnings.add({"the recording is kept: " + job.output.string()});
    throw;
  }
  fs::remove(job.output);
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
