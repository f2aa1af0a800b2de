#include "app/html_report/calibration_page.h"

#include <fmt/format.h>

#include <string_view>

#include "app/html_report/assets.h"
#include "app/html_report/calibration_overlay.h"
#include "app/html_report/calibration_values.h"
#include "app/html_report/markup.h"
#include "app/html_report/page_layout.h"
#include "fovea/core/angle.h"
#include "fovea/platform.h"

namespace fovea::app {
namespace {

/// Adds to page.css.
constexpr std::string_view kCss = R"css(
.calibration td { font-variant-numeric: tabular-nums; white-space: nowrap; }
.calibration td:nth-child(2) { font-weight: 600; }
.calibration td:last-child { min-width: 13rem; white-space: normal; }
.calibration .no td { color: var(--ink-2); font-weight: 400; }
.panel + .panel { margin-top: 1rem; }
.panel > :last-child { margin-bottom: 0; }
.scroll + p { margin-top: .9rem; }
.panel .warnings p { margin: 0; }
.copy { overflow-x: auto; padding: .7rem .9rem; border: 1px solid var(--line); border-radius: 8px;
  background: var(--page); }
.ranges { display: flex; align-items: center; gap: .6rem; font-size: .85rem; color: var(--ink-2); }
.ranges i { flex: 0 1 260px; height: .7rem; border-radius: 99px; }
.closer { margin-top: .9rem; }
@media (max-width: 640px) {
  .calibration thead { display: none; }
  .calibration tr { display: grid; grid-template-columns: 6.5rem 6.5rem 1fr; padding: .3rem 0;
    border-bottom: 1px solid var(--line); }
  .calibration th, .calibration td { border: 0; padding: .1rem .3rem; }
  .calibration th, .calibration .no td { grid-column: 1 / -1; }
  .calibration td:empty { display: none; }
  .calibration td:last-child { min-width: 0; }
}
)css";

std::string warnings_html(const std::vector<std::string>& warnings) {
  if (warnings.empty()) return "";
  std::string html = fmt::format("<div class=\"warnings\" role=\"alert\"><h2>{} warning{}</h2><ul>",
                                 warnings.size(), warnings.size() == 1 ? "" : "s");
  for (const std::string& warning : warnings) html += "<li>" + escaped(warning) + "</li>";
  return html + "</ul></div>\n";
}

std::string camera_card(const CameraCalibration& camera) {
  const CalibrationEstimate& e = camera.estimate;
  const std::string name = fmt::format("Camera {}", camera.camera);
  if (e.disagrees) return card(name, "as given", "camera and LiDAR do not agree");
  if (!e.is_any_observable()) return card(name, "as given", "no value is observable");
  return card(name, fmt::format("{:.1f} pixels", e.pixels),
              fmt::format("edges lay off, \xC2\xB1{:.1f}, before the correction", e.pixels_sigma));
}

std::string imu_card(const ImuHandEye& imu) {
  if (!imu.agrees) return card("IMU", "as given", "IMU and LiDAR do not agree");
  const std::string delay =
      imu.delay_observable ? fmt::format("delay {:+.1f} ms", 1e3 * imu.delay) : "delay as given";
  if (imu.observable_directions == 0) return card("IMU", "as given", delay);
  return card("IMU", fmt::format("{:.2f}\xC2\xB0", imu.rotation.norm() / kDegree),
              "rotation corrected, " + delay);
}

std::string cards_html(const DriveCalibration& found) {
  std::string html;
  for (const CameraCalibration& camera : found.cameras) html += camera_card(camera);
  if (found.imu) html += imu_card(*found.imu);
  return html;
}

std::string cameras_html(const CalibrationPage& page, const DriveCorrection& correction) {
  std::string html;
  for (std::size_t k = 0; k < page.found.cameras.size(); ++k) {
    html += camera_values(page.found.cameras[k], page.drive.calibration.cameras.at(k),
                          {{correction.cameras.at(k)}, {}});
  }
  return html.empty() ? "<p>No camera was calibrated.</p>\n" : html;
}

std::string meaning_html() {
  return "<p>The right calibration of a camera is <code>exp(rotation) * translation * "
         "T_cam_lidar</code>. Rotation and translation are in the axes of the camera: x right, y "
         "down, z forward. The rotation leaves the center of the camera where it is. A positive "
         "delay means that the images are later than stated.</p>\n"
         "<p>The right mount of an IMU is <code>exp(rotation) * R_lidar_imu</code>, in the axes of "
         "the LiDAR. A positive delay is added to the stamps of its records.</p>\n"
         "<p>A standard deviation comes from the scatter over frames and over objects. A value is "
         "observable if its standard deviation is small enough. Every other value stays as "
         "given.</p>\n";
}

std::string head_html(const CalibrationPage& page) {
  const std::string drive = escaped(page.drive_name);
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\"/>\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n"
      "<meta name=\"color-scheme\" content=\"light dark\"/>\n"
      "<meta name=\"generator\" content=\"fovea {}\"/>\n<title>Calibration of {}</title>\n"
      "<style>/*<![CDATA[*/\n{}{}/*]]>*/</style>\n</head>\n<body>\n"
      "<header class=\"hero\"><div class=\"names\"><p class=\"kicker\">fovea calibrate</p>\n"
      "<h1>{}</h1>\n<p>{} frames tracked</p>\n</div></header>\n<main>\n",
      escaped(version()), drive, kPageCss, kCss, drive, count(page.found.frames));
}

std::string foot_html() {
  return fmt::format(
      "</main>\n<footer><p>Written by fovea {}. The method is defined in docs/calibration.md.</p>"
      "</footer>\n<script>/*<![CDATA[*/\n{}/*]]>*/</script>\n</body>\n</html>\n",
      escaped(version()), kPageJs);
}

}  // namespace

std::string calibration_page(const CalibrationPage& page) {
  const DriveCorrection correction = correction_of(page.drive, page.found);
  std::vector<Part> parts{{"cameras", "Cameras", cameras_html(page, correction)},
                          {"pictures", "Before and after", overlay_section(page.found.cameras)}};
  if (page.found.imu) {
    parts.push_back({"imu", "IMU", imu_values(*page.found.imu, {{}, correction.imu})});
  }
  parts.push_back({"meaning", "What this is", meaning_html()});

  std::string links, sections;
  for (const Part& part : parts) {
    links += fmt::format("<a href=\"#{}\">{}</a>", part.id, escaped(part.title));
    sections += fmt::format("<section class=\"part\" id=\"{}\">\n<h2>{}</h2>\n{}</section>\n",
                            part.id, escaped(part.title), part.html);
  }
  return head_html(page) + warnings_html(page.warnings) +
         fmt::format(
             "<p class=\"lead\">The calibration of cameras and IMU against the LiDAR. The "
             "corrected "
             "calibration is in <code>{0}/drive.toml</code>: <code>fovea map {0}</code> uses "
             "it.</p>\n<section class=\"cards\" aria-label=\"Main figures\">\n{1}</section>\n"
             "<nav aria-label=\"Sections\">{2}</nav>\n{3}",
             escaped(page.output_name), cards_html(page.found), links, sections) +
         foot_html();
}

}  // namespace fovea::app
