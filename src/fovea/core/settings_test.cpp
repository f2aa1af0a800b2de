#include "fovea/core/settings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "../../../tests/temporary_folder.h"
#include "fovea/core/angle.h"
#include "fovea/errors.h"

namespace fovea::settings_test {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

enum class Shade { kDark, kLight };
constexpr auto names_of(Shade) {
  return std::array{EnumName<Shade>{Shade::kDark, std::string_view("dark")},
                    EnumName<Shade>{Shade::kLight, std::string_view("light")}};
}

/// `part`, `count` times.
std::string repeated(const std::string& part, int count) {
  std::string text;
  for (int i = 0; i < count; ++i) text += part;
  return text;
}

struct Options {
  bool on = true;
  int count = 3;
  double length = 2;
  double angle = 70 * kDegree;
  std::vector<int> numbers = {2, 3};
  std::vector<std::array<double, 4>> rows;
  Shade shade = Shade::kLight;
  std::optional<double> extra;
  std::string text = "as is";
  std::vector<double> lengths = {1};
};

void visit_options(SettingVisitor& visit, Options& o) {
  visit("a.on", o.on);
  visit("a.count", o.count);
  visit("a.length", o.length);
  visit("b.angle", Degrees{o.angle});
  visit("b.numbers", o.numbers);
  visit("b.rows", DegreeRows{o.rows, "[p, q, r, s]"});
  visit("b.shade", o.shade);
  visit("b.extra", o.extra);
  visit("c.text", o.text);
  visit("c.lengths", o.lengths);
}

void read(std::string_view text, Options& options) {
  SettingsDocument::from_text(text, "x.toml")
      .apply([&](SettingVisitor& visit) { visit_options(visit, options); },
             [&] {
               if (options.count < 0) throw ConfigError("a count is negative", "a.count", "add");
             },
             "look there");
}

std::string text_of(Options options) {
  return settings_text([&](SettingVisitor& visit) { visit_options(visit, options); });
}

std::string error_of(std::string_view text) {
  try {
    Options options;
    read(text, options);
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "no ConfigError";
}

TEST(Settings, ArePrintedByTable) {
  EXPECT_EQ(text_of({}),
            "[a]\non = true\ncount = 3\nlength = 2.0\n\n[b]\nangle = 70.0\nnumbers = [2, 3]\n"
            "rows = []\nshade = \"light\"\n\n[c]\ntext = 'as is'\nlengths = [1.0]\n");
}

TEST(Settings, KeysOfADocumentKeepTheirOrder) {
  const auto entries =
      SettingsDocument::from_text("mapper = 'x'\n[b]\nz = [1, [2.5]]\na = true\n[a.c]\nq = 1", "x")
          .entries();
  std::string text;
  for (const auto& [key, value] : entries) text += key + " is " + value + "; ";
  EXPECT_EQ(text, "mapper is 'x'; b.z is [1, [2.5]]; b.a is true; a.c.q is 1; ");
}

TEST(Settings, AKeyWithoutATableComesFirst) {
  const std::vector<SettingText> settings = {{"mapper", "'x'"}, {"a.b", "1"}, {"a.c", "2"}};
  EXPECT_EQ(toml_of(settings), "mapper = 'x'\n\n[a]\nb = 1\nc = 2\n");
}

TEST(Settings, AnUnknownKeyCanHaveAnErrorOfItsOwn) {
  Options options;
  try {
    SettingsDocument::from_text("a.count = 1\na.old = 2", "x.toml")
        .apply([&](SettingVisitor& visit) { visit_options(visit, options); }, [] {}, "look there",
               [](std::string_view key) { throw ConfigError("an old key", key, "write a.new"); });
    FAIL();
  } catch (const ConfigError& error) {
    EXPECT_STREQ(error.what(), "an old key, x.toml:2, key 'a.old', write a.new");
  }
}

TEST(Settings, AnglesTooSmallForTheirDigitsAreZero) {
  Options options;
  read("b.angle = 1e-310\nb.rows = [[-1e-310, 0, 0, 0]]", options);
  EXPECT_EQ(options.angle, 0);
  EXPECT_THAT(text_of(options), HasSubstr("angle = 0.0"));
  Options back;
  read(text_of(options), back);
  EXPECT_EQ(back.rows, options.rows);
}

TEST(Settings, ReadBackTheSame) {
  Options options{false, -0, 1e-7, 33.3 * kDegree, {5}, {}, Shade::kDark, 1.5};
  options.rows = {{1 * kDegree, 2 * kDegree, 3 * kDegree, -4.5 * kDegree}};
  Options back;
  read(text_of(options), back);
  EXPECT_EQ(back.on, false);
  EXPECT_EQ(back.count, 0);
  EXPECT_EQ(back.length, 1e-7);
  EXPECT_EQ(back.angle, options.angle);
  EXPECT_THAT(back.numbers, ElementsAre(5));
  EXPECT_EQ(back.rows, options.rows);
  EXPECT_EQ(back.shade, Shade::kDark);
  EXPECT_EQ(back.extra, 1.5);
}

TEST(Settings, WhatIsNotGivenStays) {
  Options options;
  read("b.shade = 'dark'", options);
  EXPECT_EQ(options.shade, Shade::kDark);
  EXPECT_EQ(options.count, 3);
  EXPECT_FALSE(options.extra);
}

TEST(Settings, ErrorsNameFileLineAndKey) {
  EXPECT_THAT(error_of("\n[a]\ncuont = 1"),
              AllOf(HasSubstr("unknown key"), HasSubstr("x.toml:3, key 'a.cuont'"),
                    HasSubstr("remove it, or look there")));
  EXPECT_THAT(error_of("[a]\ncount = -1"),
              AllOf(HasSubstr("negative"), HasSubstr("x.toml:2, key 'a.count'")));
  EXPECT_THAT(error_of("[b]\nnumbers = [1, 2.5]"), HasSubstr("give a whole number"));
  EXPECT_THAT(error_of("[b]\nnumbers = 7"), HasSubstr("give an array of whole numbers"));
  EXPECT_THAT(error_of("[b]\nrows = [[1, 2]]"), HasSubstr("an array of [p, q, r, s] in degrees"));
  EXPECT_THAT(error_of("[b]\nshade = 'grey'"), HasSubstr("give one of 'dark', 'light'"));
  EXPECT_THAT(error_of("[b]\nextra = 'much'"), HasSubstr("give a number"));
  EXPECT_THAT(error_of("[c]\ntext = 7"), HasSubstr("give a text in quotes"));
  EXPECT_THAT(error_of("[c]\nlengths = [1, 'x']"), HasSubstr("give a number"));
  EXPECT_THAT(error_of("[b"), HasSubstr("x.toml:1"));
}

TEST(Settings, WhatIsRejectedForWantOfAnyTableNamesTheFile) {
  const auto document = SettingsDocument::from_text("[a]\non = true", "x.toml");
  Options options;
  const auto reject = [&](const char* key) -> std::string {
    try {
      document.apply([&](SettingVisitor& visit) { visit_options(visit, options); },
                     [&] { throw ConfigError("a key is missing", key, "add it"); }, "");
    } catch (const ConfigError& error) {
      return error.where();
    }
    return "nothing was rejected";
  };
  EXPECT_EQ(reject("version"), "x.toml, key 'version'");
  EXPECT_EQ(reject("d.length"), "x.toml, key 'd.length'");
}

TEST(Settings, AByteOrderMarkIsNoPartOfAFile) {
  const TemporaryFolder folder;
  const auto read_text = [&](std::string_view text) {
    std::ofstream(folder / "x.toml", std::ios::binary) << text;
    Options options;
    SettingsDocument::from_file(folder / "x.toml")
        .apply([&](SettingVisitor& visit) { visit_options(visit, options); }, [] {}, "");
    return options.count;
  };
  EXPECT_EQ(read_text("\xEF\xBB\xBF[a]\r\ncount = 7\r\n"), 7);
  try {
    read_text(std::string_view("\xFF\xFE[\0a\0", 6));
    FAIL() << "UTF-16 was read";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("UTF-16"), HasSubstr("x.toml")));
  }
}

TEST(Settings, NumbersInRowsAndTextsComeBackFromWhatIsWritten) {
  Options options;
  read("[c]\ntext = 'a \"b\" \\c'\nlengths = [[1, 2.5], [3]]", options);
  EXPECT_EQ(options.text, "a \"b\" \\c");
  EXPECT_THAT(options.lengths, ElementsAre(1, 2.5, 3));
  Options back;
  read(settings_text([&](SettingVisitor& visit) { visit_options(visit, options); }), back);
  EXPECT_EQ(back.text, options.text);
  EXPECT_EQ(back.lengths, options.lengths);
}

TEST(Settings, TheTablesBelowAKeyAreListed) {
  const auto tables = [](std::string_view text) {
    return SettingsDocument::from_text(text, "x.toml").tables("t");
  };
  EXPECT_THAT(tables("[t.two]\na = 1\n[t.1-a_]\n[u.b]"), ElementsAre("1-a_", "two"));
  EXPECT_TRUE(tables("[u.b]").empty());
  const auto error = [&](std::string_view text) -> std::string {
    try {
      tables(text);
    } catch (const ConfigError& e) {
      return e.what();
    }
    return "none";
  };
  EXPECT_THAT(error("t = 3"), HasSubstr("x.toml:1, key 't'"));
  EXPECT_THAT(error("[t]\na = 3"), HasSubstr("'a' is no table"));
  EXPECT_THAT(error("[[t]]\na = 3"), HasSubstr("is no table"));
  EXPECT_THAT(error("[t.'a.b']"), HasSubstr("rename it"));
}

TEST(Settings, TablesMayStandAmongKeys) {
  const auto document = SettingsDocument::from_text("[t]\na = 1\n[t.two]\nb = 2", "x.toml");
  EXPECT_THAT(document.tables("t", /*among_keys=*/true), ElementsAre("two"));
  EXPECT_TRUE(document.tables("u", /*among_keys=*/true).empty());
}

TEST(Settings, WhatIsRejectedForWantOfAKeyNamesTheTable) {
  const auto document = SettingsDocument::from_text("\n[a]\non = true", "x.toml");
  Options options;
  try {
    document.apply([&](SettingVisitor& visit) { visit_options(visit, options); },
                   [] { throw ConfigError("a key is missing", "a.count", "add it"); }, "");
    FAIL() << "nothing was rejected";
  } catch (const ConfigError& error) {
    EXPECT_THAT(error.what(), HasSubstr("x.toml:2, key 'a.count'"));
  }
}

TEST(Settings, ATextOfThousandsOfLevelsIsRefused) {
  const auto deep = HasSubstr("over 32 levels deep, x.toml");
  EXPECT_THAT(error_of(repeated("a.", 50'000) + "a = 1"), deep);
  EXPECT_THAT(error_of("[" + repeated("a.", 50'000) + "a]"), deep);
  EXPECT_THAT(error_of("a = " + repeated("[", 50'000)), deep);
  EXPECT_THAT(error_of(repeated("a = {", 50'000)), deep);
  EXPECT_THAT(error_of(repeated("a.b = { c = ", 20'000)), deep);
  EXPECT_THROW(SettingsDocument::from_assignment(repeated("a.", 50'000) + "a=1", ""), ConfigError);
}

}  // namespace fovea::settings_test
