#include "fovea/pipeline/settings_listing.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "fovea/pipeline/config.h"

namespace fovea::settings_listing_test {

std::string content_of(const std::string& file) {
  std::ifstream stream(std::filesystem::path(FOVEA_SOURCE_DIR) / file);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

TEST(SettingsListing, IsThatOfTheRepository) {
  const char* remedy = "run scripts/write_settings.sh";
  EXPECT_EQ(content_of("config/default.toml"), settings_listing(MapperKind::kDefault)) << remedy;
  EXPECT_EQ(content_of("docs/settings.md"), settings_page()) << remedy;
}

TEST(SettingsListing, IsNotLong) {
  MapSettings settings = default_settings(MapperKind::kDefault);
  EXPECT_LE(settings_rows(settings).size(), 30u);
  MapSettings paper = default_settings(MapperKind::kPaper);
  constexpr std::size_t kOfBothMappers = 3;
  EXPECT_LE(settings_rows(paper).size(), 15u + kOfBothMappers);
}

/// A unit stands at the end of the name of each length, angle and duration.
TEST(SettingsListing, SaysOneSentenceOfEachKey) {
  for (const MapperKind mapper : {MapperKind::kDefault, MapperKind::kPaper}) {
    MapSettings settings = default_settings(mapper);
    for (const Setting& row : settings_rows(settings)) {
      EXPECT_THAT(row.text(), testing::EndsWith(".")) << row.key();
      EXPECT_FALSE(row.allowed().empty()) << row.key();
      std::istringstream words(row.text());
      const auto count = std::distance(std::istream_iterator<std::string>(words), {});
      EXPECT_LE(count, 25) << row.key();
    }
  }
}

}  // namespace fovea::settings_listing_test
