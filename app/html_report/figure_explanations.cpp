#include "app/html_report/figure_explanations.h"

#include <map>
#include <utility>

namespace fovea::app {
namespace {

/// By the name of a figure, or its whole place where a name means something else there.
const std::map<std::string, const char*>& explanations() {
  static const std::map<std::string, const char*> all{
      {"points", "evaluated LiDAR points: a fixed set that no map has a say in"},
      {"me_mean", "distance to the nearest coloured map point (m), mean"},
      {"me_std", "its standard deviation (m)"},
      {"te_mean",
       "difference to that point's colour, Euclidean in RGB (0-441; intensity 0-255 for "
       "grey cameras), mean"},
      {"te_std", "its standard deviation"},
      {"te_median", "its median"},
      {"te_within_20", "share of points whose colour is right within 20"},
      {"te_gain_mean",
       "TE after one gain a channel and view, fitted by least squares: without "
       "differences of exposure"},
      {"te_gain_within_20", "share within 20 after these gains"},
      {"te_predicted_mean",
       "TE in the exposure that the map predicts for the view from its neighbors"},
      {"te_predicted_within_20", "share within 20 in this exposure"},
      {"te_cross_mean",
       "TE after one gain per channel, fitted to half of the view's blocks of 64 pixels and "
       "applied to the other half: the headline figure"},
      {"te_cross_within_20", "share within 20 after these gains"},
      {"log_cross_mean",
       "RMS over channels of the difference of natural logarithms after these gains, mean: does "
       "not grow with brightness"},
      {"psnr_cross", "of the scored points after these gains (dB)"},
      {"mtme", "mean of ME x TE of each point"},
      {"coverage_5cm", "share of points with a coloured map point within 5 cm"},
      {"coverage_20cm", "the same within 20 cm"},
      {"te_percent", "mean TE in % of 255, as the paper quotes it"},
      {"te_ciede2000_mean",
       "colour difference as the eye sees it (CIEDE2000; 1 is just "
       "noticeable), mean"},
      {"te_ciede2000_median", "its median"},
      {"share_interpolated", "share of the nearest map points that upsampling made"},
      {"intervals_95.me_mean",
       "95% interval of the mean ME (whole frames drawn again, 2000 times)"},
      {"intervals_95.te_mean", "95% interval of the mean TE"},
      {"intervals_95.mtme", "95% interval of MTME"},
      {"intervals_95.te_cross_mean", "95% interval of the mean cross-fitted TE"},
      {"free_space_violations",
       "share of map points that stand over 20 cm in front of every return "
       "around their ray"},
      {"free_space_violations_enclosed",
       "those with returns above and below them, too, within a cone wider than the gaps between "
       "rings"},
      {"free_space_points", "map points that a scored scan could test for that"},
      {"sharpness",
       "image gradient of the drawn map over the photograph's: 1 is as sharp, noise "
       "adds to it"},
      {"detail",
       "how much of the photograph's gradients the drawn map repeats: noise adds nothing"},
      {"sharpness_pixels", "pixels where both are taken"},
      {"density_per_m2", "map points a square metre of surface"},
      {"map_points", "points of the map"},
      {"colored", "whether the map has colors; if not, positions alone are scored"},
      {"map_points_coloured", "those that a camera coloured"},
      {"map_share_interpolated", "share of them that upsampling made"},
      {"left_out", "evaluated points that are not in this set"},
      {"bleeding.points_edges", "visible points at edges of depth"},
      {"bleeding.te_edges",
       "mean TE there after the view's gain: colors of a foreground that bleed show here"},
      {"bleeding.te_elsewhere", "mean TE of the other visible points"},
      {"bleeding.te_excess", "how much larger it is at edges, as a share"},
      {"far_field.coverage_5cm", "share with a map point within 5 cm or the footprint of a pixel"},
      {"coverage_10cm", "share with a map point within 10 cm or the footprint of a pixel"},
      {"double_layers", "share of flat, covered places where the map has two layers within 50 cm"},
      {"holes", "share of the pixels between returns of a surface where the map shows nothing"},
      {"psnr_measured", "PSNR over these pixels, a hole being black (dB)"},
      {"measured_pixels", "pixels between returns of a surface, up to 60 m"},
      {"bleeding.coverage_5cm_edges", "share at edges with a map point within 5 cm"},
      {"bleeding.coverage_5cm_elsewhere", "the same elsewhere"},
      {"split.points", "scored points whose nearest map point the view shows, too"},
      {"split.te_mean", "their mean TE"},
      {"split.te_sampling",
       "of it, what a perfect colour of the nearest map point would leave: it lies elsewhere"},
      {"split.te_same_place",
       "the colour of the nearest map point against the photograph at that very place"},
      {"consistency.roughness", "luma noise of the map where the photograph is smooth"},
      {"consistency.roughness_patches", "smooth patches of 8 x 8 pixels"},
      {"consistency.cross_view_log_rms",
       "distance of a map point's colour to the held-out views' that "
       "show it, RMS"},
      {"consistency.cross_view_log_floor", "what no map with one colour a point undercuts"},
      {"consistency.cross_view_points", "map points that several views show"},
      {"geometry.plane_thickness",
       "RMS distance of points to the plane on flat surfaces (m), "
       "median"},
      {"geometry.planar_patches", "flat cubes of 20 cm"},
      {"pictures.psnr_covered",
       "drawn map against photograph where something is drawn, to 15 m "
       "(dB)"},
      {"pictures.psnr_all", "the same on all pixels, nothing drawn being black (dB)"},
      {"pictures.ssim_covered", "structural similarity where something is drawn"},
      {"pictures.ssim_all", "the same on all pixels"},
      {"pictures.covered", "share of pixels where something is drawn"},
      {"pictures.shift",
       "whole shift (x, y pixels) under which drawing and photograph differ "
       "least"},
      {"share_within_2mm",
       "share of points with a map point within 2 mm: many mean that the map "
       "holds the scored scans"},
      {"pose_stray.scored",
       "how far corrections of navigation at scored frames stray from their "
       "neighbours' (m)"},
      {"pose_stray.mapped", "the same at mapped frames (m)"},
      {"without_moving.boxes", "labelled objects"},
      {"without_moving.boxes_moved", "those that moved"},
      {"without_moving.map_points_left_out", "map points in them"},
      {"blocks.left_out", "points beyond what any training frame could see"},
      {"frames_scored", "frames that were scored"},
      {"worst_frame.frame", "frame of the highest mean TE"},
      {"worst_frame.camera", "camera of it"},
      {"first_frame", "first frame of a block"},
      {"last_frame", "last frame of it"},
      {"points_coloured", "points that the rule gave a colour"},
      {"rule", "colour rule, on identical points (docs/method.md)"},
      {"oracle", "whether it knows the held-out colours: a floor, no rule"},
  };
  return all;
}

}  // namespace

std::string explain_figure(const std::string& key) {
  const auto& all = explanations();
  // The whole place, then without its first parts: "visible.te_mean", then "te_mean".
  for (std::string rest = key;;) {
    const auto found = all.find(rest);
    if (found != all.end()) return found->second;
    const std::size_t dot = rest.find('.');
    if (dot == std::string::npos) break;
    rest.erase(0, dot + 1);
  }
  const std::string name = key.substr(key.rfind('.') + 1);
  for (const auto& [start, text] :
       {std::pair{"precision_", "share of the map's points near an evaluated point"},
        std::pair{"recall_", "share of the evaluated points near a map point"},
        std::pair{"f_score_", "harmonic mean of the two"}}) {
    if (name.starts_with(start)) return text;
  }
  return "";
}

}  // namespace fovea::app
