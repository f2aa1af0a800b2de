#include "fovea/core/settings_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <sstream>

#include "fovea/core/angle.h"
#include "fovea/errors.h"

namespace fovea::settings_table_test {

using ::testing::AllOf;
using ::testing::HasSubstr;

enum class Shade { kDark, kLight };
constexpr auto names_of(Shade) {
  return std::array{EnumName<Shade>{Shade::kDark, std::string_view("dark")},
                    EnumName<Shade>{Shade::kLight, std::string_view("light")}};
}

struct Options {
  bool on = false;
  int window = 0;
  double near_m = 0, far_m = 0, angle = 0;
  Shade shade = Shade::kDark;
};

SettingsTable table_of(Options& o) {
  return {
      {"a.on", o.on, true, "Switches it on."},
      {"a.window_px", o.window, 5, odd_between(3, 9), "Edge of the window."},
      {"a.near_m", o.near_m, 2, zero_or(1, 10), "Begin of the zone."},
      Setting{"a.far_m", o.far_m, 4.5, above(0, 10), "End of the zone."}.with_rule(
          "more than a.near_m", [&o] { return o.far_m > o.near_m; }),
      {"b.angle_deg", Degrees{o.angle}, 70, between(0, 90), "Largest angle."},
      {"b.shade", o.shade, Shade::kLight, "Shade of the picture."},
  };
}

Options defaults() {
  Options options;
  for (const Setting& row : table_of(options)) row.reset();
  return options;
}

std::string error_of(std::string_view text) {
  Options options = defaults();
  const SettingsTable table = table_of(options);
  try {
    SettingsDocument::from_text(text, "x.toml")
        .apply([&](SettingVisitor& visitor) { visit_rows(table, visitor); },
               [&] { validate_rows(table); }, "look there");
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "";
}

TEST(SettingsTable, RowsHoldTheDefaults) {
  const Options options = defaults();
  EXPECT_TRUE(options.on);
  EXPECT_EQ(options.window, 5);
  EXPECT_EQ(options.near_m, 2);
  EXPECT_EQ(options.far_m, 4.5);
  EXPECT_DOUBLE_EQ(options.angle, 70 * kDegree);
  EXPECT_EQ(options.shade, Shade::kLight);
}

TEST(SettingsTable, AcceptsTheValuesOfItsRanges) {
  for (const char* text :
       {"a.window_px = 3", "a.window_px = 9", "a.near_m = 0", "a.near_m = 1", "a.far_m = 10",
        "b.angle_deg = 0", "b.angle_deg = 90", "b.shade = 'dark'", "a.on = false"}) {
    EXPECT_EQ(error_of(text), "") << text;
  }
}

TEST(SettingsTable, ErrorsNamePlaceKeyAndAllowedValues) {
  EXPECT_THAT(error_of("\na.window_px = 4"), AllOf(HasSubstr("x.toml:2"), HasSubstr("a.window_px"),
                                                   HasSubstr("an odd number, 3 to 9")));
  EXPECT_THAT(error_of("a.window_px = 11"), HasSubstr("an odd number, 3 to 9"));
  EXPECT_THAT(error_of("a.near_m = 0.5"), HasSubstr("0, or 1 to 10"));
  EXPECT_THAT(error_of("a.near_m = nan"), HasSubstr("a.near_m"));
  EXPECT_THAT(error_of("a.far_m = 0"), HasSubstr("above 0, up to 10"));
  EXPECT_THAT(error_of("a.far_m = 11"), HasSubstr("above 0, up to 10"));
  EXPECT_THAT(error_of("b.angle_deg = 90.1"),
              AllOf(HasSubstr("b.angle_deg"), HasSubstr("0 to 90")));
  EXPECT_THAT(error_of("b.shade = 'gray'"), HasSubstr("'light'"));
  EXPECT_THAT(error_of("b.tint = 1"), AllOf(HasSubstr("unknown key"), HasSubstr("look there")));
}

TEST(SettingsTable, ARuleMayConcernTwoOptions) {
  EXPECT_EQ(error_of("a.near_m = 3\na.far_m = 3.5"), "");
  EXPECT_THAT(error_of("a.near_m = 5"),
              AllOf(HasSubstr("a.far_m"), HasSubstr("more than a.near_m")));
}

TEST(SettingsTable, ListsItsRowsInTomlAndMarkdown) {
  Options options = defaults();
  SettingsTable table = table_of(options);
  table.resize(2, table.front());
  table.emplace_back(
      "b.extra_1", "numbers", [](SettingVisitor&) {}, [] {}, [] { return std::string(); },
      "Only where it is needed.");
  EXPECT_EQ(commented_toml(table),
            "[a]\n# Switches it on. (true or false)\non = true\n\n"
            "# Edge of the window. (an odd number, 3 to 9)\nwindow_px = 5\n\n"
            "[b]\n# Only where it is needed. (numbers)\n# extra_1 = [...]\n");
  EXPECT_EQ(markdown_list(table),
            "- `a.on = true` (true or false): Switches it on.\n"
            "- `a.window_px = 5` (an odd number, 3 to 9): Edge of the window.\n"
            "- `b.extra_1` (numbers): Only where it is needed.\n");
}

TEST(SettingsTable, LongSentencesFillSeveralLines) {
  Options options;
  std::string sentence = "word";
  for (int i = 0; i < 40; ++i) sentence += " word";
  const SettingsTable table{{"a.on", options.on, true, sentence}};
  for (const std::string& text : {commented_toml(table), markdown_list(table)}) {
    std::istringstream lines(text);
    std::size_t words = 0;
    for (std::string line; std::getline(lines, line);) {
      EXPECT_LE(line.size(), 120u);
      for (std::size_t at = 0; (at = line.find("word", at)) != std::string::npos; ++at) ++words;
    }
    EXPECT_EQ(words, 41u) << text;
  }
}

TEST(SettingsTable, TheListingReadsBack) {
  Options options = defaults();
  EXPECT_EQ(error_of(commented_toml(table_of(options))), "");
}

}  // namespace fovea::settings_table_test
