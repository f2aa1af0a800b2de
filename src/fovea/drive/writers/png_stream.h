// PNG pictures that are written row by row.
#pragma once

#include <cstdint>
#include <memory>
#include <ostream>
#include <span>

namespace fovea {

/// A picture of red, green, blue and opacity, 8 bits each, that is never in memory as a whole.
///
///   PngStream png(stream, width, height);
///   for (int y = 0; y < height; ++y) png.put_row(row(y));
///   png.finish();
class PngStream {
 public:
  /// @param stream  outlives the picture; an error that it throws comes out of the call here
  /// std::invalid_argument without pixels.
  PngStream(std::ostream& stream, int width, int height);
  ~PngStream();
  PngStream(const PngStream&) = delete;
  PngStream& operator=(const PngStream&) = delete;

  /// @param rgba  four bytes a pixel, from the left; rows come from the top
  void put_row(std::span<const std::uint8_t> rgba);
  /// After the last row. std::logic_error if rows are missing.
  void finish();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace fovea
