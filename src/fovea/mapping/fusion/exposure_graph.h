// Exposure graph: sparse least squares over the exposures of submaps (docs/method.md 6).
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <vector>

#include "fovea/color.h"

namespace fovea {

/// What one image says of the exposure of its submap. Base-2 logarithms of red, green and blue,
/// relative to the colors of the submap as they are stored.
struct ImageLevel {
  int camera = 0;
  LogGain gain = LogGain::Zero();
  /// The most frequent color in view: mostly that of the road.
  std::optional<LogGain> color;
  /// Exposure time times amplification, where the drive states it; base-2 logarithm.
  std::optional<double> exposure;
};

/// Finds the gain of each submap: color in the exposure of the map = stored color * 2^gain.
/// - Submaps that follow each other share points. Their gains differ by little, and by the same
///   amount per meter: vignetting that remains biases each of them alike.
/// - A revisited place gives the difference of two submaps.
/// - Images prevent drift: the gain of an image is in proportion to its exposure. Where that is
///   unknown, the most frequent color in view is near its median over the drive. Its tint is so in
///   any case, since no exposure states the white balance.
///
/// The result depends only on the order of calls.
class ExposureGraph {
 public:
  /// Opens the next submap, with the gain of the one before.
  /// @param length  from the origin of the submap before, m
  void add_submap(double length);
  /// Adds an image of the last submap.
  void add(const ImageLevel& image);
  /// Adds a surface that two submaps contain.
  /// @param difference  stored color of the later one minus that of the earlier one, base-2
  ///                    logarithms
  void add_revisit(std::size_t earlier, std::size_t later, const LogGain& difference);

  /// By number.
  const std::vector<LogGain>& gains() const { return gains_; }
  /// Improves the gains.
  void optimize();

 private:
  /// Sums over the images of one camera in one submap.
  struct Level {
    Eigen::Array3d gain = Eigen::Array3d::Zero(), color = Eigen::Array3d::Zero();
    double exposure = 0;
    int images = 0, colors = 0, exposures = 0;
  };
  struct Camera {
    std::vector<Level> levels;  // by submap
    std::optional<ImageLevel> last;
    /// Of changes from image to image: gain times exposure, exposure squared.
    double products = 0, squares = 0;

    /// Whether all images state their exposures.
    bool is_metered() const;
    /// Stops of gain per stop of exposure: less than 1 for a camera with a gamma.
    double slope() const;
  };
  struct Revisit {
    std::size_t earlier, later;
    LogGain difference;
  };
  /// What the images of one submap say of its gain, in one channel.
  struct Prior {
    std::size_t submap;
    double gain, deviation;
  };
  class Equations;
  std::vector<Prior> priors_of(const Camera& camera, int channel,
                               const std::vector<double>& gains) const;
  void optimize_channel(int channel, std::size_t first);

  std::map<int, Camera> cameras_;
  std::vector<Revisit> revisits_;
  std::size_t used_revisits_ = 0;  // at the last optimize()
  std::vector<double> lengths_;    // of the submaps, m
  std::vector<LogGain> gains_;
  Eigen::Array3d drift_ = Eigen::Array3d::Zero();  // of the gains per meter
};

}  // namespace fovea
