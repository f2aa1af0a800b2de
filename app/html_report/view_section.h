// The scored views as pictures: photograph and drawn map under a slider, errors over them.
#pragma once

#include <string>
#include <vector>

#include "app/html_report/color_classes.h"
#include "fovea/evaluation/scorer.h"

namespace fovea::app {

/// Views that a page shows at most.
inline constexpr std::size_t kMaxViews = 12;

/// The views to show: the one of the highest TE first, then by frame as many of the others, evenly
/// spread, as there is room for. Views without a scored point are not shown.
std::vector<const ViewReport*> choose_views(const EvaluationReport& report,
                                            std::size_t most = kMaxViews);

struct ShownView {
  ViewReport report;
  ViewPicture picture;
};

/// A button for each view and a panel for each, of which the page's script shows one.
std::string view_section(const std::vector<ShownView>& views);

/// The scored points on the photograph as SVG paths, a class of the scale each: `values` one a
/// point.
std::string heat_paths(const std::vector<Eigen::Vector2d>& pixels, const std::vector<float>& values,
                       const ErrorScale& scale);

}  // namespace fovea::app
