#include "fovea/drive/bridge/bridge_recording.h"

#include <fmt/format.h>

#include <map>
#include <optional>

#include "fovea/drive/recordings/bag_indexer.h"
#include "fovea/drive/recordings/conversion_plan.h"
#include "fovea/drive/recordings/mcap_writer.h"
#include "fovea/drive/recordings/scan_message.h"

namespace fovea::bridge {
namespace {

using Clock = std::chrono::steady_clock;

/// Messages of a topic that are read while something is missing: memory does not grow.
constexpr std::size_t kMostIndexed = 200;
constexpr std::chrono::milliseconds kBetweenPlans{1000};

TimeNs now() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

class Recorder : public BagSink {
 public:
  explicit Recorder(const RecordingJob& job) : job_(job), writer_(job.output, job.force) {}

  bool is_requested(const BagTopic& topic) override { return indexer_.is_requested(topic); }

  void add(const BagTopic& topic, std::string_view message) override {
    writer_.add(topic, message, now());
    if (is_scan_type(topic.type)) {
      ++progress_.scans;
      if (!first_scan_) first_scan_ = Clock::now();
    }
    if (topic.type == ros::kImage || topic.type == ros::kCompressedImage) ++progress_.images;
    if (!is_complete_ && ++indexed_[topic.name] <= kMostIndexed) indexer_.add(topic, message);
  }

  /// Called between messages.
  const RecordingProgress& check() {
    if (!is_complete_ && Clock::now() >= next_plan_) {
      next_plan_ = Clock::now() + kBetweenPlans;
      plan();
    }
    return progress_;
  }

  bool is_over() const {
    if (!first_scan_) return false;
    const std::chrono::duration<double> passed = Clock::now() - *first_scan_;
    return passed.count() >= job_.options.start + job_.options.duration;
  }

  void finish() { writer_.finish(); }

 private:
  /// Whether what has come so far is a drive.
  void plan() {
    try {
      plan_conversion(BagIndexer(indexer_).finish(), job_.options);
      progress_.missing.clear();
      is_complete_ = true;
    } catch (const InputError& error) {
      progress_.missing = fmt::format("{} ({})", error.problem(), error.where());
    }
  }

  const RecordingJob& job_;
  McapWriter writer_;
  BagIndexer indexer_;
  std::map<std::string, std::size_t> indexed_;  // messages by topic
  RecordingProgress progress_;
  bool is_complete_ = false;
  Clock::time_point next_plan_ = Clock::now() + kBetweenPlans;
  std::optional<Clock::time_point> first_scan_;
};

}  // namespace

BridgeFigures record_bridge(const RecordingJob& job, const std::stop_token& stop,
                            const std::function<void(const RecordingProgress&)>& progress) {
  Recorder recorder(job);
  std::stop_source ends;
  const std::stop_callback end_with_user(stop, [&] { ends.request_stop(); });
  BridgeFigures figures = read_bridge(job.bridge, recorder, ends.get_token(), [&] {
    progress(recorder.check());
    if (recorder.is_over()) ends.request_stop();
  });
  recorder.finish();
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
  read_bridge(options, topics, ends.get_token(), [&] {
    if (Clock::now() >= until) ends.request_stop();
  });
  std::vector<BagTopic> list;
  for (auto& [name, topic] : topics.by_name) list.push_back(std::move(topic));
  return list;
}

}  // namespace fovea::bridge
