#include "fovea/map/point_files/pcd_writer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <map>
#include <sstream>

#include "../../../../tests/sample_map.h"
#include "../../../../tests/temporary_folder.h"
#include "fovea/errors.h"
#include "fovea/map/point_files/pcd_reader.h"

namespace fovea::pcd_writer_test {

using ::testing::ElementsAre;

/// A minimal reader of binary PCD, written from the format's description: rows of bytes, and where
/// in them each field lies.
struct Pcd {
  explicit Pcd(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    std::string line, word;
    while (word != "DATA" && std::getline(file, line)) {
      if (line.starts_with("#")) continue;
      std::istringstream words(line);
      words >> word;
      std::vector<std::string>& values = header[word];
      for (std::string value; words >> value;) values.push_back(value);
    }
    std::size_t offset = 0;
    for (std::size_t i = 0; i < header["FIELDS"].size(); ++i) {
      offsets[header["FIELDS"][i]] = offset;
      offset += std::stoul(header["SIZE"].at(i));
    }
    std::string row(offset, '\0');
    while (file.read(row.data(), static_cast<std::streamsize>(offset))) rows.push_back(row);
    EXPECT_EQ(file.gcount(), 0) << "part of a point at the end";
  }
  template <class T>
  T at(std::size_t row, const char* field) const {
    T value{};
    std::memcpy(&value, rows.at(row).data() + offsets.at(field), sizeof(T));
    return value;
  }

  std::map<std::string, std::vector<std::string>> header;
  std::map<std::string, std::size_t> offsets;
  std::vector<std::string> rows;
};

class PcdWriter : public testing::Test {
 protected:
  void SetUp() override { write_sample_map(folder_ / "a.fovea"); }
  ExportFigures write(const PointFileOptions& options = {}) {
    return write_pcd(MapReader(folder_ / "a.fovea"), folder_ / "a.pcd", options);
  }
  /// Compares what was written with the sample map.
  template <class Real>
  void expect_sample_points(const Pcd& pcd, bool uncolored, double tolerance) {
    const ColorDisplay display = color_display({}, MapReader(folder_ / "a.fovea").frames());
    std::size_t row = 0;
    for_each_sample_point(
        [&](const Eigen::Vector3d& p_local, const PointCloud& tile, std::size_t i) {
          const bool colored = tile.camera[i] != kNoCamera;
          if (!colored && !uncolored) return;
          const Eigen::Vector3d p(pcd.at<Real>(row, "x"), pcd.at<Real>(row, "y"),
                                  pcd.at<Real>(row, "z"));
          EXPECT_LT((p - p_local).norm(), tolerance);
          const Rgb color = colored ? display(tile.color[i]) : kUncolored;
          EXPECT_EQ(pcd.at<std::uint32_t>(row, "rgb"),
                    std::uint32_t{color.r} << 16 | std::uint32_t{color.g} << 8 | color.b);
          EXPECT_EQ(pcd.at<std::int8_t>(row, "camera"), tile.camera[i]);
          EXPECT_EQ(pcd.at<std::int32_t>(row, "frame"), tile.frame[i]);
          EXPECT_EQ(pcd.at<float>(row, "range"), tile.range[i]);
          EXPECT_EQ(pcd.at<std::uint8_t>(row, "interpolated"), tile.interpolated[i]);
          EXPECT_EQ(pcd.at<std::uint8_t>(row, "views"), tile.views[i]);
          EXPECT_EQ(pcd.at<std::uint8_t>(row, "spread"), tile.spread[i]);
          EXPECT_EQ(pcd.at<std::uint8_t>(row, "reason"), tile.reason[i]);
          EXPECT_EQ(pcd.at<float>(row, "intensity"), tile.intensity[i]);
          ++row;
        });
    EXPECT_EQ(row, pcd.rows.size());
  }
  TemporaryFolder folder_;
};

TEST_F(PcdWriter, EveryFieldOfEveryPoint) {
  const ExportFigures figures = write();
  const Pcd pcd(folder_ / "a.pcd");
  const std::string count = std::to_string(figures.points);
  EXPECT_THAT(pcd.header.at("VERSION"), ElementsAre("0.7"));
  EXPECT_THAT(pcd.header.at("TYPE"),
              ElementsAre("F", "F", "F", "F", "I", "I", "F", "U", "U", "U", "U", "F"));
  EXPECT_THAT(pcd.header.at("WIDTH"), ElementsAre(count));
  EXPECT_THAT(pcd.header.at("HEIGHT"), ElementsAre("1"));
  EXPECT_THAT(pcd.header.at("POINTS"), ElementsAre(count));
  EXPECT_THAT(pcd.header.at("VIEWPOINT"), ElementsAre("0", "0", "0", "1", "0", "0", "0"));
  EXPECT_THAT(pcd.header.at("DATA"), ElementsAre("binary"));
  expect_sample_points<float>(pcd, false, 1e-5);
}

TEST_F(PcdWriter, DoublesAndUncolouredPoints) {
  write({.points = {.include_uncolored = true}, .double_positions = true});
  const Pcd pcd(folder_ / "a.pcd");
  EXPECT_EQ(pcd.header.at("SIZE").front(), "8");
  expect_sample_points<double>(pcd, true, 1e-12);
}

TEST_F(PcdWriter, CoordinatesOfTheEarthAreDoubles) {
  write({.points = {.crs = Crs::kEcef}});
  const Pcd pcd(folder_ / "a.pcd");
  EXPECT_EQ(pcd.header.at("SIZE").front(), "8");
  EXPECT_GT(std::abs(pcd.at<double>(0, "x")), 4e6);
}

TEST_F(PcdWriter, AMapWithoutIntensitiesHasNoSuchField) {
  write_map_without_intensity(folder_ / "b.fovea");
  write_pcd(MapReader(folder_ / "b.fovea"), folder_ / "b.pcd");
  const Pcd pcd(folder_ / "b.pcd");
  EXPECT_EQ(pcd.rows.size(), 2u);
  EXPECT_EQ(pcd.header.at("FIELDS").back(), "reason");
  for (const char* line : {"SIZE", "TYPE", "COUNT"}) EXPECT_EQ(pcd.header.at(line).size(), 11u);
}

TEST_F(PcdWriter, FoveaReadsItBack) {
  const ExportFigures figures = write();
  const CloudFile cloud = read_pcd(folder_ / "a.pcd", {0, 0, 0});
  EXPECT_EQ(cloud.points.size(), figures.points);
  std::size_t row = 0;
  for_each_sample_point([&](const Eigen::Vector3d&, const PointCloud& tile, std::size_t i) {
    if (tile.camera[i] == kNoCamera) return;
    EXPECT_EQ(cloud.points.frame.at(row), tile.frame[i]);
    EXPECT_EQ(cloud.points.interpolated.at(row++), tile.interpolated[i]);
  });
}

TEST_F(PcdWriter, ReplacesOnlyWithForce) {
  std::ofstream(folder_ / "a.pcd") << "old";
  EXPECT_THROW(write(), OutputError);
  write({.force = true});
  EXPECT_GT(std::filesystem::file_size(folder_ / "a.pcd"), 3u);
}

}  // namespace fovea::pcd_writer_test
