#include "fovea/drive/recordings/live_topics.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "fovea/drive/recordings/scan_message.h"
#include "fovea/errors.h"

namespace fovea {
namespace {

/// Scans of the first LiDAR that show the units of its numbers, as those of a recording.
constexpr std::size_t kFirstScans = 5;
/// Scans, since the messages are a drive, for which a topic without a message delays the source.
constexpr std::size_t kMaxScansWaited = 20;

}  // namespace

LiveTopics::LiveTopics(LiveTopicsOptions options)
    : options_(std::move(options)), recent_(options_.max_waiting) {}

bool LiveTopics::is_requested(const BagTopic& topic) {
  if (messages_) return messages_->is_requested(topic);
  const bool is_requested = indexer_.is_requested(topic) && is_chosen(topic);
  if (is_requested && topic.is_readable()) requested_.insert(topic.name);
  return is_requested;
}

bool LiveTopics::is_chosen(const BagTopic& topic) const {
  const ConvertOptions& chosen = options_.topics;
  if (is_scan_type(topic.type) && !chosen.lidars.empty()) {
    return std::find(chosen.lidars.begin(), chosen.lidars.end(), topic.name) != chosen.lidars.end();
  }
  if (topic.type != ros::kImage && topic.type != ros::kCompressedImage) return true;
  if (!options_.live.drive.use_images) return false;
  return chosen.cameras.empty() ||
         std::any_of(chosen.cameras.begin(), chosen.cameras.end(),
                     [&](const auto& camera) { return camera.topic == topic.name; });
}

void LiveTopics::add(const BagTopic& topic, std::string_view message) {
  if (messages_) return messages_->add(topic, message);
  heard_.insert(topic.name);
  indexer_.add(topic, message);
  if (recent_.add(topic, message)) {
    indexer_.forget_past();
    for (const RecentMessages::Message& recent : recent_.messages()) {
      indexer_.add(recent.topic, recent.bytes);
    }
  }
  if (is_scan_type(topic.type)) try_to_begin(kFirstScans, scans_since_plan_ < kMaxScansWaited);
}

void LiveTopics::update() {
  if (messages_) return;
  try {
    plan_conversion(BagIndexer(indexer_).finish(), options_.topics);
  } catch (const InputError& error) {
    set_missing(fmt::format("{} ({})", error.problem(), error.where()));
  }
}

bool LiveTopics::try_to_begin(std::size_t at_least, bool waits_for_silent) {
  const BagIndex index = BagIndexer(indexer_).finish();
  std::optional<ConversionPlan> plan;
  try {
    plan = plan_conversion(index, options_.topics);
  } catch (const InputError& error) {
    set_missing(fmt::format("{} ({})", error.problem(), error.where()));
    return false;
  }
  ++scans_since_plan_;
  const std::string& lidar = plan->lidars.front().topic;
  if (index.lidars.at(lidar).stamps.size() < at_least) {
    set_missing(fmt::format("the first {} scans of {}", at_least, lidar));
    return false;
  }
  const std::string silent = silent_topic();
  if (waits_for_silent && !silent.empty()) {
    set_missing("messages of " + silent);
    return false;
  }
  begin(index, *plan);
  return true;
}

void LiveTopics::begin(const BagIndex& index, const ConversionPlan& plan) {
  chosen_ = plan.notes;
  LiveOptions live = options_.live;
  const NavigationPlan& navigation = plan.navigation;
  live.expects_navigation =
      !navigation.fix.empty() || !navigation.odometry.empty() || !navigation.world.empty();
  auto source = std::make_unique<LiveSource>(drive_toml(plan.drive), live);
  messages_.emplace(index, plan, options_.topics.duration, *source);
  {
    const std::lock_guard lock(mutex_);
    source_ = std::move(source);
    if (abandoned_) source_->close();
    missing_.clear();
  }
  changed_.notify_all();
  for (const RecentMessages::Message& recent : recent_.messages()) {
    messages_->add(recent.topic, recent.bytes);
  }
  recent_.clear();
  indexer_ = BagIndexer();
}

void LiveTopics::close() {
  try {
    if (!messages_ && !try_to_begin(/*at_least=*/1, /*waits_for_silent=*/false)) {
      plan_conversion(BagIndexer(indexer_).finish(), options_.topics);  // reports what is missing
    }
  } catch (...) {
    end();
    throw;
  }
  end();
}

void LiveTopics::end() {
  if (source_) source_->close();
  {
    const std::lock_guard lock(mutex_);
    closed_ = true;
  }
  changed_.notify_all();
}

Messages LiveTopics::unusable() const {
  Messages messages;
  if (!messages_) return messages;
  for (const auto& [topic, unusable] : messages_->unusable()) messages.warn(unusable.note(topic));
  return messages;
}

std::map<std::string, std::size_t> LiveTopics::unusable_counts() const {
  std::map<std::string, std::size_t> counts;
  if (!messages_) return counts;
  for (const auto& [topic, unusable] : messages_->unusable()) counts[topic] = unusable.count;
  return counts;
}

LiveSource* LiveTopics::wait_for_source(std::chrono::milliseconds wait) const {
  std::unique_lock lock(mutex_);
  changed_.wait_for(lock, wait, [&] { return source_ || closed_; });
  return source_.get();
}

void LiveTopics::abandon() {
  const std::lock_guard lock(mutex_);
  if (source_) source_->close();
  abandoned_ = true;
}

bool LiveTopics::is_closed() const {
  const std::lock_guard lock(mutex_);
  return closed_;
}

std::string LiveTopics::missing() const {
  const std::lock_guard lock(mutex_);
  return source_ ? source_->missing() : missing_;
}

std::string LiveTopics::silent_topic() const {
  const auto silent = std::find_if(requested_.begin(), requested_.end(),
                                   [&](const auto& topic) { return !heard_.contains(topic); });
  return silent == requested_.end() ? std::string() : *silent;
}

void LiveTopics::set_missing(std::string missing) {
  const std::lock_guard lock(mutex_);
  missing_ = std::move(missing);
}

}  // namespace fovea
