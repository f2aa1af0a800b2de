#include "fovea/pipeline/point_counts.h"

#include <gtest/gtest.h>

namespace fovea::point_counts_test {

TEST(PointCounts, RecordsKeepTheReasons) {
  PointCounts counts;
  for (const DroppedPoints& dropped : {DroppedPoints{1, 2, 3, 4}, DroppedPoints{10, 20, 30, 40}}) {
    FrameRecord record;
    count_points({445, dropped}, record.figures);
    EXPECT_EQ(record.figures.at("points_scan"), 445);
    EXPECT_EQ(record.figures.at("points_dropped"), double(dropped.total()));
    counts.add(record);
  }
  EXPECT_EQ(counts.used(), 890u);
  EXPECT_EQ(counts.dropped(), (DroppedPoints{11, 22, 33, 44}));
  EXPECT_EQ(counts.note(),
            "110 of 1000 points of the scans are dropped (11 %): 22 not finite, 33 beyond 1 km, 44 "
            "over 1 s off the stamp, 11 without a return");
}

TEST(PointCounts, ScansWithoutDroppedPointsHaveTheUsualFigures) {
  FrameRecord record;
  count_points({10, {}}, record.figures);
  EXPECT_EQ(record.figures.size(), 2u);
  PointCounts counts;
  counts.add(record);
  counts.add({});  // a skipped frame
  EXPECT_EQ(counts.note(), "");
}

}  // namespace fovea::point_counts_test
