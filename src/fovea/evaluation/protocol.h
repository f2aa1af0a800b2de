// Evaluation protocols (docs/method.md 7): which scans score a map, and where they are placed.
#pragma once

#include <string_view>
#include <vector>

#include "fovea/drive/frame_source.h"
#include "fovea/drive/hold_out.h"
#include "fovea/evaluation/evaluated_set.h"
#include "fovea/evaluation/scored_map.h"

namespace fovea {

enum class Protocol {
  kInSample,            ///< the scans that built the map, placed by its refined poses
  kInSampleNavigation,  ///< the same, placed by the navigation's poses
  kHeldOut,             ///< scans that added nothing to the map, placed by its refined poses
  kCrossCamera,         ///< the same, scored in cameras that coloured nothing of the map
};

/// Whether the scored scans must have added nothing to the map.
bool scores_held_out(Protocol protocol);

/// "in-sample", "in-sample-nav", "held-out", "cross-camera".
const char* to_string(Protocol protocol);
/// ConfigError for any other name.
Protocol parse_protocol(std::string_view name);
/// What figures of this protocol mean and what not, in a sentence or two.
const char* explanation(Protocol protocol);

struct ProtocolOptions {
  Protocol protocol = Protocol::kHeldOut;
  /// Scored cameras; empty: the map's, or where it does not know them all that the drive is opened
  /// with.
  std::vector<int> cameras;
  /// held-out and cross-camera: the frames to score, instead of all that the map says it held out.
  /// In-sample: frames that are not scored.
  HoldOut hold_out;
};

/// The frames to score, by increasing index.
///
/// Poses are the map's T_local_lidar or, in-sample-nav, its T_local_lidar_navigation; frames that
/// the map skipped are left out, and so are frames without a navigation pose where one is asked
/// for. The motion is the map's and, where it has none, that of its refined poses over the sweep.
/// InputError if no frame is left, if a frame asked for as held-out was mapped or has coloured
/// points in the map, if a cloud does not say what was held out, or if a map has no navigation
/// poses.
std::vector<PlacedFrame> select_frames(const ScoredMap& map, const FrameSource& drive,
                                       const ProtocolOptions& options);

/// The scored cameras' places in the drive's calibration. ConfigError for one that the drive was
/// not opened with and, cross-camera, for one that coloured the map.
std::vector<std::size_t> select_cameras(const ScoredMap& map, const DriveInfo& drive,
                                        const ProtocolOptions& options);

}  // namespace fovea
