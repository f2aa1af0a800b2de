#include "app/html_report/view_section.h"

#include <gtest/gtest.h>

#include "app/html_report/color_classes.h"

namespace fovea::app::view_section_test {

EvaluationReport report_of(const std::vector<double>& te) {
  EvaluationReport report;
  for (std::size_t i = 0; i < te.size(); ++i) {
    ViewReport view;
    view.frame = static_cast<int>(4 + 8 * i);
    view.camera = 2;
    view.figures.points = te[i] < 0 ? 0 : 10;
    view.figures.te_mean = te[i];
    report.views.push_back(view);
  }
  return report;
}

std::vector<int> frames(const std::vector<const ViewReport*>& views) {
  std::vector<int> frames;
  for (const ViewReport* view : views) frames.push_back(view->frame);
  return frames;
}

TEST(ChooseViews, TheWorstFirstThenTheOthersInOrder) {
  EXPECT_EQ(frames(choose_views(report_of({5, 9, 7, -1, 8}))), (std::vector{12, 4, 20, 36}));
  EXPECT_TRUE(choose_views(report_of({-1})).empty());
  EXPECT_TRUE(choose_views(EvaluationReport()).empty());
}

TEST(ChooseViews, SpreadsEvenlyWhereThereAreTooMany) {
  std::vector<double> te(41, 3);
  te[20] = 50;
  EXPECT_EQ(frames(choose_views(report_of(te), 5)), (std::vector{164, 4, 108, 220, 324}));
  EXPECT_EQ(choose_views(report_of(te), 1).size(), 1u);
  EXPECT_EQ(choose_views(report_of(te), 2).size(), 2u);
  EXPECT_EQ(choose_views(report_of(te)).size(), kMaxViews);
}

TEST(EvenlySpread, HasTheFirstAndTheLast) {
  using Places = std::vector<std::size_t>;
  EXPECT_EQ(evenly_spread(9, 3), (Places{0, 4, 8}));
  EXPECT_EQ(evenly_spread(3, 9), (Places{0, 1, 2}));
  EXPECT_EQ(evenly_spread(9, 1), (Places{0}));
  EXPECT_EQ(evenly_spread(9, 0), Places{});
  EXPECT_EQ(evenly_spread(0, 3), Places{});
}

TEST(ErrorScale, ClassesAreHalfOpen) {
  EXPECT_EQ(kTeScale.class_of(0), 0u);
  EXPECT_EQ(kTeScale.class_of(4.99), 0u);
  EXPECT_EQ(kTeScale.class_of(5), 1u);
  EXPECT_EQ(kTeScale.class_of(79.9), 4u);
  EXPECT_EQ(kTeScale.class_of(441), 5u);
}

// Dots are relative to each other: adding up the moves must lead back to the pixels.
TEST(HeatPaths, DotsLieOnTheirPixels) {
  const std::vector<Eigen::Vector2d> pixels{{10.4, 20.6}, {700, 100}, {3, 4}, {50, 60}};
  const std::string svg = heat_paths(pixels, {1, 200, 4, 12}, kTeScale);
  EXPECT_EQ(svg,
            "<path class=\"h0\" d=\"m10 21h0m-7 -17h0\"/>\n"
            "<path class=\"h2\" d=\"m50 60h0\"/>\n"
            "<path class=\"h5\" d=\"m700 100h0\"/>\n");
}

}  // namespace fovea::app::view_section_test
