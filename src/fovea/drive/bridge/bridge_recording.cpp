#include "fovea/drive/bridge/bridge_recording.h"

#include <fmt/format.h>

#include <map>
#include <optional>

#include "fovea/core/output_file.h"
#include "fovea/drive/recordings/bag_indexer.h"
#include "fovea/drive/recordings/conversion_plan.h"
#include "fovea/drive/recordings/mcap_writer.h"
#include "fovea/drive/recordings/scan_message.h"

namespace fovea::bridge {
namespace {

using Clock = std::chrono::steady_clock;

/// Since the first message: so long what a drive lacks is reported. Memory grows with this time.
constexpr std::chrono::seconds kWatched{60};
constexpr std::chrono::seconds kBetweenChecks{1};

TimeNs now() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

class RecordingSink : public BagSink {
 public:
  explicit RecordingSink(const RecordingJob& job) : job_(job) {}

  bool is_requested(const BagTopic& topic) override { return indexer_.is_requested(topic); }

  void add(const BagTopic& topic, std::string_view message) override {
    if (!writer_) {
      writer_.emplace(job_.output);
      watched_until_ = Clock::now() + kWatched;
    }
    writer_->add(topic, message, now());
    if (is_scan_type(topic.type)) {
      ++progress_.scans;
      if (!first_scan_) first_scan_ = Clock::now();
    }
    if (topic.type == ros::kImage || topic.type == ros::kCompressedImage) ++progress_.images;
    if (is_watched_) indexer_.add(topic, message);
  }

  /// Called between messages.
  const RecordingProgress& check(bool is_connected) {
    progress_.is_connected = is_connected;
    if (Clock::now() < next_check_) return progress_;
    next_check_ = Clock::now() + kBetweenChecks;
    if (writer_) writer_->flush();
    is_watched_ = is_watched_ && Clock::now() < watched_until_;
    if (is_watched_) {
      find_missing();
    } else {
      progress_.missing.clear();
    }
    return progress_;
  }

  bool is_over() const {
    if (!first_scan_) return false;
    const std::chrono::duration<double> passed = Clock::now() - *first_scan_;
    return passed.count() >= job_.options.start + job_.options.duration;
  }

  void finish() {
    if (!writer_) writer_.emplace(job_.output);  // of no message
    writer_->finish();
  }

 private:
  /// Whether what has come so far is a drive.
  void find_missing() {
    try {
      plan_conversion(BagIndexer(indexer_).finish(), job_.options);
      progress_.missing.clear();
    } catch (const InputError& error) {
      progress_.missing = fmt::format("{} ({})", error.problem(), error.where());
    }
  }

  const RecordingJob& job_;
  std::optional<McapWriter> writer_;  // from the first message on
  BagIndexer indexer_;
  RecordingProgress progress_;
  bool is_watched_ = true;
  Clock::time_point watched_until_ = Clock::time_point::max();
  Clock::time_point next_check_ = Clock::now() + kBetweenChecks;
  std::optional<Clock::time_point> first_scan_;
};

}  // namespace

BridgeFigures record_bridge(const RecordingJob& job, const std::stop_token& stop,
                            const std::function<void(const RecordingProgress&)>& progress) {
  check_output_path(job.output, /*force=*/false);  // before anything is recorded
  RecordingSink sink(job);
  std::stop_source ends;
  const std::stop_callback end_with_user(stop, [&] { ends.request_stop(); });
  BridgeFigures figures;
  const auto idle = [&](bool is_connected) {
    progress(sink.check(is_connected));
    if (sink.is_over()) ends.request_stop();
  };
  read_bridge(job.bridge, sink, ends.get_token(), idle, figures);
  sink.finish();
  return figures;
}

std::vector<BagTopic> list_topics(const BridgeOptions& options, std::chrono::milliseconds wait) {
  class Topics : public BagSink {
   public:
    bool is_requested(const BagTopic& topic) override {
      by_name.insert_or_assign(topic.name, topic);
      return false;
    }
    void add(const BagTopic& /*topic*/, std::string_view /*message*/) override {}

    std::map<std::string, BagTopic> by_name;
  };
  Topics topics;
  std::stop_source ends;
  const auto until = Clock::now() + wait;
  const auto idle = [&](bool /*is_connected*/) {
    if (Clock::now() >= until) ends.request_stop();
  };
  BridgeFigures unused;
  read_bridge(options, topics, ends.get_token(), idle, unused);
  std::vector<BagTopic> list;
  list.reserve(topics.by_name.size());
  for (auto& [name, topic] : topics.by_name) list.push_back(std::move(topic));
  return list;
}

}  // namespace fovea::bridge
