#include "fovea/evaluation/truth_colors.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "fovea/core/median.h"
#include "fovea/core/parallel.h"
#include "fovea/errors.h"
#include "fovea/evaluation/metrics.h"

namespace fovea {
namespace {

constexpr double kDepthAbsolute = 0.05, kDepthRelative = 0.01;  // visible within; m, share
constexpr float kEdgeJump = 0.05f;                              // share of the depth
constexpr int kEdgeReach = 2;                                   // pixels

/// Colours to compare, in the order of the map.
struct Samples {
  std::vector<Eigen::Vector3f> truth, map;
  std::vector<std::uint8_t> matte;
  bool grey = false;

  void add(const Eigen::Vector3f& true_color, LogColor map_color, std::uint8_t is_matte) {
    truth.push_back(true_color);
    map.push_back(to_float(map_color));
    matte.push_back(is_matte);
  }
  /// Calls f(true color, map's color, is matte) for each sample.
  template <class F>
  void for_each(F&& f) const {
    for (std::size_t i = 0; i < truth.size(); ++i) f(truth[i], map[i], matte[i] != 0);
  }
};

/// @param for_each  calls a function as Samples::for_each() does
/// @param count     greatest number of samples
template <class ForEach>
ColorErrorSets errors_of(ForEach&& for_each, std::size_t count, bool grey) {
  GainFit fit;
  for_each([&](const Eigen::Vector3f& truth, const Eigen::Vector3f& map, bool) {
    fit.add(truth, map, grey);
  });
  const Eigen::Vector3f gains = fit.gains();
  ColorErrorSets errors;
  for (ColorErrors* set : {&errors.all, &errors.matte}) {
    set->raw.reserve(count);
    set->gain.reserve(count);
  }
  for_each([&](const Eigen::Vector3f& truth, const Eigen::Vector3f& map, bool is_matte) {
    const float raw = color_error(truth, map, grey);
    const float gain = color_error(truth, map.cwiseProduct(gains), grey);
    errors.all.raw.push_back(raw);
    errors.all.gain.push_back(gain);
    if (!is_matte) return;
    errors.matte.raw.push_back(raw);
    errors.matte.gain.push_back(gain);
  });
  return errors;
}

void append(ColorErrors& to, const ColorErrors& from) {
  to.raw.insert(to.raw.end(), from.raw.begin(), from.raw.end());
  to.gain.insert(to.gain.end(), from.gain.begin(), from.gain.end());
}

/// Whether all pixels around one show about the same depth; sky counts as an edge.
bool far_from_edges(const DepthImage& depth, int x, int y) {
  const float center = depth.at(x, y);
  if (!(center > 0)) return false;
  const int left = std::max(x - kEdgeReach, 0), right = std::min(x + kEdgeReach, depth.width - 1);
  const int top = std::max(y - kEdgeReach, 0), bottom = std::min(y + kEdgeReach, depth.height - 1);
  for (int v = top; v <= bottom; ++v) {
    for (int u = left; u <= right; ++u) {
      if (!(std::abs(depth.at(u, v) - center) <= kEdgeJump * center)) return false;
    }
  }
  return true;
}

/// Depth between pixel centres; the inverse of depth is linear in the image of a plane.
double interpolated_depth(const DepthImage& depth, const Eigen::Vector2d& pixel) {
  const int x = std::clamp(static_cast<int>(pixel.x()), 0, depth.width - 2);
  const int y = std::clamp(static_cast<int>(pixel.y()), 0, depth.height - 2);
  const double s = pixel.x() - x, t = pixel.y() - y;
  const double top = (1 - s) / depth.at(x, y) + s / depth.at(x + 1, y);
  const double bottom = (1 - s) / depth.at(x, y + 1) + s / depth.at(x + 1, y + 1);
  return 1 / ((1 - t) * top + t * bottom);
}

/// One true image with its depth.
class TrueView {
 public:
  TrueView(const DriveTruth& truth, const Camera& camera, int frame)
      : camera_(camera),
        T_cam_true_(pose(truth, camera.index, frame).inverse()),
        image_(truth.perfect_image(camera.index, frame)),
        depth_(truth.depth(camera.index, frame)) {
    const bool fits = image_.width == camera.width && image_.height == camera.height &&
                      depth_.width == camera.width && depth_.height == camera.height;
    if (fits) return;
    throw InputError("a perfect image or depth map is not of its camera's size",
                     truth.folder().string() + ", camera " + std::to_string(camera.index) +
                         ", frame " + std::to_string(frame),
                     "write the drive anew with 'fovea simulate'");
  }

  bool grey() const { return image_.channels == 1; }

  /// What the camera saw of a point; nothing if it did not see it well.
  std::optional<Eigen::Vector3f> color_at(const Eigen::Vector3d& p_true) const {
    const Eigen::Vector3d p_cam = T_cam_true_ * p_true;
    const std::optional<Eigen::Vector2d> pixel = scored_pixel(camera_, p_cam);
    if (!pixel) return std::nullopt;
    const auto x = static_cast<int>(std::lround(pixel->x()));
    const auto y = static_cast<int>(std::lround(pixel->y()));
    if (!far_from_edges(depth_, x, y)) return std::nullopt;
    const double seen = interpolated_depth(depth_, *pixel);
    const double tolerance = std::max(kDepthAbsolute, kDepthRelative * seen);
    if (!(std::abs(p_cam.z() - seen) <= tolerance)) return std::nullopt;
    return bilinear(image_, pixel->x(), pixel->y());
  }

 private:
  static RigidMotion pose(const DriveTruth& truth, int camera, int frame) {
    return truth.camera(camera).T_local_cam.at(static_cast<std::size_t>(frame));
  }

  Camera camera_;
  RigidMotion T_cam_true_;
  Image image_;
  DepthImage depth_;
};

/// Points by the frame and camera that coloured them.
std::map<std::pair<int, int>, std::vector<std::uint32_t>> points_by_view(const ColouredTruth& map,
                                                                         int frames) {
  std::map<std::pair<int, int>, std::vector<std::uint32_t>> views;
  const PointCloud& points = map.points_true;
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    if (map.left_out[i] != 0 || points.frame[i] < 0 || points.frame[i] >= frames) continue;
    views[{points.frame[i], points.camera[i]}].push_back(i);
  }
  return views;
}

Samples samples_of_view(const ColouredTruth& map, const std::vector<std::uint32_t>& points,
                        const TrueView& view) {
  Samples samples;
  samples.grey = view.grey();
  for (const std::uint32_t i : points) {
    const Eigen::Vector3d p = map.points_true.origin + map.points_true.position[i].cast<double>();
    const std::optional<Eigen::Vector3f> truth = view.color_at(p);
    if (truth) samples.add(*truth, map.points_true.color[i], map.matches.matte[i]);
  }
  return samples;
}

/// Median of the logarithms of map over truth.
double stops_above_truth(const Samples& samples) {
  std::vector<double> stops;
  for (std::size_t i = 0; i < samples.truth.size(); ++i) {
    for (int c = 0; c < 3; ++c) {
      const float map = samples.map[i][c], truth = samples.truth[i][c];
      if (map > 0 && truth > 0) stops.push_back(double(std::log2(map / truth)));
    }
  }
  return stops.empty() ? 0 : median_of(std::move(stops));
}

/// Least squares over the samples of all views.
Eigen::Vector3f common_gains(const std::vector<Samples>& views) {
  Eigen::Array3d products = Eigen::Array3d::Zero(), squares = Eigen::Array3d::Zero();
  for (const Samples& view : views) {
    for (std::size_t i = 0; i < view.truth.size(); ++i) {
      const Eigen::Array3d map = view.map[i].cast<double>().array();
      products += map * view.truth[i].cast<double>().array();
      squares += map.square();
    }
  }
  return (squares > 0).select(products / squares, 1.0).cast<float>().matrix();
}

}  // namespace

std::set<int> grey_cameras(const DriveTruth& truth, const std::vector<int>& numbers, int frame) {
  std::set<int> grey;
  for (const int number : numbers) {
    const auto& known = truth.camera_numbers();
    if (std::find(known.begin(), known.end(), number) == known.end()) continue;
    if (truth.perfect_image(number, frame).channels == 1) grey.insert(number);
  }
  return grey;
}

ColorErrorSets albedo_errors(const ColouredTruth& map, const std::set<int>& grey) {
  // Without copies of the colors: a city has many points.
  const auto for_each = [&](auto&& f) {
    for (std::size_t i = 0; i < map.points_true.size(); ++i) {
      if (map.left_out[i] != 0 || grey.contains(map.points_true.camera[i])) continue;
      f(to_float(map.matches.albedo[i]), to_float(map.points_true.color[i]),
        map.matches.matte[i] != 0);
    }
  };
  return errors_of(for_each, map.points_true.size(), /*grey=*/false);
}

ViewErrors view_errors(const ColouredTruth& map, const DriveTruth& truth,
                       const std::vector<Camera>& cameras) {
  const auto by_view = points_by_view(map, truth.frames());
  const std::vector<std::pair<std::pair<int, int>, std::vector<std::uint32_t>>> views(
      by_view.begin(), by_view.end());
  std::vector<Samples> samples(views.size());
  parallel_for(views.size(), 1, [&](std::size_t v) {
    const auto& [frame, number] = views[v].first;
    const auto camera = std::find_if(cameras.begin(), cameras.end(),
                                     [&, n = number](const Camera& c) { return c.index == n; });
    if (camera == cameras.end()) return;  // a camera that is not scored
    samples[v] = samples_of_view(map, views[v].second, TrueView(truth, *camera, frame));
  });
  const Eigen::Vector3f gains = common_gains(samples);
  ViewErrors all;
  for (std::size_t v = 0; v < views.size(); ++v) {
    const ColorErrorSets errors = errors_of([&](auto&& f) { samples[v].for_each(f); },
                                            samples[v].truth.size(), samples[v].grey);
    append(all.errors.all, errors.all);
    append(all.errors.matte, errors.matte);
    for (std::size_t i = 0; i < samples[v].truth.size(); ++i) {
      all.one_gain.push_back(
          color_error(samples[v].truth[i], samples[v].map[i].cwiseProduct(gains), samples[v].grey));
    }
    const auto& [frame, camera] = views[v].first;
    all.exposures.push_back(
        {frame, camera, samples[v].truth.size(), stops_above_truth(samples[v])});
  }
  return all;
}

}  // namespace fovea
