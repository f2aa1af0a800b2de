#include <gmock/gmock.h>
#include <png.h>

#include <array>
#include <cmath>
#include <fstream>
#include <limits>

#include "../../../../tests/file_content.h"
#include "../../../../tests/peak_memory.h"
#include "../../../../tests/sample_map.h"
#include "../../../../tests/temporary_folder.h"
#include "fovea/errors.h"
#include "fovea/exporting/orthophoto/orthophoto_writer.h"
#include "fovea/map/map_meta.h"

namespace fovea::orthophoto_test {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

/// A picture that libpng reads by itself, with its world file.
struct Picture {
  explicit Picture(const std::filesystem::path& path) {
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    EXPECT_TRUE(png_image_begin_read_from_file(&image, path.c_str()));
    image.format = PNG_FORMAT_RGBA;
    width = static_cast<int>(image.width), height = static_cast<int>(image.height);
    rgba.resize(PNG_IMAGE_SIZE(image));
    EXPECT_TRUE(png_image_finish_read(&image, nullptr, rgba.data(), 0, nullptr));
    std::filesystem::path world_file = path;
    std::ifstream file(world_file.replace_extension(".pgw"));
    for (double& number : world) file >> number;
    EXPECT_TRUE(file.good());
  }
  /// As a program that reads world files: the last two numbers are the center of the first pixel.
  std::array<int, 2> pixel_at(const Eigen::Vector3d& p) const {
    return {static_cast<int>(std::lround((p.x() - world[4]) / world[0])),
            static_cast<int>(std::lround((p.y() - world[5]) / world[3]))};
  }
  std::array<int, 4> at(int column, int row) const {
    const std::size_t i = 4 * (std::size_t(row) * std::size_t(width) + std::size_t(column));
    return {rgba.at(i), rgba.at(i + 1), rgba.at(i + 2), rgba.at(i + 3)};
  }

  int width = 0, height = 0;
  std::array<double, 6> world{};
  std::vector<std::uint8_t> rgba;
};

class Orthophoto : public testing::Test {
 protected:
  /// @param points_local  each with its own color code
  void write_map(const std::vector<Eigen::Vector3f>& points_local) const {
    const auto writer = MapWriter::create(map(), true);
    writer->put_meta("map.tile_size_m", "4");
    TileMap tiles(4.0);
    tiles.add_submap(exp_se3((Twist() << 0, 0, 0.4, 7, -3, 1).finished()));
    PointCloud points = one_point_each(points_local);
    for (std::size_t i = 0; i < points.size(); ++i) {
      points.color[i] = {std::uint8_t(60 + 20 * i), std::uint8_t(200 - 20 * i), 90};
    }
    tiles.add(points);
    writer->put_submap(0, tiles.submaps()[0].T_local_submap);
    for (const auto& [key, tile] : tiles.submaps()[0].tiles) {
      writer->put_tile({0, key}, *tile.points);
    }
    writer->commit();
  }
  OrthophotoFigures write(double pixel, const std::string& where = "") const {
    OrthophotoOptions options{.pixel = pixel, .force = true};
    if (!where.empty()) options.points.where = PointFilter::parse(where);
    return write_orthophoto(MapReader(map()), out(), options);
  }
  /// The points as another export has them, in the map's order.
  std::vector<ExportPoint> points(Crs crs) const {
    const MapReader reader(map());
    const PointChoice choice{.crs = crs};
    std::vector<ExportPoint> all;
    PointStream(reader, choice).for_each_block([&](std::span<const ExportPoint> block) {
      all.insert(all.end(), block.begin(), block.end());
    });
    return all;
  }
  std::filesystem::path map() const { return folder_ / "a.fovea"; }
  std::filesystem::path out() const { return folder_ / "a.png"; }
  TemporaryFolder folder_;
};

TEST_F(Orthophoto, EachPointIsInThePixelThatTheWorldFileStates) {
  write_map({{-3.21f, 4.05f, 0}, {2.52f, -1.38f, 5}, {0.01f, 0.02f, 1}, {2.52f, 4.05f, 1}});
  const OrthophotoFigures figures = write(0.1);
  const Picture picture(out());
  EXPECT_EQ(picture.width, 59);  // x from -3.3 to 2.6
  EXPECT_EQ(picture.height, 55);
  EXPECT_EQ(figures.width, picture.width);
  EXPECT_EQ(figures.filled_pixels, 0u);
  const std::vector<ExportPoint> all = points(Crs::kLocal);
  ASSERT_EQ(all.size(), 4u);
  for (const ExportPoint& point : all) {
    const auto [column, row] = picture.pixel_at(point.position);
    const std::array<int, 4> expected{point.color.r, point.color.g, point.color.b, 255};
    EXPECT_EQ(picture.at(column, row), expected);
  }
  EXPECT_EQ(picture.at(20, 20), (std::array<int, 4>{0, 0, 0, 0}));
}

TEST_F(Orthophoto, LiesInUtmWhereTheMapIsGeoreferenced) {
  write_sample_map(map());
  const MapReader reader(map());
  ASSERT_EQ(orthophoto_crs(reader), Crs::kUtm);
  write_orthophoto(reader, out(), {.points = {.crs = Crs::kUtm}, .pixel = 0.25});
  const Picture picture(out());
  std::map<std::array<int, 2>, std::vector<ExportPoint>> pixels;
  for (const ExportPoint& point : points(Crs::kUtm)) {
    const auto [column, row] = picture.pixel_at(point.position);
    ASSERT_TRUE(column >= 0 && column < picture.width && row >= 0 && row < picture.height);
    pixels[{column, row}].push_back(point);
  }
  std::size_t compared = 0;
  for (const auto& [pixel, here] : pixels) {
    EXPECT_EQ(picture.at(pixel[0], pixel[1])[3], 255);
    if (here.size() != 1) continue;
    const Rgb color = here[0].color;
    EXPECT_EQ(picture.at(pixel[0], pixel[1]), (std::array<int, 4>{color.r, color.g, color.b, 255}));
    ++compared;
  }
  EXPECT_GT(compared, 1000u);
  // The borders of pixels are multiples of the pixel's edge, so that neighbors fit together.
  EXPECT_NEAR(std::remainder(picture.world[4] - 0.125, 0.25), 0, 1e-6);
  const std::string auxiliary = content(folder_ / "a.png.aux.xml");
  EXPECT_THAT(auxiliary, HasSubstr("PROJCS[&quot;WGS 84 / UTM zone 32N&quot;"));
  EXPECT_THAT(auxiliary, HasSubstr("&quot;EPSG&quot;,&quot;32632&quot;"));
}

TEST_F(Orthophoto, AMapWithoutAPlaceOnEarthIsLocal) {
  write_map({{0, 0, 0}});
  EXPECT_EQ(orthophoto_crs(MapReader(map())), Crs::kLocal);
  write(0.1);
  EXPECT_THAT(content(folder_ / "a.png.aux.xml"), HasSubstr("LOCAL_CS"));
}

TEST_F(Orthophoto, ConditionsTakeAwayWhatIsAbove) {
  write_map({{1, 1, 0}, {1, 1, 6}});
  const std::vector<ExportPoint> all = points(Crs::kLocal);
  const auto color_of = [&](double z) {
    for (const ExportPoint& point : all) {
      if (std::abs(point.position.z() - z) < 0.01) return point.color;
    }
    return Rgb{};
  };
  write(0.1);
  EXPECT_EQ(Picture(out()).at(0, 0)[0], color_of(6).r);
  write(0.1, "z < 2");
  EXPECT_EQ(Picture(out()).at(0, 0)[0], color_of(0).r);
}

// Of 3000 x 3000 pixels, which need several stripes, memory holds one; the gap of a pixel is filled
// wherever a stripe ends.
TEST_F(Orthophoto, IsMadeInStripes) {
  std::vector<Eigen::Vector3f> along{{0.5f, 0.5f, 0}, {2999.5f, 2999.5f, 0}};
  for (float y = 0.5f; y < 3000; y += 2) along.emplace_back(1500.5f, y, 0.f);
  write_map(along);
  std::size_t filled = 0;
  [[maybe_unused]] const std::size_t rise =
      rise_of_peak_memory([&] { filled = write(1).filled_pixels; });
  EXPECT_EQ(filled, 1499u);
#ifndef FOVEA_SANITIZER                     // it keeps memory that was released
  EXPECT_LT(rise, std::size_t{130} << 20);  // a view of all pixels takes 180 MB
#endif
  const Picture picture(out());
  for (int row = 1; row < 3000; ++row) ASSERT_EQ(picture.at(1500, row)[3], 255) << row;
}

TEST_F(Orthophoto, RefusesWhatCannotBeAPicture) {
  write_map({{0, 0, 0}, {5000, 3000, 0}});
  const MapReader reader(map());
  const auto refused = [&](const std::filesystem::path& path, const OrthophotoOptions& options) {
    return [&reader, path, options] { write_orthophoto(reader, path, options); };
  };
  // 5000 m x 3000 m at 0.1 m are 1.5 thousand million pixels.
  EXPECT_THAT(refused(out(), {.pixel = 0.1}),
              ThrowsMessage<ConfigError>(HasSubstr("--pixel, choose 0.2 m or more")));
  EXPECT_THAT(refused(out(), {.pixel = 1e-300}), ThrowsMessage<ConfigError>(HasSubstr("0.2 m")));
  for (const double pixel : {0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
    EXPECT_THROW(refused(out(), {.pixel = pixel})(), ConfigError) << pixel;
  }
  EXPECT_THAT(refused(folder_ / "a.tif", {}), ThrowsMessage<ConfigError>(HasSubstr(".png")));
  EXPECT_THAT(refused(out(), {.points = {.crs = Crs::kEcef}}),
              ThrowsMessage<ConfigError>(HasSubstr("utm or local")));
  OrthophotoOptions none;
  none.points.where = PointFilter::parse("z > 100");
  EXPECT_THAT(refused(out(), none), ThrowsMessage<InputError>(HasSubstr("no point")));
  none.may_be_empty = true;
  EXPECT_EQ(write_orthophoto(reader, out(), none).width, 0);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_ / ""), {}), 1);
}

TEST_F(Orthophoto, ReplacesNoFileWithoutForce) {
  write_map({{0, 0, 0}});
  for (const std::filesystem::path& file : orthophoto_files(out())) {
    std::ofstream(file) << "old";
    EXPECT_THROW(write_orthophoto(MapReader(map()), out(), {}), OutputError) << file;
    EXPECT_EQ(content(file), "old");
    std::filesystem::remove(file);
  }
  write(0.05);
  write(0.05);  // with force
}

}  // namespace fovea::orthophoto_test
