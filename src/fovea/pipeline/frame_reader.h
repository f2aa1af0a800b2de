// Reads the frames of a drive from its files, at full speed or at the rate of a live sensor.
#pragma once

#include <cstddef>
#include <optional>
#include <stop_token>
#include <vector>

#include "fovea/core/wall_clock.h"
#include "fovea/drive/frame_source.h"
#include "fovea/pipeline/frame_stream.h"

namespace fovea {

class FrameReader : public FrameStream {
 public:
  /// @param source   must outlive the reader
  /// @param indices  of the frames, in order
  /// @param rate     frames per second of the simulated live sensor; 0: full speed
  FrameReader(const FrameSource& source, std::vector<int> indices, double rate);

  /// The next frame; with a rate, not before it is due. Nothing at the end or if `stop` is
  /// requested. Throws the errors of FrameSource::load.
  std::optional<ReadFrame> next(const std::stop_token& stop) override;

 private:
  void expect_until(std::size_t place);
  std::optional<ReadFrame> load(int index) const;
  std::optional<ReadFrame> load_when_due(std::size_t place, const std::stop_token& stop);

  const FrameSource& source_;
  std::vector<int> indices_;
  double rate_;
  std::size_t next_ = 0;      // place in indices_
  std::size_t expected_ = 1;  // first place not yet passed to source_.expect()
  WallClock::time_point first_arrival_;
};

}  // namespace fovea
