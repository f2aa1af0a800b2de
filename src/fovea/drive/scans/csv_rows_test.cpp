#include "fovea/drive/scans/csv_rows.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "../../../../tests/kitti_test_drive.h"
#include "fovea/errors.h"

namespace fovea::csv_rows_test {

using test::error_of;
using testing::ElementsAre;
using testing::HasSubstr;

class CsvRowsTest : public testing::Test {
 protected:
  CsvRows read(const std::string& content) const {
    test::write_text(folder_ / "a.csv", content);
    constexpr std::array<CsvColumn, 2> kColumns = {{{"x"}, {"extra", false}}};
    return read_csv(folder_ / "a.csv", kColumns);
  }
  TemporaryFolder folder_;
};

TEST_F(CsvRowsTest, ReadsColumnsByNameInAnyOrder) {
  const CsvRows rows = read(
      "# made by hand\n\nx, other ,time_ns\r\n1.5,a,1700000000123456789\r\n -2e1 , "
      ",2000000000000000000\n");
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_THAT(rows.times, ElementsAre(1'700'000'000'123'456'789, 2'000'000'000'000'000'000));
  EXPECT_EQ(rows.at(0, 0), 1.5);
  EXPECT_EQ(rows.at(1, 0), -20);
  EXPECT_TRUE(std::isnan(rows.at(0, 1)));
  EXPECT_THAT(rows.has, ElementsAre(true, false));
  EXPECT_THAT(rows.lines, ElementsAre(4, 5));
  EXPECT_TRUE(rows.malformed.empty());
}

TEST_F(CsvRowsTest, AByteOrderMarkIsNoPartOfTheFirstName) {
  const CsvRows rows = read("\xEF\xBB\xBFtime_ns,x\r\n5,1.5\r\n");
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_EQ(rows.at(0, 0), 1.5);
  EXPECT_EQ(read("\xEF\xBB\xBF# a comment\ntime_ns,x\n5,1.5\n").size(), 1u);
  const std::string utf16("\xFE\xFF\0t\0i\0m\0e", 10);
  EXPECT_THAT(error_of<InputError>([&] { read(utf16); }), HasSubstr("UTF-16"));
}

TEST_F(CsvRowsTest, EmptyCellsAreNotKnownAndInfinityIsANumber) {
  const CsvRows rows = read("time_ns,x,extra\n1,,inf\n2,nan,-inf\n");
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_TRUE(std::isnan(rows.at(0, 0)));
  EXPECT_EQ(rows.at(0, 1), std::numeric_limits<double>::infinity());
}

TEST_F(CsvRowsTest, LinesThatAreNoRowsAreListed) {
  const CsvRows rows = read(
      "time_ns,x\n1,2\n1.5,2\n-1,2\n9223372036854775807,2\n99999999999999999999,2\nx,2\n3\n3,2,1\n"
      "4,two\n5,1e999\n,1\n");
  EXPECT_THAT(rows.lines, ElementsAre(2));
  EXPECT_THAT(rows.malformed, ElementsAre(3, 4, 5, 6, 7, 8, 9, 10, 11, 12));
}

TEST_F(CsvRowsTest, TheFewestRowsOutOfOrderAreDropped) {
  CsvRows rows = read("time_ns,x\n1,10\n2,20\n900,30\n3,40\n3,50\n4,60\n");
  EXPECT_EQ(rows.drop_out_of_order(), 2u);
  EXPECT_THAT(rows.times, ElementsAre(1, 2, 3, 4));
  EXPECT_EQ(rows.at(3, 0), 60);
  EXPECT_EQ(rows.lines.back(), 7);
}

TEST_F(CsvRowsTest, TablesWithoutTheirColumnsAreErrors) {
  const auto error = [&](const std::string& content) {
    return error_of<InputError>([&] { read(content); });
  };
  EXPECT_THAT(error("\ntime_ns,y\n1,2\n"),
              testing::AllOf(HasSubstr("no column x"), HasSubstr("a.csv:2")));
  EXPECT_THAT(error("x\n2\n"), HasSubstr("no column time_ns"));
  EXPECT_THAT(error("time_ns,x,x\n"), HasSubstr("twice"));
  EXPECT_THAT(error(""), HasSubstr("the table is empty"));
  EXPECT_THAT(error("# nothing\n"), HasSubstr("the table is empty"));
}

}  // namespace fovea::csv_rows_test
