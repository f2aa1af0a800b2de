// Over 300 lines: the report in two forms, figure by figure.
#include "fovea/evaluation/report.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "fovea/evaluation/evaluate_uncolored.h"

namespace fovea {
namespace {

using Json = nlohmann::ordered_json;

/// The figures of docs/method.md 7 that come from point errors, under the contract's names.
void put_figures(Json& json, const ErrorFigures& figures) {
  json["points"] = figures.points;
  json["me_mean"] = figures.me_mean;
  json["me_std"] = figures.me_std;
  json["te_mean"] = figures.te_mean;
  json["te_std"] = figures.te_std;
  json["te_median"] = figures.te_median;
  json["te_within_20"] = figures.te_within_20;
  json["te_gain_mean"] = figures.te_gain_mean;
  json["te_gain_within_20"] = figures.te_gain_within_20;
  json["te_predicted_mean"] = figures.te_predicted_mean;
  json["te_predicted_within_20"] = figures.te_predicted_within_20;
  json["te_cross_mean"] = figures.te_cross_mean;
  json["te_cross_within_20"] = figures.te_cross_within_20;
  json["log_cross_mean"] = figures.log_cross_mean;
  json["psnr_cross"] = figures.psnr_cross;
  json["mtme"] = figures.mtme;
  json["coverage_5cm"] = figures.coverage_5cm;
  json["coverage_20cm"] = figures.coverage_20cm;
  json["te_percent"] = figures.te_percent;
  json["te_ciede2000_mean"] = figures.te_ciede2000_mean;
  json["te_ciede2000_median"] = figures.te_ciede2000_median;
  json["share_interpolated"] = figures.share_interpolated;
}

void put_intervals(Json& json, const MeanIntervals& intervals) {
  Json& all = json["intervals_95"];
  const auto put = [&](const char* name, const Interval& interval) {
    all[name] = {interval.low, interval.high};
  };
  put("me_mean", intervals.me);
  put("te_mean", intervals.te);
  put("mtme", intervals.mtme);
  put("te_cross_mean", intervals.te_cross);
}

void put_set(Json& json, const SetFigures& set) {
  json["left_out"] = set.left_out;
  put_figures(json, set.figures);
  put_intervals(json, set.intervals);
}

void put_moving(Json& json, const std::optional<MovingReport>& moving) {
  if (!moving) return;  // null: the drive has no labels
  json["boxes"] = moving->labelled;
  json["boxes_moved"] = moving->moved;
  json["map_points_left_out"] = moving->map_points_left_out;
  put_set(json, moving->set);
}

void put_blocks(Json& json, const EvaluationReport& report) {
  json["explanation"] =
      "contiguous held-out frames, scored where a training frame's white zone reached";
  json["left_out"] = report.unreached;
  json["list"] = Json::array();
  for (const BlockReport& block : report.blocks) {
    Json one{{"first_frame", block.first}, {"last_frame", block.last}};
    put_figures(one, block.figures);
    json["list"].push_back(one);
  }
}

void put_structure(Json& json, const EvaluationReport& report) {
  const BleedingFigures& bleeding = report.bleeding;
  json["bleeding"] = {{"points_edges", bleeding.points_edges},
                      {"te_edges", bleeding.te_edges},
                      {"te_elsewhere", bleeding.te_elsewhere},
                      {"te_excess", bleeding.excess()},
                      {"coverage_5cm_edges", bleeding.coverage_5cm_edges},
                      {"coverage_5cm_elsewhere", bleeding.coverage_5cm_elsewhere}};
  const ErrorSplit& split = report.split;
  json["split"] = {{"points", split.points},
                   {"te_mean", split.mean(split.total)},
                   {"te_sampling", split.mean(split.sampling)},
                   {"te_same_place", split.mean(split.same_place)}};
  json["consistency"] = {{"roughness", report.roughness.roughness()},
                         {"roughness_patches", report.roughness.patches},
                         {"cross_view_log_rms", report.cross_view.map},
                         {"cross_view_log_floor", report.cross_view.floor},
                         {"cross_view_points", report.cross_view.points}};
  Json& geometry = json["geometry"];
  geometry["plane_thickness"] = report.thickness.thickness;
  geometry["planar_patches"] = report.thickness.patches;
  for (std::size_t k = 0; k < ScanScores::kCentimetres.size(); ++k) {
    const std::string at = fmt::format("_{}cm", ScanScores::kCentimetres[k]);
    geometry["precision" + at] = report.scan_scores.precision[k];
    geometry["recall" + at] = report.scan_scores.recall[k];
    geometry["f_score" + at] = report.scan_scores.f_score[k];
  }
  const Eigen::Vector2i shift = report.shift.best();
  json["pictures"] = {{"psnr_covered", report.pictures.psnr_covered()},
                      {"psnr_all", report.pictures.psnr_all()},
                      {"ssim_covered", report.pictures.mean_ssim_covered()},
                      {"ssim_all", report.pictures.mean_ssim_all()},
                      {"covered", report.pictures.share_covered()},
                      {"shift", {shift.x(), shift.y()}}};
  json["share_within_2mm"] = report.share_within_2mm;
  json["pose_stray"] = {{"scored", report.stray.scored}, {"mapped", report.stray.mapped}};
  json["warnings"] = report.warnings;
}

Json far_json(const FarSums& sums) {
  const auto share = [](double part, std::size_t whole) {
    return whole == 0 ? ErrorFigures::kNone : part / double(whole);
  };
  return {{"points", sums.points},
          {"coverage_5cm", share(double(sums.covered_5cm), sums.points)},
          {"coverage_10cm", share(double(sums.covered_10cm), sums.points)},
          {"te_cross_mean", share(sums.color, sums.points)},
          {"double_layers", share(double(sums.double_layer), sums.flat)}};
}

void put_far_field(Json& json, const FarField& field) {
  json["explanation"] =
      "visible returns from 15 to 60 m; coverage within 5 or 10 cm, or the footprint of a pixel";
  json["all"] = far_json(field.all());
  for (std::size_t band = 0; band < kFarBands.size(); ++band) {
    const auto& [near, far] = kFarBands[band];
    json[fmt::format("{}_to_{}_m", near, far)] = {{"ground", far_json(field.bands[band].ground)},
                                                  {"upright", far_json(field.bands[band].upright)}};
  }
  json["holes"] = field.share_of_holes();
  json["psnr_measured"] = field.psnr();
  json["measured_pixels"] = field.measured;
}

void put_rules(Json& json, const ErrorsByRule& by_rule) {
  json = Json::object();
  for (std::size_t rule = 0; rule < kPointRules; ++rule) {
    const RuleErrors& errors = by_rule[rule];
    if (errors.points == 0) continue;
    json[std::string(kPointRuleNames[rule])] = {{"points", errors.points},
                                                {"me_mean", errors.mean(errors.position)},
                                                {"te_mean", errors.mean(errors.color)}};
  }
}

Json view_json(const ViewReport& view) {
  Json json;
  json["frame"] = view.frame;
  json["camera"] = view.camera;
  put_figures(json, view.figures);
  json["gain"] = {view.gains.x(), view.gains.y(), view.gains.z()};
  json["sharpness"] = view.gradients.sharpness();
  json["psnr_covered"] = view.pictures.psnr_covered();
  json["ssim_covered"] = view.pictures.mean_ssim_covered();
  json["covered"] = view.pictures.share_covered();
  return json;
}

}  // namespace

const ViewReport* worst_view(const EvaluationReport& report) {
  const ViewReport* worst = nullptr;
  for (const ViewReport& view : report.views) {
    if (view.figures.points == 0) continue;
    if (worst == nullptr || view.figures.te_mean > worst->figures.te_mean) worst = &view;
  }
  return worst;
}

std::string to_json(const EvaluationReport& report) {
  Json json;
  json["protocol"] = to_string(report.protocol);
  json["explanation"] = explanation(report.protocol);
  json["cameras"] = report.cameras;
  json["colored"] = report.colored;
  json["calibration"] = report.calibration;
  put_figures(json, report.figures);
  put_intervals(json, report.intervals);
  json["free_space_violations"] = report.free_space.share();
  json["sharpness"] = report.gradients.sharpness();
  json["detail"] = report.gradients.detail();
  json["density_per_m2"] = report.density_per_m2;
  put_set(json["visible"], report.visible);
  put_structure(json, report);
  put_far_field(json["far_field"], report.far_field);
  put_rules(json["by_rule"], report.by_rule);
  put_moving(json["without_moving"], report.without_moving);
  if (!report.blocks.empty()) put_blocks(json["blocks"], report);
  json["free_space_violations_enclosed"] = report.free_space.enclosed_share();
  json["free_space_points"] = report.free_space.tested;
  json["sharpness_pixels"] = report.gradients.pixels;
  json["map_points"] = report.map_points;
  json["map_points_coloured"] = report.map_points_coloured;
  json["map_share_interpolated"] = report.map_share_interpolated;
  json["paper_like"]["explanation"] =
      "nearest neighbours among all map points, uncoloured ones counting as black";
  put_figures(json["paper_like"], report.paper_like);
  if (!report.color_rules.empty()) json["color_rules"] = to_json(report.color_rules);
  json["frames_scored"] = report.frames;
  json["skipped"] = Json::array();
  for (const UnscoredFrame& frame : report.skipped) {
    json["skipped"].push_back({{"frame", frame.index}, {"reason", frame.reason}});
  }
  json["images_missing"] = Json::array();
  for (const UnscoredView& view : report.images_missing) {
    json["images_missing"].push_back({{"frame", view.frame}, {"camera", view.camera}});
  }
  if (const ViewReport* worst = worst_view(report)) {
    json["worst_frame"] = {{"frame", worst->frame},
                           {"camera", worst->camera},
                           {"me_mean", worst->figures.me_mean},
                           {"te_mean", worst->figures.te_mean}};
  }
  json["frames"] = Json::array();
  for (const ViewReport& view : report.views) json["frames"].push_back(view_json(view));
  // A reason may quote a file name in any encoding.
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string to_text(const EvaluationReport& report) {
  if (!report.colored) return uncolored_text(report);
  const ErrorFigures& f = report.figures;
  const ErrorFigures& p = report.paper_like;
  std::string text = fmt::format("{}, camera {}: {} points of {} frames ({} skipped)\n",
                                 to_string(report.protocol), fmt::join(report.cameras, ", "),
                                 f.points, report.frames, report.skipped.size());
  if (!report.images_missing.empty()) {
    text += fmt::format("{} images of these frames are missing or damaged and score nothing\n",
                        report.images_missing.size());
  }
  if (report.calibration != "drive") {
    text += fmt::format("under the calibration of {}\n", report.calibration);
  }
  const auto row = [&](std::string_view name, std::string_view value, std::string_view more = "") {
    text += fmt::format("  {:<22}{:>10}  {}\n", name, value, more);
  };
  const auto number = [](double value, int digits) {
    return fmt::format("{:.{}f}", value, digits);
  };
  const auto interval = [](const Interval& i, int digits) {
    return fmt::format("95%: {:.{}f} to {:.{}f}", i.low, digits, i.high, digits);
  };
  row("ME mean", number(f.me_mean, 4),
      "m, std " + number(f.me_std, 4) + ", " + interval(report.intervals.me, 4));
  row("TE, cross-fitted", number(f.te_cross_mean, 2),
      fmt::format("within 20: {:.3f}, log error {:.3f}, PSNR {:.2f} dB, {}", f.te_cross_within_20,
                  f.log_cross_mean, f.psnr_cross, interval(report.intervals.te_cross, 2)));
  row("TE, predicted exposure", number(f.te_predicted_mean, 2),
      "within 20: " + number(f.te_predicted_within_20, 3));
  row("TE mean", number(f.te_mean, 2),
      fmt::format("std {:.2f}, {:.2f}% of 255, {}", f.te_std, f.te_percent,
                  interval(report.intervals.te, 2)));
  row("TE, CIEDE2000", number(f.te_ciede2000_mean, 2),
      "median " + number(f.te_ciede2000_median, 2));
  row("TE median", number(f.te_median, 2));
  row("TE within 20", number(f.te_within_20, 3));
  row("TE, fitted gains", number(f.te_gain_mean, 2),
      "within 20: " + number(f.te_gain_within_20, 3));
  row("MTME", number(f.mtme, 3), interval(report.intervals.mtme, 3));
  row("coverage 5 cm", number(f.coverage_5cm, 3));
  row("coverage 20 cm", number(f.coverage_20cm, 3));
  row("free-space violations", number(report.free_space.share(), 4),
      fmt::format("of {} map points; among returns all round {:.4f}", report.free_space.tested,
                  report.free_space.enclosed_share()));
  row("sharpness", number(report.gradients.sharpness(), 3),
      fmt::format("over {} pixels; detail {:.3f}", report.gradients.pixels,
                  report.gradients.detail()));
  const BleedingFigures& b = report.bleeding;
  row("TE at depth edges", number(b.te_edges, 2),
      fmt::format("elsewhere {:.2f}, {:+.0f}%; coverage 5 cm {:.3f}, elsewhere {:.3f}; {} points",
                  b.te_elsewhere, 100 * b.excess(), b.coverage_5cm_edges, b.coverage_5cm_elsewhere,
                  b.points_edges));
  const ErrorSplit& s = report.split;
  row("TE of sampling", number(s.mean(s.sampling), 2),
      fmt::format("by the nearest point's distance; {:.2f} by its colour", s.mean(s.same_place)));
  for (std::size_t rule = 0; rule < kPointRules; ++rule) {
    const RuleErrors& errors = report.by_rule[rule];
    if (errors.points == 0) continue;
    row(fmt::format("nearest is {}", kPointRuleNames[rule]),
        number(errors.mean(errors.position), 4),
        fmt::format("m ME, TE {:.2f}; {} points", errors.mean(errors.color), errors.points));
  }
  row("roughness", number(report.roughness.roughness(), 2),
      fmt::format("on {} smooth patches", report.roughness.patches));
  row("cross-view log RMS", number(report.cross_view.map, 3),
      fmt::format("no less than {:.3f}; {} points", report.cross_view.floor,
                  report.cross_view.points));
  row("plane thickness", number(report.thickness.thickness, 4),
      fmt::format("m, median of {} patches", report.thickness.patches));
  row("F-score 5 / 10 / 20 cm", number(report.scan_scores.f_score[0], 3),
      fmt::format("{:.3f}, {:.3f}", report.scan_scores.f_score[1], report.scan_scores.f_score[2]));
  row("PSNR", number(report.pictures.psnr_covered(), 2),
      fmt::format("dB, SSIM {:.3f} on the {:.1f}% covered; all {:.2f} dB, {:.3f}",
                  report.pictures.mean_ssim_covered(), 100 * report.pictures.share_covered(),
                  report.pictures.psnr_all(), report.pictures.mean_ssim_all()));
  const auto far_row = [&](std::string_view name, const FarSums& sums) {
    if (sums.points == 0) return;
    const Json far = far_json(sums);
    const auto figure = [&](const char* key, int digits) {
      return number(far[key].get<double>(), digits);
    };
    row(name, figure("coverage_10cm", 3),
        fmt::format("within 10 cm or a pixel; 5 cm {}, TE {}, double layers {}; {} points",
                    figure("coverage_5cm", 3), figure("te_cross_mean", 1),
                    figure("double_layers", 3), sums.points));
  };
  far_row("coverage 15 to 60 m", report.far_field.all());
  for (std::size_t band = 0; band < kFarBands.size(); ++band) {
    const auto name = [&](const char* kind) {
      return fmt::format("  {} to {} m, {}", kFarBands[band].near, kFarBands[band].far, kind);
    };
    far_row(name("ground"), report.far_field.bands[band].ground);
    far_row(name("upright"), report.far_field.bands[band].upright);
  }
  row("PSNR of all measured", number(report.far_field.psnr(), 2),
      fmt::format("dB, holes {:.3f} of {} pixels up to {} m", report.far_field.share_of_holes(),
                  report.far_field.measured, kFarBands.back().far));
  row("points per m^2", number(report.density_per_m2, 0),
      fmt::format("{} coloured of {}", report.map_points_coloured, report.map_points));
  row("interpolated", number(f.share_interpolated, 3),
      "of the nearest points, " + number(report.map_share_interpolated, 3) + " of the map's");
  if (const ViewReport* worst = worst_view(report)) {
    row("worst frame", fmt::format("{}", worst->frame),
        fmt::format("camera {}: ME {:.4f}, TE {:.2f}", worst->camera, worst->figures.me_mean,
                    worst->figures.te_mean));
  }
  const auto set_row = [&](std::string_view name, const SetFigures& set) {
    row(name, number(set.figures.me_mean, 4),
        fmt::format("TE {:.2f} ({}), within 20: {:.3f}, coverage {:.3f}; {} points left out",
                    set.figures.te_mean, interval(set.intervals.te, 2), set.figures.te_within_20,
                    set.figures.coverage_5cm, set.left_out));
  };
  set_row("visible ME / TE", report.visible);
  if (report.without_moving) {
    const MovingReport& moving = *report.without_moving;
    set_row("without moving ME / TE", moving.set);
    row("  boxes that moved", fmt::format("{}", moving.moved),
        fmt::format("of {}; {} map points left out", moving.labelled, moving.map_points_left_out));
  }
  for (const BlockReport& block : report.blocks) {
    row(fmt::format("block {}-{} ME / TE", block.first, block.last),
        number(block.figures.me_mean, 4),
        fmt::format("TE {:.2f}, within 20: {:.3f}, coverage {:.3f}", block.figures.te_mean,
                    block.figures.te_within_20, block.figures.coverage_5cm));
  }
  if (!report.blocks.empty()) {
    row("  beyond training", fmt::format("{}", report.unreached), "points left out");
  }
  row("paper-like ME / TE", number(p.me_mean, 4),
      fmt::format("TE {:.2f} ({:.2f}%), MTME {:.3f}; uncoloured points count as black", p.te_mean,
                  p.te_percent, p.mtme));
  return text + explanation(report.protocol) + "\n" + to_text(report.color_rules);
}

}  // namespace fovea
