#include "fovea/pipeline/drive_catalog.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "fovea/pipeline/map_drive_test_support.h"

namespace fovea::drive_catalog_test {

TEST(DriveCatalog, StatesWhereADriveGoes) {
  BrokenDrive drive;  // 8 frames, 0.8 m apart
  drive.editable_info().origin = GeodeticPoint{49, 8, 100};
  drive.editable_info().navigation_accuracy = {0, 0.3, 0.5, 0.4, HUGE_VAL};
  drive.editable_info().coordinates.epoch_year = 2020.5;
  const DriveCatalog catalog = catalog_of(drive);
  EXPECT_EQ(catalog.frames, 8u);
  EXPECT_NEAR(catalog.length, 7 * 0.8, 0.01);
  EXPECT_NEAR(catalog.duration, 0.7, 1e-6);
  EXPECT_EQ(catalog.accuracy, 0.4);
  ASSERT_EQ(catalog.places.size(), 2u);  // the first, and the last one, 5.6 m on
  EXPECT_EQ(catalog.places.front().frame, 0);
  EXPECT_NEAR(catalog.places.front().position.latitude, 49, 1e-4);

  const auto json = nlohmann::json::parse(to_json(catalog));
  EXPECT_EQ(json.at("fovea_catalog"), 1);
  EXPECT_EQ(json.at("georeferenced"), true);
  EXPECT_EQ(json.at("epoch_year"), 2020.5);
  EXPECT_TRUE(json.at("datum").is_null());
  EXPECT_TRUE(json.at("height_type").is_null());
  EXPECT_EQ(json.at("places").size(), 2u);
}

TEST(DriveCatalog, ADriveWithoutGeoreferenceHasNoPlaces) {
  BrokenDrive drive;
  drive.editable_info().origin.reset();
  const auto json = nlohmann::json::parse(to_json(catalog_of(drive)));
  EXPECT_EQ(json.at("georeferenced"), false);
  EXPECT_TRUE(json.at("places").empty());
  EXPECT_NEAR(json.at("length_m").get<double>(), 7 * 0.8, 0.01);
}

}  // namespace fovea::drive_catalog_test
