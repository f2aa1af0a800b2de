#include "app/html_report/close_ups.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "app/html_report/markup.h"
#include "fovea/geometry/transform_cloud.h"
#include "fovea/pipeline/paper_mapper.h"

namespace fovea::app {
namespace {

constexpr std::size_t kViews = 3;
constexpr int kReach = 8;  // training frames before and after, that a baseline is made of
constexpr int kPatchWidth = 150, kPatchHeight = 100, kMagnified = 3, kQuality = 88;

/// The coloured points of a map that keeps every point of the scans around a frame, as the paper's
/// baselines do.
ColoredPoints baseline_points(const FrameSource& drive, const std::vector<PlacedFrame>& training,
                              int frame, const Eigen::Vector3d& origin_local) {
  PaperOptions options;
  apply_variant("baseline-gicp", options);
  PaperMapper mapper(drive.info(), options, PoseSource::kGiven);
  for (const PlacedFrame& placed : training) {
    if (std::abs(placed.index - frame) > kReach) continue;
    if (const auto loaded = load_frame(drive, placed)) {
      mapper.process(loaded->frame, {.given_pose = placed.T_local_lidar});
    }
  }
  PointCloud all;
  all.origin = origin_local;
  for (const Submap& submap : mapper.map().submaps()) {
    for (const auto& [key, stored] : submap.tiles) {
      all.append(transform_cloud(stored.points->cloud(), submap.T_local_submap, origin_local));
    }
  }
  return colored_points(all);
}

/// Mean difference of the channels between a drawing and the photograph at a pixel.
float error_at(const SplatView& drawn, const Image& photograph, std::size_t pixel) {
  const std::size_t channels = photograph.channels;
  int sum = 0;
  for (std::size_t c = 0; c < 3; ++c) {
    sum += std::abs(int(drawn.image.data[3 * pixel + c]) -
                    int(photograph.data[channels * pixel + (channels == 3 ? c : 0)]));
  }
  return float(sum) / 3;
}

/// Whether two depths are one surface's, as colour rules have it (m).
bool same_surface(float a, float b) { return std::abs(a - b) <= 0.1f + 0.02f * std::min(a, b); }

/// Sums over rectangles in constant time.
class IntegralImage {
 public:
  IntegralImage(int width, int height)
      : width_(width + 1), sums_(std::size_t(width_) * (height + 1)) {}
  /// Row by row.
  void set(int x, int y, double value) {
    at(x + 1, y + 1) = value + at(x, y + 1) + at(x + 1, y) - at(x, y);
  }
  double sum(int x, int y, int width, int height) {
    return at(x + width, y + height) - at(x, y + height) - at(x + width, y) + at(x, y);
  }

 private:
  double& at(int x, int y) { return sums_[static_cast<std::size_t>(y) * width_ + x]; }
  int width_;
  std::vector<double> sums_;
};

Image magnified(const Image& image, const Patch& patch, int width, int height) {
  Image large(kMagnified * width, kMagnified * height, 3);
  for (int y = 0; y < large.height; ++y) {
    for (int x = 0; x < large.width; ++x) {
      const std::uint8_t* pixel = image.pixel(patch.x + x / kMagnified, patch.y + y / kMagnified);
      for (int c = 0; c < 3; ++c) large.pixel(x, y)[c] = pixel[image.channels == 3 ? c : 0];
    }
  }
  return large;
}

/// The mean of that over the patch's pixels that both drawings cover.
double error_in(const SplatView& drawn, const SplatView& other, const Image& photograph,
                const Patch& patch, int width, int height) {
  double sum = 0;
  std::size_t pixels = 0;
  for (int y = patch.y; y < patch.y + height; ++y) {
    for (int x = patch.x; x < patch.x + width; ++x) {
      const auto i = static_cast<std::size_t>(y) * drawn.image.width + x;
      if (drawn.covered[i] == 0 || other.covered[i] == 0) continue;
      sum += error_at(drawn, photograph, i);
      ++pixels;
    }
  }
  return sum / static_cast<double>(std::max<std::size_t>(1, pixels));
}

/// How much nearer to the photograph the map is than the baseline, at pixels beside edges of depth
/// where both show the same surface; 0 elsewhere.
std::vector<float> advantages(const SplatView& map, const SplatView& baseline,
                              const Image& photograph) {
  const std::vector<std::uint8_t> edges = near_depth_edges(map);
  std::vector<float> advantage(edges.size(), 0);
  for (std::size_t i = 0; i < edges.size(); ++i) {
    if (edges[i] == 0 || baseline.covered[i] == 0) continue;
    // Beyond the far range the map promises nothing.
    if (map.depth[i] > kEvaluatedFar || !same_surface(map.depth[i], baseline.depth[i])) continue;
    advantage[i] = error_at(baseline, photograph, i) - error_at(map, photograph, i);
  }
  return advantage;
}

std::string figure(const Image& image, const Patch& patch, int width, int height,
                   const std::string& caption) {
  return fmt::format(
      "<figure class=\"pixels\"><img alt=\"{}\" src=\"{}\"/><figcaption>{}</figcaption></figure>\n",
      escaped(caption.substr(0, caption.find(':'))),
      jpeg_uri(magnified(image, patch, width, height), kQuality), escaped(caption));
}

}  // namespace

std::vector<std::uint8_t> near_depth_edges(const SplatView& drawn) {
  constexpr int kReachPixels = 8;
  constexpr float kStep = 0.5f, kShare = 0.1f;  // m; of the nearer one's
  const int width = drawn.image.width, height = drawn.image.height;
  const auto at = [&](int x, int y) { return static_cast<std::size_t>(y) * width + x; };
  // The nearest and farthest depth around each pixel, along rows and then along columns.
  std::vector<float> near = drawn.depth, far(drawn.depth.size());
  for (std::size_t i = 0; i < far.size(); ++i) far[i] = drawn.covered[i] != 0 ? near[i] : 0;
  for (const bool along_rows : {true, false}) {
    const std::vector<float> near_before = near, far_before = far;
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        for (int d = -kReachPixels; d <= kReachPixels; ++d) {
          const int u = along_rows ? x + d : x, v = along_rows ? y : y + d;
          if (u < 0 || v < 0 || u >= width || v >= height) continue;
          near[at(x, y)] = std::min(near[at(x, y)], near_before[at(u, v)]);
          far[at(x, y)] = std::max(far[at(x, y)], far_before[at(u, v)]);
        }
      }
    }
  }
  std::vector<std::uint8_t> marks(near.size(), 0);
  for (std::size_t i = 0; i < marks.size(); ++i) {
    if (drawn.covered[i] == 0) continue;
    const float depth = drawn.depth[i];
    const auto edge = [&](float nearer, float farther) {
      return farther - nearer > std::max(kStep, kShare * nearer);
    };
    marks[i] = edge(near[i], depth) || edge(depth, far[i]) ? 1 : 0;
  }
  return marks;
}

std::optional<Patch> most_extreme(const std::vector<float>& values, int image_width, int width,
                                  int height) {
  const int image_height = static_cast<int>(values.size()) / image_width;
  if (width > image_width || height > image_height) return std::nullopt;
  IntegralImage sums(image_width, image_height);
  for (int y = 0; y < image_height; ++y) {
    for (int x = 0; x < image_width; ++x) {
      sums.set(x, y, values[static_cast<std::size_t>(y) * image_width + x]);
    }
  }
  Patch best;
  for (int y = 0; y + height <= image_height; ++y) {
    for (int x = 0; x + width <= image_width; ++x) {
      const double sum = sums.sum(x, y, width, height);
      // Rounding of the sums must not make one of nothing.
      if (std::abs(sum) > std::abs(best.sum) + 1e-6) best = Patch{x, y, sum};
    }
  }
  if (best.sum == 0) return std::nullopt;
  return best;
}

std::string close_up_section(const Scorer& scorer, const FrameSource& drive,
                             const std::vector<PlacedFrame>& training,
                             const std::vector<PlacedFrame>& scored,
                             const std::vector<ShownView>& views) {
  std::string html;
  const std::size_t places = std::min(kViews, views.size());
  for (std::size_t k = 0; k < places; ++k) {
    const ShownView& view = views[places == 1 ? 0 : k * (views.size() - 1) / (places - 1)];
    const auto placed = std::find_if(scored.begin(), scored.end(), [&](const PlacedFrame& f) {
      return f.index == view.report.frame;
    });
    const auto camera =
        std::find_if(scorer.cameras().begin(), scorer.cameras().end(),
                     [&](const Camera& c) { return c.index == view.report.camera; });
    const ColoredPoints points =
        baseline_points(drive, training, view.report.frame, scorer.coloured().origin);
    if (points.position.empty()) continue;
    const SplatView baseline = splat(points, sample_spacing(points.position), *camera,
                                     camera->T_cam_lidar * placed->T_local_lidar.inverse(),
                                     {.min_depth = kEvaluatedDepth});
    const SplatView& drawn = view.picture.drawn;
    const int width = std::min(kPatchWidth, camera->width);
    const int height = std::min(kPatchHeight, camera->height);
    const Image& photograph = view.picture.photograph;
    const std::optional<Patch> patch =
        most_extreme(advantages(drawn, baseline, photograph), camera->width, width, height);
    if (!patch) continue;
    html += fmt::format("<h3 class=\"above\">Frame {}, camera {}</h3>\n<div class=\"strip\">\n",
                        view.report.frame, view.report.camera);
    html += figure(
        baseline.image, *patch, width, height,
        fmt::format("Baseline: every point kept, no test of occlusion; {:.1f} off the photograph",
                    error_in(baseline, drawn, photograph, *patch, width, height)));
    html += figure(drawn.image, *patch, width, height,
                   fmt::format("This map: {:.1f} off the photograph",
                               error_in(drawn, baseline, photograph, *patch, width, height)));
    html += figure(photograph, *patch, width, height, "Photograph");
    html += "</div>\n";
  }
  if (html.empty()) {
    return excuse("No view shows both this map and a baseline made from the drive's own scans.");
  }
  return "<p>Beside edges of depth, where one of this map and a baseline is nearer to the "
         "photograph "
         "than the other by most, whichever it is. The baseline is made from the same drive's "
         "scans "
         "around the frame under the same poses: it keeps every point and paints each with the "
         "pixel it projects to, so that what stands in front is painted on "
         "what stands behind. Numbers: mean difference of the channels where both are drawn "
         "(0-255).</p>\n" +
         html;
}

}  // namespace fovea::app
