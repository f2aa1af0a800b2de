// Scores one frame after the other: everything that needs the map and one frame only.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "fovea/evaluation/free_space.h"
#include "fovea/evaluation/moving_boxes.h"
#include "fovea/evaluation/report.h"
#include "fovea/evaluation/training_reach.h"

namespace fovea {

/// What one frame adds to the report; marks are one a point of `errors`.
struct FrameScore {
  PointErrors errors, paper_like_errors;
  std::vector<std::uint8_t> hidden;        ///< 1: the camera cannot see the point
  std::vector<std::uint8_t> near_edge;     ///< 1: at an edge of depth
  PointErrors errors_without_moving;       ///< of the points outside moved boxes
  std::vector<Eigen::Vector3f> positions;  ///< of the points, in the map's float frame
  std::size_t unreached = 0;               ///< points that no training frame could see
  ErrorSplit split;
  ErrorsByRule by_rule{};
  std::vector<ViewReport> views;
  std::vector<UnscoredView> unscored_views;
  std::optional<UnscoredFrame> unscored;
};

/// One scored camera at one frame, to be looked at.
struct ViewPicture {
  int frame = 0, camera = 0;
  Image photograph;
  SplatView drawn;       ///< the coloured points of the map, at all depths
  EvaluatedView points;  ///< what was scored
  PointErrors errors;    ///< one a point
};

struct ScorerOptions {
  std::vector<std::size_t> cameras;    ///< scored: places in the drive's calibration
  std::optional<MovingBoxes> moving;   ///< labelled boxes, where the drive has them
  std::optional<TrainingReach> reach;  ///< points beyond it are not scored
};

/// The map made ready for questions; one for all frames.
class Scorer {
 public:
  /// @param map    move it here if it is not used again
  /// @param drive  must outlive the scorer
  Scorer(ScoredMap map, const FrameSource& drive, ScorerOptions options);

  /// Thread-safe.
  FrameScore score(const PlacedFrame& placed);

  /// The scored cameras' pictures of a frame, with the errors that score() counts; empty if the
  /// drive cannot load it. Thread-safe.
  std::vector<ViewPicture> pictures(const PlacedFrame& placed) const;

  /// Frees the memory that only score() and pictures() need: neither may follow.
  void free_indexes();

  const ColoredPoints& coloured() const { return coloured_; }
  const std::vector<float>& spacing() const { return spacing_; }  ///< see sample_spacing
  const std::vector<Camera>& cameras() const { return cameras_; }
  const std::vector<FrameRecord>& map_frames() const { return frames_; }
  FreeSpaceTest::Result free_space() const { return free_space_.result(); }
  CrossViewTest::Result cross_view() const { return cross_view_.result(); }
  /// Coloured map points that any scored scan could have seen.
  std::vector<Eigen::Vector3f> testable_points() const;
  /// Coloured map points that lie in a moved box of their own frame.
  std::size_t moving_points() const { return moving_points_; }

 private:
  struct ScoredPoints {
    EvaluatedView view;
    Eigen::Vector3f gains;
    PointErrors errors;
    std::size_t unreached = 0;
    NearestSamples nearest;
  };
  ScoredPoints score_points(const Frame& frame, const PointCloud& scan, const PlacedFrame& placed,
                            const Camera& camera, const Image& image) const;
  SplatView draw(const PlacedFrame& placed, const Camera& camera,
                 const SplatOptions& options) const;
  void score_view(const Frame& frame, const PointCloud& scan, const PlacedFrame& placed,
                  const Camera& camera, const Image& image, FrameScore& score);
  /// Draws the map in the exposure of the view (`report.gains`).
  void compare_with_photograph(const PlacedFrame& placed, const Camera& camera, const Image& image,
                               ViewReport& report);
  void compare_far(const PointCloud& measured, const PointCloud& scan, const PlacedFrame& placed,
                   const Camera& camera, const Image& image, ViewReport& report) const;
  /// Positions of the nearest map points in the camera's frame.
  std::vector<Eigen::Vector3d> nearest_in(const PlacedFrame& placed, const Camera& camera,
                                          const NearestSamples& nearest) const;
  void score_without_moving(const EvaluatedView& view, const PointCloud& scan,
                            FrameScore& score) const;
  void mark_moving();

  /// All points of a map of which some have no color: these are black.
  struct AllPoints {
    explicit AllPoints(const PointCloud& map_local);
    std::vector<Eigen::Vector3f> position;
    std::vector<LogColor> color;
    KdTree tree;
  };

  std::vector<FrameRecord> frames_;  // of the map
  const FrameSource& drive_;
  ScorerOptions options_;
  std::vector<Camera> cameras_;
  std::optional<AllPoints> all_;  // where there are uncoloured points
  ColoredPoints coloured_;
  std::vector<float> spacing_;
  KdTree coloured_tree_;
  FreeSpaceTest free_space_;
  CrossViewTest cross_view_;
  std::vector<std::uint8_t> is_moving_;  // of the coloured points; empty unless boxes are known
  std::size_t moving_points_ = 0;
};

}  // namespace fovea
