// export --format orthophoto as a user calls it, and what GDAL reads of it.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "fovea/map/point_files/point_stream.h"
#include "tests/program.h"
#include "tests/sample_map.h"

namespace fovea::orthophoto_program_test {

using testing::HasSubstr;
using testing::UnorderedElementsAre;

class OrthophotoProgram : public testing::Test {
 protected:
  void SetUp() override {
    write_sample_map(folder_ / "map.fovea");
    const auto writer = MapWriter::open(folder_ / "map.fovea");
    writer->put_meta("complete", "1");
    writer->commit();
  }
  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  ProgramRun run(const std::string& options, const std::string& output = "a.png") const {
    return run_fovea(fmt::format("export '{}' '{}' {}", path("map.fovea"), path(output), options));
  }
  TemporaryFolder folder_;
};

TEST_F(OrthophotoProgram, TheEndingNamesTheFormat) {
  const ProgramRun written = run("--pixel 0.2");
  ASSERT_EQ(written.exit_code, 0) << written.err;
  EXPECT_THAT(written.out, HasSubstr(" pixels\n"));
  EXPECT_THAT(folder_.names(),
              UnorderedElementsAre("map.fovea", "a.png", "a.pgw", "a.png.aux.xml"));
  EXPECT_THAT(read_text(path("a.png.aux.xml")), HasSubstr("UTM zone 32N"));
  EXPECT_THAT(read_text(path("a.pgw")), testing::StartsWith("0.2\n0\n0\n-0.2\n"));
  ASSERT_EQ(run("--format orthophoto --crs local", "b.png").exit_code, 0);
  EXPECT_THAT(read_text(path("b.png.aux.xml")), HasSubstr("LOCAL_CS"));
}

TEST_F(OrthophotoProgram, TheSameMapGivesTheSameBytes) {
  ASSERT_EQ(run("--pixel 0.1").exit_code, 0);
  ASSERT_EQ(run("--pixel 0.1", "b.png").exit_code, 0);
  EXPECT_EQ(read_text(path("a.png")), read_text(path("b.png")));
}

TEST_F(OrthophotoProgram, ReplacesOnlyItsOwnFilesAndOnlyWithForce) {
  ASSERT_EQ(run("--pixel 0.2").exit_code, 0);
  EXPECT_THAT(run("--pixel 0.2").err, HasSubstr("--force"));
  EXPECT_EQ(run("--pixel 0.2 --force").exit_code, 0);
  std::ofstream(path("a.pgw")) << "my notes\n";
  const ProgramRun refused = run("--pixel 0.2 --force");
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_THAT(refused.err, HasSubstr("a.pgw"));
  EXPECT_EQ(read_text(path("a.pgw")), "my notes\n");
}

TEST_F(OrthophotoProgram, BadInputIsOneLine) {
  const auto error_of = [&](const std::string& options, const std::string& output = "a.png") {
    const ProgramRun refused = run(options, output);
    EXPECT_NE(refused.exit_code, 0) << options;
    EXPECT_THAT(folder_.names(), UnorderedElementsAre("map.fovea")) << options;
    return refused.err;
  };
  EXPECT_THAT(error_of("--crs ecef"), HasSubstr("choose utm or local"));
  EXPECT_THAT(error_of("--pixel 0"), HasSubstr("--pixel"));
  EXPECT_THAT(error_of("--pixel nan"), HasSubstr("--pixel"));
  EXPECT_THAT(error_of("--where 'height > 1e6'"), HasSubstr("no point of the map is chosen"));
  EXPECT_THAT(error_of("--double"), HasSubstr("--double"));
  EXPECT_THAT(error_of("--format orthophoto", "a.tif"), HasSubstr(".png"));
  EXPECT_THAT(error_of("--pixel 0.1", "a.ply"), HasSubstr("is for orthophoto"));
}

/// Output of a program of GDAL.
std::string gdal(const std::string& command, const std::filesystem::path& output) {
  EXPECT_EQ(std::system(fmt::format("{} >'{}'", command, output.string()).c_str()), 0) << command;
  return read_text(output);
}

TEST_F(OrthophotoProgram, GdalReadsPlaceAndColors) {
  if (std::system("command -v gdalinfo >/dev/null 2>&1") != 0) {
    GTEST_SKIP() << "GDAL is not installed: apt-get install --no-install-recommends gdal-bin";
  }
  ASSERT_EQ(run("--pixel 0.05").exit_code, 0);
  const auto info =
      nlohmann::json::parse(gdal("gdalinfo -json '" + path("a.png") + "'", folder_ / "info"));
  EXPECT_THAT(info.at("coordinateSystem").at("wkt").get<std::string>(),
              HasSubstr("ID[\"EPSG\",32632]"));
  ASSERT_EQ(info.at("bands").size(), 4u);
  EXPECT_EQ(info.at("bands")[3].at("colorInterpretation"), "Alpha");
  const MapReader map(folder_ / "map.fovea");
  const PointChoice choice{.crs = Crs::kUtm};
  std::vector<ExportPoint> points;
  PointStream(map, choice).for_each_block([&](std::span<const ExportPoint> block) {
    points.insert(points.end(), block.begin(), block.end());
  });
  int same = 0;
  for (std::size_t i = 0; i < 20; ++i) {
    const ExportPoint& point = points.at(i * points.size() / 20);
    const std::string values =
        gdal(fmt::format("gdallocationinfo -valonly -geoloc '{}' {:.6f} {:.6f}", path("a.png"),
                         point.position.x(), point.position.y()),
             folder_ / "values");
    const Rgb& color = point.color;
    same += values == fmt::format("{}\n{}\n{}\n255\n", color.r, color.g, color.b);
  }
  EXPECT_GE(same, 18);  // a few lie below others
}

}  // namespace fovea::orthophoto_program_test
