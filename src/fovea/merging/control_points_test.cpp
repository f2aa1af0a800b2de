#include "fovea/merging/control_points.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "../../../tests/temporary_folder.h"
#include "fovea/errors.h"

namespace fovea::control_points_test {

using testing::HasSubstr;
using testing::IsEmpty;

constexpr const char* kHeader = "name,role,latitude,longitude,height,sigma,map,x,y,z\n";
constexpr const char* kGoodLine = "P1,control,49.01,8.4,115.25,0.02,drive_a,1.5,-2.25,0.125\n";

class ControlPoints : public testing::Test {
 protected:
  std::vector<SurveyedPoint> read(const std::string& text) const {
    std::ofstream(path_, std::ios::binary) << text;
    return read_surveyed_points(path_);
  }

  /// Expects an error that names the line, counted from 1, and the problem.
  void expect_error(const std::string& text, int line, const std::string& problem) const {
    try {
      read(text);
      ADD_FAILURE() << "no error for:\n" << text;
    } catch (const InputError& error) {
      EXPECT_EQ(error.where(), path_.string() + ":" + std::to_string(line)) << text;
      EXPECT_THAT(error.problem(), HasSubstr(problem)) << text;
      EXPECT_THAT(error.remedy(), HasSubstr("docs/city.md"));
    }
  }

  /// Expects an error for a line after the header and a good line.
  void expect_bad_line(const std::string& line, const std::string& problem) const {
    expect_error(std::string(kHeader) + kGoodLine + line + "\n", 3, problem);
  }

  TemporaryFolder folder_;
  std::filesystem::path path_ = folder_ / "points.csv";
};

/// The point of kGoodLine.
void expect_good_point(const SurveyedPoint& point) {
  EXPECT_EQ(point.name, "P1");
  EXPECT_EQ(point.position.latitude, 49.01);
  EXPECT_EQ(point.position.longitude, 8.4);
  EXPECT_EQ(point.position.altitude, 115.25);
  EXPECT_EQ(point.sigma, 0.02);
  EXPECT_EQ(point.map, "drive_a");
  EXPECT_EQ(point.p_local, Eigen::Vector3d(1.5, -2.25, 0.125));
}

TEST_F(ControlPoints, ReadsEachColumn) {
  const auto points = read(std::string(kHeader) + kGoodLine +
                           "P2,check,-33.5,-70.625,-12,1e-3,0a1b2c,1e3,0,-0.5\n");
  ASSERT_EQ(points.size(), 2u);
  expect_good_point(points[0]);
  EXPECT_FALSE(points[0].is_check);
  EXPECT_EQ(points[1].name, "P2");
  EXPECT_TRUE(points[1].is_check);
  EXPECT_EQ(points[1].position.latitude, -33.5);
  EXPECT_EQ(points[1].position.longitude, -70.625);
  EXPECT_EQ(points[1].position.altitude, -12);
  EXPECT_EQ(points[1].sigma, 1e-3);
  EXPECT_EQ(points[1].map, "0a1b2c");
  EXPECT_EQ(points[1].p_local, Eigen::Vector3d(1000, 0, -0.5));
}

TEST_F(ControlPoints, CommentsBlankLinesAndLineEndsOfWindowsDoNotMatter) {
  const auto points = read(
      "# points of the survey of 2024\r\n"
      "\r\n"
      "name, role, latitude, longitude, height, sigma, map, x, y, z\r\n"
      "  # the first one\r\n"
      "\tP 1 , control , 49.01 , 8.4 , 115.25 , 0.02 , drive a , 1.5 , -2.25 , 0.125 \r\n"
      "   \t\r\n"
      "P2,check,49,8,100,0.05,drive_b,1,2,3");
  ASSERT_EQ(points.size(), 2u);
  EXPECT_EQ(points[0].name, "P 1");
  EXPECT_EQ(points[0].map, "drive a");
  EXPECT_EQ(points[0].p_local, Eigen::Vector3d(1.5, -2.25, 0.125));
  EXPECT_TRUE(points[1].is_check);
  EXPECT_EQ(points[1].p_local, Eigen::Vector3d(1, 2, 3));
}

TEST_F(ControlPoints, ColumnsMayHaveAnotherOrderAndOthersBetweenThem) {
  const auto points = read(
      "z,y,x,remark,map,sigma,height,longitude,latitude,role,name,date\n"
      "0.125,-2.25,1.5,,drive_a,0.02,115.25,8.4,49.01,control,P1,2024-05-01\n");
  ASSERT_EQ(points.size(), 1u);
  expect_good_point(points[0]);
}

TEST_F(ControlPoints, AFileWithoutPointsHasNone) {
  EXPECT_THAT(read(""), IsEmpty());
  EXPECT_THAT(read("\n# nothing\n\n"), IsEmpty());
  EXPECT_THAT(read(kHeader), IsEmpty());
}

TEST_F(ControlPoints, AMissingColumnIsNamed) {
  const std::string header = kHeader;
  for (const std::string column :
       {"name", "role", "latitude", "longitude", "height", "sigma", "map", "x", "y"}) {
    std::string without = header;
    without.erase(without.find(column + ","), column.size() + 1);
    expect_error("# comment\n" + without, 2, "there is no column " + column);
  }
  expect_error("name,role,latitude,longitude,height,sigma,map,x,y\n", 1, "there is no column z");
  expect_error(kGoodLine, 1, "there is no column name");
}

TEST_F(ControlPoints, EachLineHasAValueForEachColumn) {
  expect_bad_line("P2,check,49,8,100,0.05,drive_b,1,2", "9 values for 10 columns");
  expect_bad_line("P2,check,49,8,100,0.05,drive_b,1,2,3,4", "11 values for 10 columns");
  expect_bad_line("P2", "1 values for 10 columns");
}

TEST_F(ControlPoints, NumbersAreFiniteNumbers) {
  expect_bad_line("P2,check,49,8,100,0.05,drive_b,1,2,three", "z \"three\" is no number");
  expect_bad_line("P2,check,49 N,8,100,0.05,drive_b,1,2,3", "latitude \"49 N\" is no number");
  expect_bad_line("P2,check,49,8,nan,0.05,drive_b,1,2,3", "height \"nan\" is no number");
  expect_bad_line("P2,check,49,8,100,0.05,drive_b,inf,2,3", "x \"inf\" is no number");
  expect_bad_line("P2,check,49,8,100,0.05,drive_b,1,1e999,3", "y \"1e999\" is no number");
  expect_bad_line("P2,check,49,8,100,nan,drive_b,1,2,3", "sigma \"nan\" is no number");
}

TEST_F(ControlPoints, ValuesAreInTheirRange) {
  expect_bad_line("P2,checked,49,8,100,0.05,drive_b,1,2,3", "\"checked\"");
  expect_bad_line("P2,Control,49,8,100,0.05,drive_b,1,2,3", "\"Control\"");
  expect_bad_line("P2,check,49,8,100,0,drive_b,1,2,3", "sigma is not positive");
  expect_bad_line("P2,check,49,8,100,-0.05,drive_b,1,2,3", "sigma is not positive");
  expect_bad_line("P2,check,90.001,8,100,0.05,drive_b,1,2,3", "latitude");
  expect_bad_line("P2,check,-90.001,8,100,0.05,drive_b,1,2,3", "latitude");
  expect_bad_line("P2,check,49,180.5,100,0.05,drive_b,1,2,3", "longitude");
  EXPECT_EQ(read(std::string(kHeader) + "pole,check,-90,180,0,0.05,drive_b,1,2,3\n").size(), 1u);
}

TEST_F(ControlPoints, NoNeededCellIsEmpty) {
  expect_bad_line(",check,49,8,100,0.05,drive_b,1,2,3", "name is empty");
  expect_bad_line("  ,check,49,8,100,0.05,drive_b,1,2,3", "name is empty");
  expect_bad_line("P2,,49,8,100,0.05,drive_b,1,2,3", "role is empty");
  expect_bad_line("P2,check,,8,100,0.05,drive_b,1,2,3", "latitude is empty");
  expect_bad_line("P2,check,49,8,100,0.05,,1,2,3", "map is empty");
  expect_bad_line("P2,check,49,8,100,0.05,drive_b,1,2,", "z is empty");
}

TEST_F(ControlPoints, TheErrorCountsCommentsAndBlankLines) {
  expect_error("# comment\n\n" + std::string(kHeader) + "\n" + kGoodLine + "# comment\nP2\n", 7,
               "values");
}

TEST_F(ControlPoints, AMissingFileIsAnError) {
  try {
    read_surveyed_points(folder_ / "missing.csv");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(error.where(), (folder_ / "missing.csv").string());
  }
  EXPECT_THROW(read_surveyed_points(folder_.path()), InputError);
}

}  // namespace fovea::control_points_test
