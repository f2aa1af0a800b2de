#include "fovea/pipeline/map_colors.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "fovea/base/parallel.h"
#include "fovea/base/random.h"
#include "fovea/mapping/color_fusion.h"
#include "fovea/mapping/projected_block.h"
#include "fovea/pipeline/foveal_query.h"

namespace fovea {
namespace {

constexpr std::size_t kGrain = 8192, kBlock = ColorBlock::kSize;
/// Radius of the disc that a point stands for over the points' spacing: discs of neighbours
/// overlap.
constexpr float kDiscRadius = 0.75f;
/// Seed of the rounding of colours.
constexpr std::uint64_t kRounding = 0x636f6c6f7572ull;

/// Every how many points in view are asked for the exposure.
constexpr std::size_t kExposureStep = 64;
/// Share of a gain that is undone.
constexpr float kUndone = 0.9f;

static_assert(kGrain / kExposureStep <= kBlock && kGrain <= 1 << 16);
static_assert(kGrain % TilePoints::kBoxed == 0 && TilePoints::kBoxed <= ProjectedBlock::kSize);

/// The planes that bound a camera's view, in the axes of a tile: which of its boxes may reach into
/// it. Tells what is out of view without asking for each point.
class ViewBounds {
 public:
  ViewBounds(const Camera& camera, const RigidMotion& T_cam_tile) {
    const std::array<Eigen::Vector3d, 5> inwards{
        Eigen::Vector3d(0, 0, 1), Eigen::Vector3d(camera.fx, 0, camera.cx),
        Eigen::Vector3d(-camera.fx, 0, camera.width - 1 - camera.cx),
        Eigen::Vector3d(0, camera.fy, camera.cy),
        Eigen::Vector3d(0, -camera.fy, camera.height - 1 - camera.cy)};
    for (std::size_t i = 0; i < planes_.size(); ++i) {
      const Eigen::Vector3d normal_cam = inwards[i].normalized();
      planes_[i].normal = (T_cam_tile.linear().transpose() * normal_cam).cast<float>();
      planes_[i].offset = static_cast<float>(normal_cam.dot(T_cam_tile.translation())) + kHair;
    }
  }

  bool may_hold(const TilePoints::Box& box) const {
    const auto corner = [](const TilePoints::Steps& steps) -> Eigen::Array3f {
      return Eigen::Array3f(steps[0], steps[1], steps[2]) * kPositionStep;
    };
    const Eigen::Array3f low = corner(box.low), high = corner(box.high);
    const Eigen::Vector3f center = (low + high) / 2, half = (high - low) / 2;
    return std::all_of(planes_.begin(), planes_.end(), [&](const Plane& plane) {
      return plane.normal.dot(center) + plane.normal.cwiseAbs().dot(half) + plane.offset >= 0;
    });
  }

 private:
  static constexpr float kHair = 1e-3f;  // m: single precision tells which points are in view
  struct Plane {
    Eigen::Vector3f normal;  // to the inside
    float offset;
  };
  std::array<Plane, 5> planes_;
};

}  // namespace

Eigen::Array3f matching_gain(const Eigen::Array3f& gain_to_map) { return gain_to_map.pow(kUndone); }

void colour_new_points(PointCloud& points_cam, const ColorView& view) {
  const std::size_t n = points_cam.size();
  points_cam.frame.assign(n, view.frame);
  points_cam.camera.assign(n, static_cast<std::int8_t>(view.camera.index));
  points_cam.color.resize(n);
  points_cam.views.resize(n);
  points_cam.spread.resize(n);
  points_cam.weight.resize(n);
  if (view.is_exposure_matched()) {
    for (std::uint8_t& reason : points_cam.reason) reason |= kExposureMatched;
  }
  const PatchColors patches(view);
  parallel_chunks(n, kBlock, [&](std::size_t begin, std::size_t end) {
    ViewPlaces places;
    SeenColors seen{};
    for (std::size_t i = begin; i < end; ++i) {
      const Eigen::Vector3f& p = points_cam.position[i];
      places.put(i - begin, pixel_of(view.camera, p), p.z());
      seen.weight[i - begin] = view_weight(p.norm());
    }
    patches.at(places, end - begin, seen.color);
    FusedColors fused{};
    fuse(fused, seen, end - begin);
    const auto first = static_cast<std::ptrdiff_t>(begin);
    std::copy_n(fused.views.begin(), end - begin, points_cam.views.begin() + first);
    std::copy_n(fused.spread.begin(), end - begin, points_cam.spread.begin() + first);
    std::copy_n(fused.weight.begin(), end - begin, points_cam.weight.begin() + first);
    for (std::size_t j = 0; j < end - begin; ++j) {
      points_cam.color[begin + j] = {fused.red[j], fused.green[j], fused.blue[j]};
    }
  });
}

void SeenMap::gather(const TileMap& map, const FovealRegion& region,
                     const RigidMotion& T_cam_local) {
  pieces_.clear();
  const Eigen::Vector3d lidar_local = T_cam_local.inverse() * camera_.T_cam_lidar.translation();
  map.for_each_tile_near(
      lidar_local, region.far_range(), [&](const TileId& id, const TilePoints& points) {
        const RigidMotion T_cam_tile = T_cam_local * map.submaps()[id.submap].T_local_submap *
                                       Eigen::Translation3d(points.origin);
        if (points.empty() || !ViewBounds(camera_, T_cam_tile).may_hold(points.box)) return;
        const auto size = static_cast<std::uint32_t>(points.size());
        for (std::uint32_t begin = 0; begin < size; begin += std::uint32_t(kGrain)) {
          const std::uint32_t end = std::min(size, begin + std::uint32_t(kGrain));
          pieces_.push_back({id, &points, T_cam_tile, begin, end, pieces_.size() % kShares, 0, 0});
        }
      });
}

void SeenMap::look(const TileMap& map, const FovealRegion& region, const RigidMotion& T_cam_local,
                   double spacing) {
  camera_ = region.camera();
  steps_ = ViewSteps(camera_, region.far_range() + camera_.T_cam_lidar.translation().norm());
  disc_radius_ = kDiscRadius * static_cast<float>(spacing * camera_.fx);
  gather(map, region, T_cam_local);
  parallel_for(kShares, 1, [&](std::size_t share) {
    shares_[share].front.clear(camera_);
    std::size_t first = 0;
    for (std::size_t k = share; k < pieces_.size(); k += kShares) {
      pieces_[k].first = first;
      look_at(region, pieces_[k]);
      first += pieces_[k].seen;
    }
  });
  std::swap(front_, shares_[0].front);
  for (std::size_t share = 1; share < kShares; ++share) front_.add(shares_[share].front);
}

void SeenMap::look_at(const FovealRegion& region, Piece& piece) {
  const Eigen::Matrix3f R = piece.T_cam_tile.linear().cast<float>();
  const Eigen::Vector3f t = piece.T_cam_tile.translation().cast<float>();
  const ViewBounds bounds(camera_, piece.T_cam_tile);
  ProjectedBlock block(camera_);
  std::array<std::int32_t, ProjectedBlock::kSize> in_zone;
  std::array<PointInView, ProjectedBlock::kSize> points;
  const ViewSteps view_steps = steps_;
  ViewPlaces samples;
  Share& share = shares_[piece.share];
  const std::size_t most = piece.first + (piece.end - piece.begin);
  if (share.points.size() < most) share.points.resize(most + most / 8);
  PointInView* out = share.points.data() + piece.first;
  constexpr auto kBoxed = static_cast<std::uint32_t>(TilePoints::kBoxed);
  for (std::uint32_t begin = piece.begin; begin < piece.end; begin += kBoxed) {
    if (!bounds.may_hold(piece.points->boxes[begin / kBoxed])) continue;
    const std::uint32_t n = std::min(piece.end - begin, kBoxed);
    const auto steps = [&](std::size_t axis) {
      return std::span(piece.points->position[axis]).subspan(begin, n);
    };
    block.project({steps(0), steps(1), steps(2)}, kPositionStep, R, t);
    for (std::size_t i = 0; i < in_zone.size(); ++i) {
      in_zone[i] = region.in_white_zone(block.p_cam(i));
    }
    if (region.has_slices()) {
      for (std::uint32_t i = 0; i < n; ++i) {
        if (in_zone[i] != 0 && !region.in_slices(block.p_cam(i))) in_zone[i] = 0;
      }
    }
    const std::uint32_t first = begin - piece.begin;
    for (std::uint32_t i = 0; i < points.size(); ++i) {
      points[i] =
          view_steps.seen(block.pixel(i), block.depth(i), static_cast<std::uint16_t>(first + i));
    }
    std::size_t in_view = 0, in_region = 0;
    for (std::uint32_t i = 0; i < n; ++i) {
      // Written always, and kept by a step on: no branch, which nobody could foresee.
      out[in_region] = points[i];
      samples.put(in_view, block.pixel(i), block.depth(i));
      in_view += block.in_view(i);
      in_region += block.in_view(i) & (in_zone[i] != 0);
    }
    share.front.add(samples, in_view, disc_radius_);
    out += in_region;
    piece.seen += in_region;
  }
}

void SeenMap::weigh(const ViewPlaces& places, std::size_t count,
                    std::span<std::uint16_t, kBlock> weight) const {
  const auto fx = static_cast<float>(camera_.fx), fy = static_cast<float>(camera_.fy),
             cx = static_cast<float>(camera_.cx), cy = static_cast<float>(camera_.cy);
  for (std::size_t i = 0; i < count; ++i) {
    const float right = (places.u[i] - cx) * (1 / fx), down = (places.v[i] - cy) * (1 / fy);
    weight[i] = view_weight(places.depth[i] * std::sqrt(1 + right * right + down * down));
  }
}

template <class F>
void SeenMap::for_each_block(const PointCloud& points_cam, std::size_t begin, std::size_t end,
                             F&& f) const {
  ProjectedBlock block(camera_);
  for (; begin < end; begin += kBlock) {
    const std::size_t block_end = std::min(begin + kBlock, end);
    block.project(std::span(points_cam.position).subspan(begin, block_end - begin),
                  Eigen::Matrix3f::Identity(), Eigen::Vector3f::Zero());
    f(begin, block_end, block);
  }
}

void SeenMap::put_in_front(const PointCloud& points_cam) {
  const std::size_t of_share = (points_cam.size() + kShares - 1) / kShares;
  parallel_for(kShares, 1, [&](std::size_t share) {
    DepthBuffer& front = shares_[share].front;
    front.clear(camera_);
    const std::size_t end = std::min(points_cam.size(), (share + 1) * of_share);
    ViewPlaces samples;
    for_each_block(points_cam, share * of_share, end,
                   [&](std::size_t begin, std::size_t block_end, const ProjectedBlock& block) {
                     std::size_t count = 0;
                     for (std::size_t i = 0; i < block_end - begin; ++i) {
                       if (block.in_view(i)) samples.put(count++, block.pixel(i), block.depth(i));
                     }
                     front.add(samples, count, disc_radius_);
                   });
  });
  for (const Share& share : shares_) front_.add(share.front);
}

std::vector<std::uint8_t> SeenMap::marks_before(const PointCloud& points_cam) const {
  std::vector<std::uint8_t> marks(points_cam.size());
  parallel_chunks(marks.size(), kGrain, [&](std::size_t chunk_begin, std::size_t chunk_end) {
    for_each_block(points_cam, chunk_begin, chunk_end,
                   [&](std::size_t begin, std::size_t end, const ProjectedBlock& block) {
                     for (std::size_t i = 0; i < end - begin; ++i) {
                       marks[begin + i] =
                           block.in_view(i) && front_.stands_before(block.pixel(i), block.depth(i));
                     }
                   });
  });
  return marks;
}

SeenMap::Differences SeenMap::differences_at(const Piece& piece, const PatchColors& patches) const {
  const TilePoints& tile = *piece.points;
  const std::span<const PointInView> points = seen(piece);
  ViewPlaces places;
  std::array<Eigen::Array3f, kBlock> known;
  std::size_t n = 0;
  for (std::size_t i = 0; i < points.size(); i += kExposureStep) {
    const PointInView& point = points[i];
    const std::uint32_t index = piece.begin + point.place;
    const FusedColor& color = tile.colors[index];
    if (color.views < 2) continue;
    const Eigen::Vector2f pixel = steps_.pixel(point);
    if (front_.hides(pixel, steps_.depth(point))) continue;
    known[n] = to_float(color.color).array();
    places.put(n++, pixel, steps_.depth(point));
  }
  ColorBlock here;
  patches.at(places, n, here);
  Differences differences;
  differences.points = n;
  for (std::size_t j = 0; j < n; ++j) {
    const Eigen::Array3f color(here.red[j], here.green[j], here.blue[j]);
    differences.sum += double((known[j] - color).abs().mean());
    if (const auto gain = gain_between(known[j], color)) differences.gains.push_back(*gain);
  }
  return differences;
}

SeenMap::Comparison SeenMap::compare(const ColorView& view) const {
  const PatchColors patches(view);
  std::vector<Differences> of_piece(pieces_.size());
  parallel_for(pieces_.size(), 1,
               [&](std::size_t k) { of_piece[k] = differences_at(pieces_[k], patches); });
  std::vector<Eigen::Array3f> gains;
  Comparison comparison;
  double sum = 0;
  for (const Differences& piece : of_piece) {
    gains.insert(gains.end(), piece.gains.begin(), piece.gains.end());
    comparison.points += piece.points;
    sum += piece.sum;
  }
  comparison.gain = median_gain(gains);
  if (comparison.points > 0) comparison.error = sum / double(comparison.points);
  return comparison;
}

std::size_t SeenMap::recolour_block(std::span<const PointInView> points, std::uint32_t piece_begin,
                                    std::span<FusedColor> colors, const PatchColors& patches,
                                    const NoiseKinds& noise,
                                    std::vector<std::uint32_t>& first_seen) const {
  ViewPlaces all;
  const ViewSteps view_steps = steps_;
  for (std::size_t i = 0; i < points.size(); ++i) {
    all.put(i, view_steps.pixel(points[i]), view_steps.depth(points[i]));
  }
  std::array<std::uint32_t, kBlock> visible;
  const std::size_t n = front_.find_visible(all, points.size(), visible);
  ViewPlaces places;
  SeenColors seen;
  std::array<std::uint32_t, kBlock> index;
  std::array<FusedColor, kBlock> known;
  for (std::size_t j = 0; j < n; ++j) {
    const std::uint32_t i = visible[j];
    places.put(j, {all.u[i], all.v[i]}, all.depth[i]);
    index[j] = piece_begin + points[i].place;
    known[j] = colors[index[j]];
    if (known[j].views == 0) first_seen.push_back(index[j]);
  }
  weigh(places, n, seen.weight);
  for (std::size_t word = 0; word < noise.size(); ++word) {
    for (std::size_t j = 0; j < n; ++j) seen.noise[word][j] = quick_bits(index[j], noise[word]);
  }
  patches.at(places, n, seen.color);
  FusedColors fused;
  fused.take(std::span(known).first(n));
  fuse(fused, seen, n);
  fused.give(std::span(known).first(n));
  for (std::size_t j = 0; j < n; ++j) colors[index[j]] = known[j];
  return n;
}

std::vector<std::span<FusedColor>> SeenMap::colors_of_pieces(TileMap& map) const {
  std::vector<std::span<FusedColor>> colors(pieces_.size());
  parallel_for(pieces_.size(), 1, [&](std::size_t first) {
    if (pieces_[first].begin != 0) return;
    // All of a tile in one thread, and only if there is something to change: the map may have to
    // copy it.
    const auto end =
        std::find_if(pieces_.begin() + static_cast<std::ptrdiff_t>(first), pieces_.end(),
                     [&](const Piece& piece) { return piece.tile != pieces_[first].tile; });
    const auto last = static_cast<std::size_t>(end - pieces_.begin());
    std::size_t seen = 0;
    for (std::size_t k = first; k < last; ++k) seen += pieces_[k].seen;
    if (seen == 0) return;
    const std::span<FusedColor> of_tile = map.colors(pieces_[first].tile);
    std::fill(colors.begin() + static_cast<std::ptrdiff_t>(first),
              colors.begin() + static_cast<std::ptrdiff_t>(last), of_tile);
  });
  return colors;
}

std::size_t SeenMap::recolour(TileMap& map, const ColorView& view) const {
  const auto camera = static_cast<std::uint64_t>(view.camera.index);
  Random random =
      Random::of_item(static_cast<std::uint64_t>(view.frame) << 8 | camera, kRounding, 0);
  const NoiseKinds noise{static_cast<std::uint32_t>(random.next()),
                         static_cast<std::uint32_t>(random.next())};
  const PatchColors patches(view);
  const std::vector<std::span<FusedColor>> colors = colors_of_pieces(map);
  std::vector<std::vector<std::uint32_t>> first_seen(pieces_.size());
  const auto count_seen = [&](std::size_t k, std::size_t) {
    const std::span<const PointInView> points = seen(pieces_[k]);
    std::size_t count = 0;
    for (std::size_t begin = 0; begin < points.size(); begin += kBlock) {
      count += recolour_block(points.subspan(begin, std::min(kBlock, points.size() - begin)),
                              pieces_[k].begin, colors[k], patches, noise, first_seen[k]);
    }
    return count;
  };
  const std::size_t seen_points = parallel_sum(pieces_.size(), 1, std::size_t{0}, count_seen);
  for (std::size_t k = 0; k < pieces_.size(); ++k) {
    if (first_seen[k].empty()) continue;
    map.put_camera(pieces_[k].tile, first_seen[k], static_cast<std::int8_t>(camera_.index));
  }
  return seen_points;
}

}  // namespace fovea
