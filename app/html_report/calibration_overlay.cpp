#include "app/html_report/calibration_overlay.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "app/html_report/markup.h"

namespace fovea::app {
namespace {

constexpr int kQuality = 80;
constexpr float kNear = 3, kFar = 40;  // m: ends of the color scale
/// From near to far.
constexpr std::array<Rgb, 6> kRangeColors{Rgb{255, 45, 40},  Rgb{255, 140, 20}, Rgb{255, 225, 30},
                                          Rgb{70, 215, 100}, Rgb{40, 190, 235}, Rgb{60, 90, 255}};
constexpr Rgb kEdgeColor{255, 255, 255};
// The photograph below the points: share of color, and brightness.
constexpr float kSaturation = 0.35f, kBrightness = 0.72f;
// A close-up shows this share of the width and of the height, at this width.
constexpr int kCloseUpShare = 4;
constexpr double kCloseUpWidth = 960;
constexpr int kWindowSteps = 12;

Rgb color_of_range(float range) {
  const float share = std::log(range / kNear) / std::log(kFar / kNear);
  const float last = float(kRangeColors.size() - 1);
  const float place = std::isfinite(share) ? std::clamp(share, 0.0f, 1.0f) * last : last;
  const std::size_t k = std::min(std::size_t(place), kRangeColors.size() - 2);
  const float part = place - float(k);
  return to_rgb((1 - part) * to_float(kRangeColors[k]) + part * to_float(kRangeColors[k + 1]));
}

/// Whether the image has the bytes that its size states.
bool can_be_drawn(const Image& image) {
  const bool has_size = image.width > 0 && image.height > 0;
  if (!has_size || (image.channels != 1 && image.channels != 3)) return false;
  return image.data.size() ==
         std::size_t(image.width) * std::size_t(image.height) * std::size_t(image.channels);
}

bool is_inside(const OverlayPoint& point, const ImageWindow& window) {
  const float u = point.u + 0.5f - float(window.left), v = point.v + 0.5f - float(window.top);
  return u >= 0 && v >= 0 && u < float(window.width) && v < float(window.height);
}

void set_pixel(Image& picture, int x, int y, Rgb color) {
  std::uint8_t* pixel = picture.pixel(x, y);
  pixel[0] = color.r;
  pixel[1] = color.g;
  pixel[2] = color.b;
}

void draw_disc(Image& picture, double x, double y, double radius, Rgb color) {
  const int reach = int(std::ceil(radius)), x0 = int(std::lround(x)), y0 = int(std::lround(y));
  for (int dy = -reach; dy <= reach; ++dy) {
    for (int dx = -reach; dx <= reach; ++dx) {
      const int px = x0 + dx, py = y0 + dy;
      if (dx * dx + dy * dy > radius * radius) continue;
      if (px < 0 || py < 0 || px >= picture.width || py >= picture.height) continue;
      set_pixel(picture, px, py, color);
    }
  }
}

/// Edges last, near points over far ones; otherwise in their order.
std::vector<OverlayPoint> in_drawing_order(std::vector<OverlayPoint> points) {
  std::erase_if(points, [](const OverlayPoint& p) { return !std::isfinite(p.range); });
  std::ranges::stable_sort(points, [](const OverlayPoint& a, const OverlayPoint& b) {
    return a.is_edge != b.is_edge ? b.is_edge : a.range > b.range;
  });
  return points;
}

ImageWindow whole(const Image& image) { return {0, 0, image.width, image.height}; }

/// The pictures before and after, one over the other: a slider moves the border between them.
std::string slider(const CalibrationOverlay& overlay, const std::string& name) {
  const double scale = std::min(1.0, double(kMaxPictureWidth) / overlay.image.width);
  const auto uri = [&](const std::vector<OverlayPoint>& points) {
    return jpeg_uri(picture_with_points(overlay.image, points, whole(overlay.image), scale),
                    kQuality);
  };
  return fmt::format(
      "<div class=\"compare\" style=\"aspect-ratio:{0} / {1}\">\n"
      "<img class=\"photograph\" alt=\"The LiDAR's points before, {2}\" src=\"{3}\"/>\n"
      "<img class=\"drawn\" alt=\"The LiDAR's points after, {2}\" src=\"{4}\"/>\n"
      "<span class=\"side left\">before</span><span class=\"side right\">after</span>\n"
      "<div class=\"divider\"></div>\n"
      "<input type=\"range\" min=\"0\" max=\"100\" value=\"50\" step=\"1\" "
      "aria-label=\"Share of the picture before, {2}\"/>\n</div>\n",
      overlay.image.width, overlay.image.height, name, uri(overlay.before), uri(overlay.after));
}

/// The place with the most edges before and after. Empty without edges.
std::string close_ups(const CalibrationOverlay& overlay) {
  const Image& image = overlay.image;
  const ImageWindow size{0, 0, std::max(1, image.width / kCloseUpShare),
                         std::max(1, image.height / kCloseUpShare)};
  const ImageWindow window = window_with_most_edges(image, overlay.after, size);
  if (window.width == 0) return "";
  std::string html = "<div class=\"strip wide closer\">\n";
  const auto add = [&](const char* when, const std::vector<OverlayPoint>& points) {
    const double scale = kCloseUpWidth / window.width;
    html += fmt::format(
        "<figure><img alt=\"Close-up {0}\" src=\"{1}\"/><figcaption><b>Close-up {0}</b>"
        "</figcaption></figure>\n",
        when, jpeg_uri(picture_with_points(image, points, window, scale), kQuality));
  };
  add("before", overlay.before);
  add("after", overlay.after);
  return html + "</div>\n";
}

std::string range_legend() {
  std::string colors;
  for (const Rgb c : kRangeColors) colors += fmt::format(", rgb({} {} {})", c.r, c.g, c.b);
  return fmt::format(
      "<p>Each dot is a point of the LiDAR. Its color is its distance from the camera: red is "
      "near, "
      "blue is far. White dots are edges, where an object ends. Under the right calibration, white "
      "dots lie on the borders of the objects in the photograph. Drag the divider, or use the "
      "arrow "
      "keys.</p>\n<p class=\"ranges\"><span>{} m</span>"
      "<i style=\"background:linear-gradient(to right{})\"></i><span>{} m</span></p>\n",
      kNear, colors, kFar);
}

std::string button(std::size_t index, int frame, int camera) {
  return fmt::format(
      "<button type=\"button\" data-view=\"{}\" data-frame=\"{}\" aria-pressed=\"{}\"><b>{}</b>"
      "<span>camera {}</span></button>\n",
      index, frame, index == 0 ? "true" : "false", frame, camera);
}

}  // namespace

ImageWindow window_with_most_edges(const Image& image, const std::vector<OverlayPoint>& points,
                                   ImageWindow window) {
  ImageWindow best;
  std::ptrdiff_t most = 0;
  for (int i = 0; i <= kWindowSteps; ++i) {
    for (int j = 0; j <= kWindowSteps; ++j) {
      window.left = (image.width - window.width) * i / kWindowSteps;
      window.top = (image.height - window.height) * j / kWindowSteps;
      const auto edges = std::ranges::count_if(
          points, [&](const OverlayPoint& p) { return p.is_edge && is_inside(p, window); });
      if (edges <= most) continue;
      most = edges;
      best = window;
    }
  }
  return best;
}

Image picture_with_points(const Image& image, const std::vector<OverlayPoint>& points,
                          const ImageWindow& window, double scale) {
  Image picture(std::max(1, int(std::lround(window.width * scale))),
                std::max(1, int(std::lround(window.height * scale))), 3);
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) {
      const Eigen::Vector3f color = bilinear(image, (x + 0.5) / scale - 0.5 + window.left,
                                             (y + 0.5) / scale - 0.5 + window.top);
      const Eigen::Vector3f gray = Eigen::Vector3f::Constant(luma(color));
      set_pixel(picture, x, y, to_rgb(kBrightness * (gray + kSaturation * (color - gray))));
    }
  }
  // JPEG blurs the color of smaller dots.
  const double edge = std::max(1.0, picture.width / 640.0) * std::sqrt(std::max(1.0, scale));
  const double dot = std::min(edge, std::max(1.0, 0.7 * edge));
  for (const OverlayPoint& point : in_drawing_order(points)) {
    if (!is_inside(point, window)) continue;
    draw_disc(picture, (point.u + 0.5 - window.left) * scale - 0.5,
              (point.v + 0.5 - window.top) * scale - 0.5, point.is_edge ? edge : dot,
              point.is_edge ? kEdgeColor : color_of_range(point.range));
  }
  return picture;
}

std::string overlay_section(const std::vector<CameraCalibration>& cameras) {
  std::string buttons, views;
  std::size_t shown = 0;
  for (const CameraCalibration& camera : cameras) {
    for (const CalibrationOverlay& overlay : camera.overlays) {
      if (!can_be_drawn(overlay.image)) continue;
      const std::string name = fmt::format("frame {}, camera {}", overlay.frame, camera.camera);
      buttons += button(shown, overlay.frame, camera.camera);
      views +=
          fmt::format("<article class=\"view\" id=\"view-{}\">\n<h3>F{}</h3>\n{}{}</article>\n",
                      shown, name.substr(1), slider(overlay, name), close_ups(overlay));
      ++shown;
    }
  }
  if (shown == 0) return "<p>There are no pictures: no image was used.</p>\n";
  return fmt::format(
      "{}<div class=\"picker\" role=\"group\" aria-label=\"Pictures\">\n{}</div>\n{}",
      range_legend(), buttons, views);
}

}  // namespace fovea::app
