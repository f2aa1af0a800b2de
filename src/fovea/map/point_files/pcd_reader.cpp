#include "fovea/map/point_files/pcd_reader.h"

#include <algorithm>
#include <array>

#include "fovea/core/point_formats/pcd_rows.h"
#include "fovea/errors.h"

namespace fovea {
namespace {

/// The cloud's columns, and the two that colours may be packed into.
constexpr std::array<const char*, kCloudColumns + 2> kFieldNames = {
    "x", "y", "z", "r", "g", "b", "camera", "frame", "interpolated", "rgb", "rgba"};

class ColoredPoints : public CloudRows {
 public:
  ColoredPoints(const std::filesystem::path& file, const Eigen::Vector3d& origin)
      : name_(file.string()), cloud_(file, origin) {}

  std::span<const char* const> columns() const override { return kFieldNames; }
  const char* description() const override { return "x y z and rgb"; }

  void begin(std::size_t points, std::span<const std::optional<Scalar>> types) override {
    std::array<bool, kCloudColumns> has{};
    for (std::size_t column = 0; column < kCloudColumns; ++column) has[column] = !!types[column];
    if (has[kRed] != has[kGreen] || has[kRed] != has[kBlue]) {
      throw InputError("r, g and b are not all there", name_,
                       std::string("give a PCD file with ") + description());
    }
    for (std::size_t column = kFieldNames.size(); column-- > kCloudColumns;) {
      if (types[column]) packed_ = column;  // rgb, before rgba
    }
    if (packed_) has[kRed] = has[kGreen] = has[kBlue] = true;
    if (!packed_ && types[kRed] == Scalar::kUint16) white_ = kDeepWhite;
    cloud_.expect(points, has);
  }

  void add(std::span<const double> row, std::size_t number) override {
    if (std::isnan(row[kX]) || std::isnan(row[kY]) || std::isnan(row[kZ])) return;
    CloudRow values;
    std::copy_n(row.begin(), values.size(), values.begin());
    if (packed_) {
      const auto color = static_cast<std::uint32_t>(row[*packed_]);
      values[kRed] = color >> 16 & 0xff;
      values[kGreen] = color >> 8 & 0xff;
      values[kBlue] = color & 0xff;
    }
    scale_colors(values, white_);
    cloud_.add(values, number);
  }

  CloudFile take() { return cloud_.take(); }

 private:
  std::string name_;
  CloudBuilder cloud_;
  std::optional<std::size_t> packed_;  // column
  double white_ = 255;
};

}  // namespace

CloudFile read_pcd(const std::filesystem::path& file, const Eigen::Vector3d& origin) {
  ColoredPoints points(file, origin);
  InputFile input(file, kStreamedFile);
  read_pcd_rows(input, points);
  return points.take();
}

}  // namespace fovea
