// The paper's close-ups: a baseline's texture and the map's beside the photograph.
#pragma once

#include <string>
#include <vector>

#include "app/html_report/training_scans.h"
#include "app/html_report/view_section.h"

namespace fovea::app {

/// A part of a picture.
struct Patch {
  int x = 0, y = 0;  ///< of its top left pixel
  double sum = 0;    ///< of the values in it
};

/// Marks (1) the covered pixels within 8 of an edge of depth: another covered pixel there shows
/// what is nearer or farther by more than 0.5 m and 10% (as ScanProjection has it).
std::vector<std::uint8_t> near_depth_edges(const SplatView& drawn);

/// The patch of this size whose values add up to most, above or below zero; of equal ones the
/// first. Empty if all are zero. @param values  one a pixel
std::optional<Patch> most_extreme(const std::vector<float>& values, int image_width, int width,
                                  int height);

/// Close-ups in up to three of the views, beside edges of depth, where the map or a baseline made
/// from the same scans under the same poses (every point kept, coloured by projection without a
/// test of occlusion) is nearer to the photograph by most. A paragraph that says why, where there
/// is none.
std::string close_up_section(const Scorer& scorer, const FrameSource& drive,
                             const std::vector<PlacedFrame>& training,
                             const std::vector<PlacedFrame>& scored,
                             const std::vector<ShownView>& views);

}  // namespace fovea::app
