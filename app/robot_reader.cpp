#include "app/robot_reader.h"

#include <utility>

namespace fovea::app {

RobotReader::RobotReader(bridge::BridgeOptions options, LiveTopics& topics,
                         const std::stop_token& stop, bool quiet)
    : options_(std::move(options)),
      topics_(topics),
      status_(quiet),
      end_with_user_(stop, [this] { ends_.request_stop(); }),
      thread_([this] { read(); }) {}

RobotReader::~RobotReader() {
  ends_.request_stop();
  topics_.abandon();  // or the thread might wait for the mapper
}

LiveSource* RobotReader::wait_for_source() {
  LiveSource* source = nullptr;
  bool is_closed = false;
  while (source == nullptr && !is_closed) {
    is_closed = topics_.is_closed();  // before the wait: a short drive begins as it is closed
    source = topics_.wait_for_source(std::chrono::seconds(1));
  }
  return source;
}

void RobotReader::join() {
  if (thread_.joinable()) thread_.join();
}

void RobotReader::rethrow() const {
  if (error_) std::rethrow_exception(error_);
}

void RobotReader::read() {
  try {
    const auto idle = [this](bool is_connected) { check(is_connected); };
    read_bridge(options_, topics_, ends_.get_token(), idle, figures_);
  } catch (...) {
    error_ = std::current_exception();
  }
  try {
    topics_.close();
  } catch (...) {
    if (!error_) error_ = std::current_exception();
  }
}

void RobotReader::check(bool is_connected) {
  if (topics_.is_over()) ends_.request_stop();
  const auto now = std::chrono::steady_clock::now();
  if (is_connected && now < next_check_) return;
  next_check_ = now + std::chrono::seconds(1);
  topics_.update();
  status_.show(is_connected, topics_.missing());
}

}  // namespace fovea::app
