// The thread that reads a running robot while another one maps.
#pragma once

#include <chrono>
#include <exception>
#include <functional>
#include <stop_token>
#include <thread>

#include "app/bridge_status.h"
#include "fovea/drive/bridge/bridge_reader.h"
#include "fovea/drive/recordings/live_topics.h"

namespace fovea::app {

class RobotReader {
 public:
  /// @param topics  outlives this
  /// @param stop    ends the reading, as the robot may
  RobotReader(bridge::BridgeOptions options, LiveTopics& topics, const std::stop_token& stop,
              bool quiet);
  /// Ends the reading.
  ~RobotReader();
  RobotReader(const RobotReader&) = delete;
  RobotReader& operator=(const RobotReader&) = delete;

  /// Waits for the messages that a drive needs. Nullptr if they do not come before the end.
  LiveSource* wait_for_source();
  /// Waits for the end, after which figures() and error() are there.
  void join();
  const bridge::BridgeFigures& figures() const { return figures_; }
  /// Throws the error that ended the reading, if one did.
  void rethrow() const;

 private:
  void read();
  void check(bool is_connected);

  bridge::BridgeOptions options_;
  LiveTopics& topics_;
  BridgeStatus status_;
  std::chrono::steady_clock::time_point next_check_ =
      std::chrono::steady_clock::now() + std::chrono::seconds(1);
  bridge::BridgeFigures figures_;
  std::exception_ptr error_;
  std::stop_source ends_;
  std::stop_callback<std::function<void()>> end_with_user_;
  std::jthread thread_;  // last: it uses all of the above
};

}  // namespace fovea::app
