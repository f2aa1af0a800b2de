#include "fovea/core/point_formats/column_names.h"

#include <gtest/gtest.h>

#include <vector>

namespace fovea::column_names_test {

using Names = std::vector<std::string>;

TEST(ColumnNames, CaseAndSignsDoNotMatter) {
  EXPECT_EQ(plain_column_name("Time_Stamp"), "timestamp");
  EXPECT_EQ(plain_column_name("scalar_GPS-Time"), "gpstime");
  EXPECT_EQ(plain_column_name("scalar"), "scalar");
  EXPECT_EQ(plain_column_name("//X"), "x");
}

TEST(ColumnNames, NamesOfOtherProgramsAreFound) {
  const Names pdal = {"X", "Y", "Z", "Intensity", "ReturnNumber"};
  EXPECT_EQ(find_column(pdal, "y"), 1u);
  EXPECT_EQ(find_column(pdal, "intensity"), 3u);
  EXPECT_EQ(find_column(pdal, "time"), std::nullopt);
  const Names cloud_compare = {"x", "y", "z", "scalar_Intensity", "scalar_time"};
  EXPECT_EQ(find_column(cloud_compare, "intensity"), 3u);
  EXPECT_EQ(find_column(cloud_compare, "time"), 4u);
  for (const char* name : {"i", "I", "intensities", "reflectivity", "Reflectance"}) {
    EXPECT_EQ(find_column(Names{"x", name}, "intensity"), 1u) << name;
  }
  for (const char* name : {"t", "time", "timestamp", "time_stamp", "TimeStamp", "offset_time",
                           "t_us", "timestamp_ns", "time (ms)", "timestamps"}) {
    EXPECT_EQ(find_column(Names{"x", name}, "time"), 1u) << name;
  }
  EXPECT_EQ(find_column(Names{"x", "Channel"}, "ring"), 1u);
}

TEST(ColumnNames, TheUsualNameComesFirst) {
  EXPECT_EQ(find_column(Names{"X", "x"}, "x"), 1u);
  EXPECT_EQ(find_column(Names{"reflectivity", "i", "intensity"}, "intensity"), 2u);
  EXPECT_EQ(find_column(Names{"time", "t"}, "time"), 1u);
  EXPECT_EQ(find_column(Names{"channel", "ring"}, "ring"), 1u);
}

TEST(ColumnNames, OtherColumnsAreNotTakenForIt) {
  for (const char* name : {"label", "times_seen", "intensity_std", "stream", "", "_"}) {
    EXPECT_EQ(find_column(Names{name}, "intensity"), std::nullopt) << name;
    EXPECT_EQ(find_column(Names{name}, "time"), std::nullopt) << name;
  }
}

}  // namespace fovea::column_names_test
