// The scored views as pictures: photograph and drawn map under a slider, errors over them.
#pragma once

#include <string>
#include <utility>
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

/// A photograph, the map drawn from the same place, and points in it with their errors.
struct ViewPanel {
  int frame = 0, camera = 0;
  Image photograph, drawn;
  std::string photograph_name;          ///< "photograph"
  std::string tag;                      ///< beside the heading; may be empty
  std::vector<Eigen::Vector2d> pixels;  ///< of the points
  std::vector<float> color, position;   ///< their errors, one a point
  ErrorScale color_scale, position_scale;
  std::string button;  ///< the figure on the view's button, with its name
  double bar = 0;      ///< length of the button's bar, 0-1
  std::vector<std::pair<std::string, std::string>> facts;
};

/// A button for each view and a panel for each, of which the page's script shows one.
std::string view_panels(const std::vector<ViewPanel>& views);
/// Those of scored views.
std::string view_section(const std::vector<ShownView>& views);

/// Places of `room` out of `count` things, evenly spread, the first and the last among them where
/// there is room for two; all where there is room for all.
std::vector<std::size_t> evenly_spread(std::size_t count, std::size_t room);

/// The scored points on the photograph as SVG paths, a class of the scale each: `values` one a
/// point.
std::string heat_paths(const std::vector<Eigen::Vector2d>& pixels, const std::vector<float>& values,
                       const ErrorScale& scale);

}  // namespace fovea::app
