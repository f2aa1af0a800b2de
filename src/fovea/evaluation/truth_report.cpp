#include "fovea/evaluation/truth_report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>

namespace fovea {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kExplanation =
    "Truth: the map against the world that the drive was simulated in. Accuracy and colours are of "
    "static points; ghosts, points on things that moved, are counted beside them and spoil the "
    "precision.";

Json spread(const Distribution& d) { return {{"mean", d.mean}, {"rmse", d.rmse}, {"max", d.max}}; }

void put_poses(Json& json, const TruthReport& report) {
  const auto put = [&](const std::string& name, const PoseFigures& figures) {
    json[name + "_m"] = spread(figures.position_m);
    json[name + "_deg"] = spread(figures.rotation_deg);
  };
  put("pose_absolute", report.pose_absolute);
  put("pose_aligned", report.pose_aligned);
  put("pose_relative", report.pose_relative);
  json["pose_drift_10m_percent"] = spread(report.pose_drift_percent);
}

void put_distances(Json& json, const std::string& name, const Distribution& d) {
  json[name + "_mean"] = d.mean;
  json[name + "_median"] = d.median;
  json[name + "_p95"] = d.p95;
  json[name + "_max"] = d.max;
  json[name + "_points"] = d.count;
}

void put_shares(Json& json, const SurfaceShares& shares) {
  const auto put = [&](const char* name, const std::array<double, 4>& values) {
    for (std::size_t k = 0; k < values.size(); ++k) {
      json[fmt::format("{}_{}cm", name, SurfaceShares::kCentimetres[k])] = values[k];
    }
  };
  put("precision", shares.precision);
  put("completeness", shares.completeness);
  put("f_score", shares.f_score);
  json["seen_voxels"] = shares.seen;
}

Json color_json(const ColorFigures& figures) {
  return {{"points", figures.raw.count},
          {"mean", figures.raw.mean},
          {"median", figures.raw.median},
          {"within_20", figures.within_20},
          {"gain_mean", figures.gain.mean},
          {"gain_median", figures.gain.median},
          {"gain_within_20", figures.gain_within_20}};
}

Json or_null(const std::optional<std::size_t>& count) {
  return count ? Json(*count) : Json(nullptr);
}

Json frame_json(const TruthFrame& f) {
  return {{"frame", f.frame},
          {"pose_m", f.position_m},
          {"pose_deg", f.rotation_deg},
          {"points", or_null(f.points)},
          {"ghosts", or_null(f.ghosts)}};
}

}  // namespace

double ghost_share(const TruthReport& report) {
  if (!report.ghosts) return Distribution::kNone;
  const std::size_t scored = report.colored ? report.map_points_coloured : report.map_points;
  return static_cast<double>(*report.ghosts) / static_cast<double>(scored);
}

const TruthFrame* worst_frame(const TruthReport& report) {
  const auto worst = std::max_element(
      report.frames.begin(), report.frames.end(),
      [](const TruthFrame& a, const TruthFrame& b) { return a.position_m < b.position_m; });
  return worst == report.frames.end() ? nullptr : &*worst;
}

std::string to_json(const TruthReport& report) {
  Json json;
  json["protocol"] = "truth";
  json["explanation"] = kExplanation;
  json["scene"] = report.scene;
  json["cameras"] = report.cameras;
  json["colored"] = report.colored;
  json["aligned"] = report.aligned;
  json["georeferenced"] = report.georeferenced;
  json["map_points"] = report.map_points;
  json["map_points_coloured"] = report.map_points_coloured;
  put_poses(json, report);
  put_distances(json, "accuracy", report.accuracy);
  put_distances(json, "accuracy_measured", report.accuracy_measured);
  put_distances(json, "accuracy_interpolated", report.accuracy_interpolated);
  put_shares(json, report.shares);
  json["color_albedo"] = color_json(report.color_albedo);
  json["color_albedo_matte"] = color_json(report.color_albedo_matte);
  json["color_view"] = color_json(report.color_view);
  json["color_view_matte"] = color_json(report.color_view_matte);
  json["exposure"] = {{"one_gain_mean", report.exposure.one_gain.mean},
                      {"one_gain_median", report.exposure.one_gain.median},
                      {"trend_percent_per_km", report.exposure.trend_percent_per_km},
                      {"deviation_percent", report.exposure.deviation_percent},
                      {"seam_p95_percent", report.exposure.seam_p95_percent}};
  json["ghosts"] = or_null(report.ghosts);
  json["ghost_share"] = ghost_share(report);
  put_distances(json, "upsampling", report.upsampling.error);
  json["upsampling_hidden"] = report.upsampling.hidden;
  json["upsampling_recovered_5cm"] = report.upsampling.recovered;
  json["upsampling_frames"] = report.upsampling.frames;
  json["frames_compared"] = report.frames.size();
  const TruthFrame* worst = worst_frame(report);
  json["worst_frame"] = worst != nullptr ? frame_json(*worst) : Json(nullptr);
  json["frames"] = Json::array();
  for (const TruthFrame& f : report.frames) json["frames"].push_back(frame_json(f));
  json["warnings"] = report.warnings;
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string to_text(const TruthReport& report) {
  const std::string points =
      report.colored
          ? fmt::format("camera {}: {} coloured points of {}", fmt::join(report.cameras, ", "),
                        report.map_points_coloured, report.map_points)
          : fmt::format("{} points (the map has no colors)", report.map_points);
  std::string text = fmt::format("truth, scene {}, {}, {} frames{}\n", report.scene, points,
                                 report.frames.size(), report.aligned ? "" : ", not aligned");
  const auto row = [&](std::string_view name, const std::string& value) {
    text += fmt::format("  {:<24}{}\n", name, value);
  };
  const auto poses = [&](std::string_view name, const PoseFigures& f) {
    row(name, fmt::format("mean {:.4f} m {:.4f} deg, max {:.4f} m {:.4f} deg", f.position_m.mean,
                          f.rotation_deg.mean, f.position_m.max, f.rotation_deg.max));
  };
  poses(report.georeferenced ? "pose, georeferenced" : "pose, as given", report.pose_absolute);
  poses("pose, aligned", report.pose_aligned);
  poses("pose, frame to frame", report.pose_relative);
  row("drift over 10 m", fmt::format("mean {:.3f}%, max {:.3f}%", report.pose_drift_percent.mean,
                                     report.pose_drift_percent.max));
  if (const TruthFrame* worst = worst_frame(report)) {
    row("worst frame", fmt::format("{}: {:.4f} m {:.4f} deg", worst->frame, worst->position_m,
                                   worst->rotation_deg));
  }
  const auto distances = [&](std::string_view name, const Distribution& d) {
    row(name, fmt::format("mean {:.4f} m, median {:.4f}, 95% {:.4f}, max {:.3f}, {} points", d.mean,
                          d.median, d.p95, d.max, d.count));
  };
  distances("accuracy", report.accuracy);
  distances("  measured", report.accuracy_measured);
  distances("  interpolated", report.accuracy_interpolated);
  const auto shares = [&](std::string_view name, const std::array<double, 4>& values) {
    row(name, fmt::format("{:.3f} / {:.3f} / {:.3f} / {:.3f}", values[0], values[1], values[2],
                          values[3]));
  };
  row("within", "2 / 5 / 10 / 20 cm");
  shares("  precision", report.shares.precision);
  shares("  completeness", report.shares.completeness);
  shares("  F-score", report.shares.f_score);
  const auto colors = [&](std::string_view name, const ColorFigures& f) {
    row(name,
        fmt::format("mean {:.2f}, median {:.2f}, within 20: {:.3f}; with gains {:.2f}, {:.2f}, "
                    "{:.3f}; {} points",
                    f.raw.mean, f.raw.median, f.within_20, f.gain.mean, f.gain.median,
                    f.gain_within_20, f.raw.count));
  };
  if (report.colored) {
    colors("colour, albedo", report.color_albedo);
    colors("  matte only", report.color_albedo_matte);
    colors("colour, perfect image", report.color_view);
    colors("  matte only", report.color_view_matte);
    const ExposureFigures& e = report.exposure;
    row("one exposure", fmt::format("one gain: mean {:.2f}, median {:.2f}; trend {:.2f} %/km, "
                                    "deviation {:.2f} %, seams {:.2f} % (95%)",
                                    e.one_gain.mean, e.one_gain.median, e.trend_percent_per_km,
                                    e.deviation_percent, e.seam_p95_percent));
  }
  row("ghosts", report.ghosts
                    ? fmt::format("{} ({:.3f}%)", *report.ghosts, 100 * ghost_share(report))
                    : "unknown: the points name no frame");
  if (report.cameras.empty()) return text + kExplanation + "\n";  // upsampling needs a camera
  distances("upsampling", report.upsampling.error);
  row("  hidden hits recovered",
      fmt::format("{:.3f} of {} within 5 cm", report.upsampling.recovered,
                  report.upsampling.hidden));
  return text + kExplanation + "\n";
}

}  // namespace fovea
