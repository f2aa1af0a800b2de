#include "fovea/map/point_files/ply_reader.h"

#include <algorithm>
#include <array>

#include "fovea/core/point_formats/ply_rows.h"
#include "fovea/errors.h"

namespace fovea {
namespace {

/// By column.
constexpr std::array<const char*, kCloudColumns> kPropertyNames = {
    "x", "y", "z", "red", "green", "blue", "camera", "frame", "interpolated"};

class ColoredVertices : public CloudRows {
 public:
  ColoredVertices(const std::filesystem::path& file, const Eigen::Vector3d& origin)
      : name_(file.string()), cloud_(file, origin) {}

  std::span<const char* const> columns() const override { return kPropertyNames; }
  const char* description() const override { return "x y z and red green blue"; }

  void begin(std::size_t points, std::span<const std::optional<Scalar>> types) override {
    std::array<bool, kCloudColumns> has{};
    std::transform(types.begin(), types.end(), has.begin(),
                   [](const auto& type) { return !!type; });
    for (const CloudColumn channel : {kRed, kGreen, kBlue}) {
      const bool is_known = types[channel] == Scalar::kUint8 || types[channel] == Scalar::kUint16;
      if (has[channel] && !is_known) reject("red, green, blue must be uchar or ushort");
    }
    if (types[kRed] == Scalar::kUint16) white_ = kDeepWhite;
    if (has[kRed] != has[kGreen] || has[kRed] != has[kBlue]) {
      reject("red, green and blue are not all there");
    }
    cloud_.expect(points, has);
  }

  void add(std::span<const double> row, std::size_t number) override {
    CloudRow values;
    std::copy(row.begin(), row.end(), values.begin());
    scale_colors(values, white_);
    cloud_.add(values, number);
  }

  CloudFile take() { return cloud_.take(); }

 private:
  [[noreturn]] void reject(const char* what) const {
    throw InputError(what, name_, std::string("give a PLY file with ") + description());
  }

  std::string name_;
  CloudBuilder cloud_;
  double white_ = 255;
};

}  // namespace

CloudFile read_ply(const std::filesystem::path& file, const Eigen::Vector3d& origin) {
  ColoredVertices vertices(file, origin);
  InputFile input(file, kStreamedFile);
  read_ply_rows(input, vertices);
  return vertices.take();
}

}  // namespace fovea
