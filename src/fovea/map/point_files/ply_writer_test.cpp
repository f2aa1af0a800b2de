#include "fovea/map/point_files/ply_writer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "../../../../tests/file_size_limit.h"
#include "../../../../tests/sample_map.h"
#include "../../../../tests/temporary_folder.h"
#include "fovea/errors.h"
#include "fovea/map/map_meta.h"
#include "fovea/map/point_files/ply_reader.h"
#include "fovea/platform.h"

namespace fovea::ply_writer_test {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// A minimal reader of binary little endian PLY with one element, written from the format's
/// description: every property by name, as double.
struct Ply {
  explicit Ply(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    std::string line;
    std::getline(file, line);
    EXPECT_EQ(line, "ply");
    std::getline(file, line);
    EXPECT_EQ(line, "format binary_little_endian 1.0");
    while (std::getline(file, line) && line != "end_header") {
      std::istringstream words(line);
      std::string word, type, name;
      words >> word;
      if (word == "comment") {
        comments.push_back(line.substr(8));
      } else if (word == "element") {
        words >> name >> count;
        EXPECT_EQ(name, "vertex");
      } else {
        EXPECT_EQ(word, "property");
        words >> type >> name;
        properties.emplace_back(name, type);
      }
    }
    for (std::size_t i = 0; i < count; ++i) {
      for (const auto& [name, type] : properties) columns[name].push_back(value(file, type));
    }
    EXPECT_TRUE(file.good()) << "fewer points than the header says";
    file.peek();
    EXPECT_TRUE(file.eof()) << "more bytes than the header says";
  }

  static double value(std::istream& file, const std::string& type) {
    if (type == "double") return raw<double>(file);
    if (type == "float") return raw<float>(file);
    if (type == "int") return raw<std::int32_t>(file);
    if (type == "char") return raw<std::int8_t>(file);
    if (type == "ushort") return raw<std::uint16_t>(file);
    EXPECT_EQ(type, "uchar");
    return raw<std::uint8_t>(file);
  }
  template <class T>
  static double raw(std::istream& file) {
    T result{};
    file.read(reinterpret_cast<char*>(&result), sizeof(T));
    return static_cast<double>(result);
  }

  std::size_t count = 0;
  std::vector<std::string> comments;
  std::vector<std::pair<std::string, std::string>> properties;
  std::map<std::string, std::vector<double>> columns;
};

class PlyWriter : public testing::Test {
 protected:
  void SetUp() override { write_sample_map(folder_ / "a.fovea"); }
  ExportFigures write(const PointFileOptions& options = {}) {
    return write_ply(MapReader(folder_ / "a.fovea"), folder_ / "a.ply", options);
  }
  TemporaryFolder folder_;
};

TEST_F(PlyWriter, OnlyPointsThatMeetTheConditions) {
  const ExportFigures all = write();
  PointFileOptions options;
  options.points.where = PointFilter::parse("views >= 100 and range < 9");
  options.force = true;
  const ExportFigures some = write(options);
  std::size_t expected = 0;
  for_each_sample_point([&](const Eigen::Vector3d&, const PointCloud& tile, std::size_t i) {
    expected += tile.camera[i] != kNoCamera && tile.views[i] >= 100 && tile.range[i] < 9;
  });
  EXPECT_EQ(some.points, expected);
  EXPECT_GT(expected, 0u);
  EXPECT_EQ(some.filtered_out, all.points - expected);
  EXPECT_EQ(some.uncolored_left_out, all.uncolored_left_out);
  const Ply ply(folder_ / "a.ply");
  EXPECT_EQ(ply.count, expected);
  for (const double views : ply.columns.at("views")) EXPECT_GE(views, 100);
}

TEST_F(PlyWriter, ColoredPointsWithAllProperties) {
  const ExportFigures figures = write();
  const Ply ply(folder_ / "a.ply");
  const std::vector<std::pair<std::string, std::string>> expected_properties = {
      {"x", "float"},      {"y", "float"},
      {"z", "float"},      {"red", "uchar"},
      {"green", "uchar"},  {"blue", "uchar"},
      {"camera", "char"},  {"frame", "int"},
      {"range", "float"},  {"interpolated", "uchar"},
      {"views", "uchar"},  {"spread", "uchar"},
      {"reason", "uchar"}, {"intensity", "float"}};
  EXPECT_EQ(ply.properties, expected_properties);
  EXPECT_EQ(ply.comments[0], std::string("fovea ") + version());
  EXPECT_THAT(ply.comments,
              Contains(HasSubstr("latitude 49.011212804408 longitude 8.4228850417969")));

  const ColorDisplay display = color_display({}, MapReader(folder_ / "a.fovea").frames());
  std::size_t row = 0, left_out = 0;
  for_each_sample_point([&](const Eigen::Vector3d& p_local, const PointCloud& tile, std::size_t i) {
    if (tile.camera[i] == kNoCamera) {
      ++left_out;
      return;
    }
    ASSERT_LT(row, ply.count);
    const auto at = [&](const char* name) { return ply.columns.at(name)[row]; };
    EXPECT_LT((Eigen::Vector3d(at("x"), at("y"), at("z")) - p_local).norm(), 1e-5);
    EXPECT_EQ(at("red"), display(tile.color[i]).r);
    EXPECT_EQ(at("green"), display(tile.color[i]).g);
    EXPECT_EQ(at("blue"), display(tile.color[i]).b);
    EXPECT_EQ(at("camera"), tile.camera[i]);
    EXPECT_EQ(at("frame"), tile.frame[i]);
    EXPECT_EQ(at("range"), tile.range[i]);
    EXPECT_EQ(at("interpolated"), tile.interpolated[i]);
    EXPECT_EQ(at("views"), tile.views[i]);
    EXPECT_EQ(at("spread"), tile.spread[i]);
    EXPECT_EQ(at("reason"), tile.reason[i]);
    EXPECT_EQ(at("intensity"), tile.intensity[i]);
    ++row;
  });
  EXPECT_EQ(row, ply.count);
  EXPECT_GT(left_out, 0u);
  EXPECT_EQ(figures.points, ply.count);
  EXPECT_EQ(figures.uncolored_left_out, left_out);
}

TEST_F(PlyWriter, DoublePositionsAndUncolouredPoints) {
  const ExportFigures figures =
      write({.points = {.include_uncolored = true}, .double_positions = true});
  const Ply ply(folder_ / "a.ply");
  EXPECT_EQ(figures.points, sample_tile_map().size());
  EXPECT_EQ(figures.uncolored_left_out, 0u);
  ASSERT_EQ(ply.count, figures.points);
  EXPECT_EQ(ply.properties[2].second, "double");
  const ColorDisplay display = color_display({}, MapReader(folder_ / "a.fovea").frames());
  std::size_t row = 0;
  for_each_sample_point([&](const Eigen::Vector3d& p_local, const PointCloud& tile, std::size_t i) {
    const auto at = [&](const char* name) { return ply.columns.at(name)[row]; };
    EXPECT_LT((Eigen::Vector3d(at("x"), at("y"), at("z")) - p_local).norm(), 1e-12);
    EXPECT_EQ(at("camera"), tile.camera[i]);
    const Rgb color = tile.camera[i] == kNoCamera ? Rgb{128, 128, 128} : display(tile.color[i]);
    EXPECT_EQ(at("red"), color.r);
    EXPECT_EQ(at("green"), color.g);
    EXPECT_EQ(at("blue"), color.b);
    ++row;
  });
}

TEST_F(PlyWriter, CoordinatesOfTheEarthAreDoubles) {
  PointFileOptions options;
  for (const Crs crs : {Crs::kUtm, Crs::kEcef}) {
    options.points.crs = crs;
    write(options);
    options.force = true;
    const Ply ply(folder_ / "a.ply");
    EXPECT_EQ(ply.properties[0].second, "double");
    const Georeference expected(crs, map_origin(MapReader(folder_ / "a.fovea").meta()), "a.fovea");
    EXPECT_THAT(ply.comments, Contains(expected.description()));
    EXPECT_THAT(ply.comments, Contains("crs " + expected.wkt2()));
    std::size_t row = 0;
    for_each_sample_point(
        [&](const Eigen::Vector3d& p_local, const PointCloud& tile, std::size_t i) {
          if (tile.camera[i] == kNoCamera) return;
          const auto at = [&](const char* name) { return ply.columns.at(name)[row]; };
          const Eigen::Vector3d p(at("x"), at("y"), at("z"));
          EXPECT_LT((p - expected.from_local(p_local)).norm(), 1e-8);
          ++row;
        });
    EXPECT_EQ(row, ply.count);
  }
}

TEST_F(PlyWriter, UncolouredPointsAreLeftOutByTheirCamera) {
  PointFileOptions options;
  options.points.include_uncolored = true;
  options.points.where = PointFilter::parse("camera>=0");
  const ExportFigures coloured = write(options);
  EXPECT_EQ(coloured.points, MapReader(folder_ / "a.fovea").colored_size());
  const Ply ply(folder_ / "a.ply");
  for (const double camera : ply.columns.at("camera")) EXPECT_GE(camera, 0);
  options.points.where = PointFilter::parse("camera == -1");
  options.force = true;
  EXPECT_EQ(write(options).points + coloured.points, sample_tile_map().size());
}

TEST_F(PlyWriter, AMapWithoutIntensitiesHasNoSuchProperty) {
  write_map_without_intensity(folder_ / "b.fovea");
  const MapReader map(folder_ / "b.fovea");
  write_ply(map, folder_ / "b.ply");
  const Ply ply(folder_ / "b.ply");
  EXPECT_EQ(ply.count, 2u);
  EXPECT_EQ(ply.properties.back().first, "reason");
}

TEST_F(PlyWriter, PointsOfADriveWithoutIntensitiesHaveZero) {
  write_map_without_intensity(folder_ / "b.fovea");
  {
    const auto writer = MapWriter::open(folder_ / "b.fovea");
    PointCloud more = one_point_each({{1, 1, 1}});
    more.intensity = {0.5f};
    writer->put_submap(1, RigidMotion::Identity());
    writer->put_tile({1, {0, 0, 0}}, more);
    writer->commit();
  }
  write_ply(MapReader(folder_ / "b.fovea"), folder_ / "b.ply");
  EXPECT_THAT(Ply(folder_ / "b.ply").columns.at("intensity"), ElementsAre(0, 0, 0.5));
}

TEST_F(PlyWriter, FoveaReadsItBack) {
  const ExportFigures figures = write();
  const CloudFile cloud = read_ply(folder_ / "a.ply", {0, 0, 0});
  EXPECT_EQ(cloud.points.size(), figures.points);
  std::size_t row = 0;
  for_each_sample_point([&](const Eigen::Vector3d&, const PointCloud& tile, std::size_t i) {
    if (tile.camera[i] == kNoCamera) return;
    EXPECT_EQ(cloud.points.frame.at(row), tile.frame[i]);
    EXPECT_EQ(cloud.points.interpolated.at(row++), tile.interpolated[i]);
  });
}

TEST_F(PlyWriter, ReplacesOnlyWithForce) {
  std::ofstream(folder_ / "a.ply") << "old";
  EXPECT_THROW(write(), OutputError);
  EXPECT_EQ(std::filesystem::file_size(folder_ / "a.ply"), 3u);
  write({.force = true});
  EXPECT_GT(Ply(folder_ / "a.ply").count, 0u);
}

TEST_F(PlyWriter, LeavesNothingWhenTheDiskIsFull) {
  const MapReader reader(folder_ / "a.fovea");
  const FileSizeLimit limit(30'000);
  EXPECT_THROW(write_ply(reader, folder_ / "a.ply"), OutputError);
  EXPECT_THAT(folder_.names(), ElementsAre("a.fovea"));
}

TEST_F(PlyWriter, AnEmptyMapGivesAnEmptyCloud) {
  MapWriter::create(folder_ / "b.fovea", false)->commit();
  const ExportFigures figures = write_ply(MapReader(folder_ / "b.fovea"), folder_ / "b.ply");
  EXPECT_EQ(figures.points, 0u);
  const Ply ply(folder_ / "b.ply");
  EXPECT_EQ(ply.count, 0u);
  EXPECT_EQ(ply.comments.size(), 2u);  // not georeferenced: no origin
}

TEST(DeepPly, HasColorsOf16Bits) {
  const TemporaryFolder folder;
  write_sample_map(folder / "a.fovea");
  const MapReader map(folder / "a.fovea");
  write_ply(map, folder / "a.ply", {.points = {.exposure = parse_exposure("0")}});
  write_ply(map, folder / "deep.ply",
            {.points = {.exposure = parse_exposure("0"), .deep_colors = true}});
  const Ply plain(folder / "a.ply"), deep(folder / "deep.ply");
  for (const auto& [name, type] : deep.properties) {
    if (name == "red") EXPECT_EQ(type, "ushort");
  }
  EXPECT_THAT(deep.comments, Contains(HasSubstr("exposure +0.00 +0.00 +0.00 stops")));
  ASSERT_GT(deep.count, 0u);
  for (const char* channel : {"red", "green", "blue"}) {
    for (std::size_t i = 0; i < deep.count; ++i) {
      EXPECT_EQ(std::lround(deep.columns.at(channel)[i] / 257), plain.columns.at(channel)[i]);
    }
  }
}

}  // namespace fovea::ply_writer_test
