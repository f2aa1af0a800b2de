#include "app/html_report/charts.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <pugixml.hpp>
#include <stdexcept>

namespace fovea::app::charts_test {

using testing::HasSubstr;

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

pugi::xml_document parsed(const std::string& svg) {
  pugi::xml_document document;
  const auto result = document.load_string(("<div>" + svg + "</div>").c_str());
  EXPECT_TRUE(result) << result.description() << "\n" << svg;
  return document;
}

std::vector<pugi::xml_node> elements(const pugi::xml_document& document, const char* path) {
  std::vector<pugi::xml_node> nodes;
  for (const auto& found : document.select_nodes(path)) nodes.push_back(found.node());
  return nodes;
}

Chart two_series() {
  Chart chart;
  chart.title = "a < b";
  chart.x_label = chart.x_name = "frame";
  chart.y_label = "ms";
  chart.x = {4, 12, 20, 28};
  chart.series = {{"one", {1, 2, kNone, 4}}, {"two & three", {2, 2, 2, 2}}};
  return chart;
}

TEST(RoundStep, IsRoundAndLargeEnough) {
  EXPECT_DOUBLE_EQ(round_step(10, 5), 2);
  EXPECT_DOUBLE_EQ(round_step(11, 5), 5);
  EXPECT_DOUBLE_EQ(round_step(26, 5), 10);
  EXPECT_DOUBLE_EQ(round_step(0.004, 5), 0.001);
  EXPECT_DOUBLE_EQ(round_step(0, 5), 1);
  EXPECT_DOUBLE_EQ(round_step(kNone, 5), 1);
}

TEST(LineChart, MarksStandWhereTheValuesAre) {
  const auto document = parsed(line_chart(two_series()));
  const auto marks = elements(document, "//circle[contains(@class, 's0')]");
  ASSERT_EQ(marks.size(), 3u) << "no mark where there is no value";
  const auto x = [&](std::size_t i) { return marks[i].attribute("cx").as_double(); };
  const auto y = [&](std::size_t i) { return marks[i].attribute("cy").as_double(); };
  EXPECT_NEAR((x(2) - x(0)) / (x(1) - x(0)), 3.0, 0.01);  // 4 -> 28 and 4 -> 12
  EXPECT_NEAR((y(2) - y(0)) / (y(1) - y(0)), 3.0, 0.01);  // 1 -> 4 and 1 -> 2
  EXPECT_LT(y(2), y(0)) << "higher values stand higher";
}

TEST(LineChart, ABreakInTheLineWhereAValueIsMissing) {
  const auto document = parsed(line_chart(two_series()));
  const std::string path =
      elements(document, "//path[contains(@class, 's0')]").at(0).attribute("d").value();
  EXPECT_EQ(std::count(path.begin(), path.end(), 'M'), 2);
  EXPECT_EQ(std::count(path.begin(), path.end(), 'L'), 1);
}

TEST(LineChart, NamesOfSeriesAndHints) {
  const auto document = parsed(line_chart(two_series()));
  EXPECT_EQ(elements(document, "//ul[@class='legend']/li").size(), 2u);
  EXPECT_STREQ(elements(document, "//svg").at(0).attribute("aria-label").value(), "a < b");
  const auto hints = elements(document, "//rect[@class='hint']/title");
  ASSERT_EQ(hints.size(), 4u);
  EXPECT_THAT(hints[2].text().get(), HasSubstr("frame 20"));
  EXPECT_THAT(hints[2].text().get(), Not(HasSubstr("one")));
}

TEST(LineChart, OneFrameAndNone) {
  Chart chart = two_series();
  chart.x = {7};
  chart.series = {{"one", {3}}};
  EXPECT_EQ(elements(parsed(line_chart(chart)), "//circle").size(), 1u);
  chart.series[0].values = {kNone};
  EXPECT_EQ(line_chart(chart), "");
  chart.series[0].values = {1, 2};
  EXPECT_THROW(line_chart(chart), std::invalid_argument);
  chart.x.clear();
  chart.series.clear();
  EXPECT_EQ(line_chart(chart), "");
  EXPECT_EQ(stacked_chart(chart), "");
}

TEST(LineChart, AChartOfZerosHasAnAxis) {
  Chart chart = two_series();
  chart.series = {{"one", {0, 0, 0, 0}}};
  const std::string svg = line_chart(chart);
  parsed(svg);
  EXPECT_THAT(svg, Not(HasSubstr("nan")));
}

// The upper edge of the last area is the sum of all.
TEST(StackedChart, AreasStandOnEachOther) {
  Chart chart = two_series();
  chart.line_at = 6;
  chart.line_name = "limit";
  const auto document = parsed(stacked_chart(chart));
  const auto areas = elements(document, "//path[contains(@class, 'area')]");
  ASSERT_EQ(areas.size(), 2u);
  const auto y_of = [&](int area, const char* move) {  // of the first point after `move`
    const std::string d = areas[area].attribute("d").value();
    const std::string from = d.substr(d.find(move) + 1);
    return std::stod(from.substr(from.find(' ') + 1));
  };
  const double limit =
      elements(document, "//line[@class='level']").at(0).attribute("y1").as_double();
  const double zero = elements(document, "//line[@class='axis']").at(0).attribute("y1").as_double();
  EXPECT_NEAR((zero - y_of(0, "M")) / (zero - limit), 1 / 6.0, 0.01);
  EXPECT_NEAR((zero - y_of(1, "M")) / (zero - limit), 3 / 6.0, 0.01);
  EXPECT_THAT(elements(document, "//rect[@class='hint']/title").at(3).text().get(),
              HasSubstr("all: 6"));
}

TEST(HistogramChart, BarsAreShares) {
  Histogram histogram{"h", "TE", {50, 30, 19, 0, 0, 0, 1}, 4, 5, 4.5};
  const auto document = parsed(histogram_chart(histogram));
  const auto bars = elements(document, "//rect[contains(@class, 'bar')]");
  ASSERT_EQ(bars.size(), 4u) << "three below 99%, the rest as one";
  const auto height = [&](std::size_t i) { return bars[i].attribute("height").as_double(); };
  EXPECT_NEAR(height(1) / height(0), 30 / 50.0, 0.01);
  EXPECT_NEAR(height(3) / height(0), 1 / 50.0, 0.02);
  EXPECT_STREQ(bars[1].child("title").text().get(), "4 to 8: 30.00%");
  EXPECT_STREQ(bars[3].child("title").text().get(), "12 and more: 1.00%");
}

TEST(HistogramChart, NothingAndOneBin) {
  EXPECT_EQ(histogram_chart({"h", "TE", {}, 4, kNone, kNone}), "");
  EXPECT_EQ(histogram_chart({"h", "TE", {0, 0}, 4, kNone, kNone}), "");
  const auto document = parsed(histogram_chart({"h", "TE", {5}, 4, 1, 1}));
  EXPECT_EQ(elements(document, "//rect[contains(@class, 'bar')]").size(), 1u);
}

}  // namespace fovea::app::charts_test
