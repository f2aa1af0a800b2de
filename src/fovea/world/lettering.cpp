#include "fovea/world/lettering.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>

namespace fovea {
namespace {

// Strokes on a grid of 5 x 7 places: pairs of digits x y from the lower left, '|' lifts the pen.
constexpr float kGridWidth = 4, kGridHeight = 6, kAdvance = 5.6f, kHalfStroke = 0.45f;
constexpr std::array<std::string_view, 26> kLetters = {
    "002640|1232",                      // A
    "00063645343323033342413100|0333",  // B
    "45361605011030"
    "41",  // C
    "000636454130"
    "00",                      // D
    "46060040|0333",           // E
    "460600|0333",             // F
    "4536160501103041434323",  // G
    "0006|4046|0343",          // H
    "1636|2620|1030",          // I
    "4641301001",              // J
    "0006|4603|0340",          // K
    "060040",                  // L
    "0006234640",              // M
    "00064046",                // N
    "101001051636454130"
    "10",              // O
    "00063645443303",  // P
    "1001051636454130"
    "10|2240",              // Q
    "00063645443303|2340",  // R
    "4536160504133342413010"
    "01",            // S
    "0646|2620",     // T
    "060110304146",  // U
    "062046",        // V
    "0610233046",    // W
    "0046|0640",     // X
    "062346|2320",   // Y
    "06460040",      // Z
};
constexpr std::array<std::string_view, 10> kDigits = {
    "100105163645413010|0541",  // 0
    "052620|1030",              // 1
    "051636454400"
    "40",  // 2
    "0646234130"
    "1001",                              // 3
    "30360242",                          // 4
    "460603334241301001",                // 5
    "36160501103041423303",              // 6
    "064610",                            // 7
    "13040516364544331302011030414233",  // 8
    "10304145361605041343",              // 9
};

std::string_view strokes_of(char c) {
  const auto upper = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  if (upper >= 'A' && upper <= 'Z') return kLetters[static_cast<std::size_t>(upper - 'A')];
  if (upper >= '0' && upper <= '9') return kDigits[static_cast<std::size_t>(upper - '0')];
  return {};
}

float distance_to_segment(const Eigen::Vector2f& p, const Eigen::Vector2f& a,
                          const Eigen::Vector2f& b) {
  const Eigen::Vector2f ab = b - a;
  const float length2 = ab.squaredNorm();
  const float s = length2 > 0 ? std::clamp((p - a).dot(ab) / length2, 0.0f, 1.0f) : 0.0f;
  return (p - a - s * ab).norm();
}

/// Distance from a place on the grid to a letter's strokes, in grid units.
float distance_to_letter(std::string_view strokes, const Eigen::Vector2f& p) {
  float nearest = 1e3f;
  bool pen_down = false;
  Eigen::Vector2f from = Eigen::Vector2f::Zero();
  for (std::size_t i = 0; i + 1 < strokes.size();) {
    if (strokes[i] == '|') {
      pen_down = false;
      ++i;
      continue;
    }
    const Eigen::Vector2f to(static_cast<float>(strokes[i] - '0'),
                             static_cast<float>(strokes[i + 1] - '0'));
    if (pen_down) nearest = std::min(nearest, distance_to_segment(p, from, to));
    from = to;
    pen_down = true;
    i += 2;
  }
  return nearest;
}

/// Ink at a place on the grid (from the text's lower left corner), averaged over `soft` grid units,
/// which must not be much more than a stroke's width.
float ink_on_grid(std::string_view text, const Eigen::Vector2f& p, float soft) {
  const int at = static_cast<int>(std::floor((p.x() + 0.5f * (kAdvance - kGridWidth)) / kAdvance));
  if (at < 0 || at >= static_cast<int>(text.size())) return 0;
  const Eigen::Vector2f in_letter(p.x() - kAdvance * static_cast<float>(at), p.y());
  const float distance =
      distance_to_letter(strokes_of(text[static_cast<std::size_t>(at)]), in_letter);
  return std::clamp((kHalfStroke - distance) / soft + 0.5f, 0.0f, 1.0f);
}

}  // namespace

float lettering_ink(std::string_view text, const Eigen::Vector2f& place,
                    const Eigen::Vector2f& board, float footprint) {
  if (text.empty()) return 0;
  const float width = kAdvance * static_cast<float>(text.size()) - (kAdvance - kGridWidth);
  // A margin of one grid unit around the text.
  const float unit = std::min(board.x() / (width + 2), board.y() / (kGridHeight + 2));
  const Eigen::Vector2f p =
      (place - 0.5f * board) / unit + 0.5f * Eigen::Vector2f(width, kGridHeight);
  // A wide footprint is taken apart: the distance to one stroke says nothing of the others in it.
  constexpr float kSoftest = 0.5f;
  constexpr int kMost = 8;
  const float side = std::max(footprint / unit, 1e-3f);
  const int steps = std::clamp(static_cast<int>(std::ceil(side / kSoftest)), 1, kMost);
  const float step = side / static_cast<float>(steps);
  float sum = 0;
  for (int i = 0; i < steps * steps; ++i) {
    const int column = i % steps, row = i / steps;
    const Eigen::Vector2f cell(static_cast<float>(column), static_cast<float>(row));
    const Eigen::Vector2f offset = step * (cell.array() + 0.5f) - 0.5f * side;
    sum += ink_on_grid(text, p + offset, std::min(step, kSoftest));
  }
  return sum / static_cast<float>(steps * steps);
}

}  // namespace fovea
