#include "fovea/drive/bridge/pose_publisher.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "fovea/drive/bridge/pose_messages.h"
#include "fovea/drive/recordings/bag_sink.h"

namespace fovea::bridge {
namespace {

/// The encoding of published messages; empty if there is none for this bridge.
std::string_view encoding_for(const ServerInfo& info) {
  const std::vector<std::string>& accepted = info.encodings;
  for (const std::string_view encoding : {kCdrEncoding, kRos1Encoding, kJsonEncoding}) {
    if (std::find(accepted.begin(), accepted.end(), encoding) != accepted.end()) return encoding;
  }
  return accepted.empty() ? kJsonEncoding : "";
}

}  // namespace

void PosePublisher::begin(Connection& connection) {
  channels_.clear();
  messages_.clear();
  connection.send_from([this] { return next(); });
  unsent_.on_post([&connection] { connection.wake(); });
}

void PosePublisher::end() { unsent_.on_post({}); }

void PosePublisher::take(const ServerInfo& info, Connection& connection) {
  if (!channels_.empty()) {  // the bridge has changed
    static_cast<void>(connection.send({false, unadvertise_message(channels_)}));
    channels_.clear();
    messages_.clear();
  }
  const std::string_view encoding = encoding_for(info);
  refusal_ = !info.accepts_messages ? "the bridge accepts no messages of clients (clientPublish)"
             : encoding.empty()     ? "the bridge accepts messages neither as cdr, ros1 nor json"
                                    : "";
  if (!refusal_.empty()) return;
  std::vector<ClientChannel> channels = pose_channels(encoding);
  // The connection calls next() when it has sent this.
  if (connection.send({false, advertise_message(channels)})) channels_ = std::move(channels);
}

std::optional<WireMessage> PosePublisher::next() {
  if (channels_.empty()) return std::nullopt;
  if (messages_.empty()) {
    const std::optional<PublishedPose> pose = unsent_.take();
    if (!pose) return std::nullopt;
    const std::vector<std::string> payloads = pose_messages(*pose, channels_.front().encoding);
    for (std::size_t k = 0; k < channels_.size(); ++k) {
      messages_.push_back(client_message_data(channels_[k].id, payloads[k]));
    }
  }
  WireMessage message{true, std::move(messages_.front())};
  messages_.pop_front();
  if (messages_.empty()) ++sent_;
  return message;
}

std::vector<std::string> PosePublisher::warnings() const {
  if (!refusal_.empty()) return {refusal_ + ": poses are not published"};
  const Counts counts = this->counts();
  if (counts.dropped == 0) return {};
  return {fmt::format("{} of {} poses were not sent: the bridge did not take them in time",
                      counts.dropped, counts.posted)};
}

}  // namespace fovea::bridge
