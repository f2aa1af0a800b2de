#include "fovea/pipeline/frame_reader.h"

#include <algorithm>
#include <utility>

#include "fovea/core/thread.h"

namespace fovea {
namespace {

/// The system reads the files of the next frames ahead, this one included. A sleeping or busy disk
/// may take a second.
constexpr std::size_t kExpected = 10;
/// With a rate, decoding starts this long before the frame is due, in periods. Earlier it would
/// slow down the frame before.
constexpr double kDecodingTime = 0.5;

}  // namespace

FrameReader::FrameReader(const FrameSource& source, std::vector<int> indices, double rate)
    : source_(source), indices_(std::move(indices)), rate_(rate) {}

std::optional<ReadFrame> FrameReader::next(const std::stop_token& stop) {
  if (next_ == indices_.size() || stop.stop_requested()) return std::nullopt;
  const std::size_t place = next_++;
  expect_until(place + kExpected);
  return rate_ > 0 ? load_when_due(place, stop) : load(indices_[place]);
}

void FrameReader::expect_until(std::size_t place) {
  for (; expected_ < std::min(place, indices_.size()); ++expected_) {
    source_.expect(indices_[expected_]);
  }
}

std::optional<ReadFrame> FrameReader::load(int index) const {
  const WallClock::time_point start = WallClock::now();
  LoadedFrame result = source_.load(index);
  return ReadFrame{std::move(result), milliseconds_since(start)};
}

std::optional<ReadFrame> FrameReader::load_when_due(std::size_t place,
                                                    const std::stop_token& stop) {
  const auto due = [&](double periods) {
    return first_arrival_ + std::chrono::duration_cast<WallClock::duration>(
                                std::chrono::duration<double>(periods / rate_));
  };
  const bool is_first = place == 0;
  if (!is_first && !wait_until(due(double(place) - kDecodingTime), stop)) return std::nullopt;
  std::optional<ReadFrame> frame = load(indices_[place]);
  if (is_first) first_arrival_ = WallClock::now();
  frame->due = due(double(place));
  if (!wait_until(*frame->due, stop)) return std::nullopt;
  return frame;
}

}  // namespace fovea
