// fovea render and fovea reproduce, as a user meets them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "fovea/drive/images/image_decode.h"
#include "tests/kitti_writer.h"
#include "tests/program.h"

namespace fovea::pictures_program_test {

using testing::HasSubstr;

class Pictures : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    scratch_ = new TemporaryFolder;
    drive_ = write_kitti_drive(SyntheticDrive(street_scene(), 9, 0.8), scratch_->path());
    const ProgramRun run = run_fovea("map '" + drive_.string() + "' -o '" + map().string() + "'");
    ASSERT_EQ(run.exit_code, 0) << run.err;
  }
  static void TearDownTestSuite() { delete scratch_; }

  static std::filesystem::path map() { return *scratch_ / "map.fovea"; }
  ProgramRun render(const std::string& more) const {
    return run_fovea("render '" + map().string() + "' " + more + " -o '" + picture().string() +
                     "'");
  }
  std::filesystem::path picture() const { return own_ / "picture.png"; }

  static TemporaryFolder* scratch_;
  static std::filesystem::path drive_;
  TemporaryFolder own_;
};
TemporaryFolder* Pictures::scratch_ = nullptr;
std::filesystem::path Pictures::drive_;

TEST_F(Pictures, AViewHasTheSizeAskedForAndIsNotEmpty) {
  for (const char* view : {"--frame 2 --view driver", "--frame 2 --view behind",
                           "--frame 2 --view above", "--from=-3,0,4 --to=10,0,0"}) {
    const ProgramRun run = render(std::string("--force --width 320 --height 200 ") + view);
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const Image image = read_image(picture());
    EXPECT_EQ(image.width, 320);
    EXPECT_EQ(image.height, 200);
    const auto drawn = std::count_if(image.data.begin(), image.data.end(),
                                     [](std::uint8_t value) { return value > 0; });
    EXPECT_GT(drawn, 20'000) << view;
  }
}

TEST_F(Pictures, TheWholeMapIsInThePictureFromAbove) {
  ASSERT_EQ(render("--width 400 --height 400 --view map").exit_code, 0);
  const Image image = read_image(picture());
  const auto is_drawn = [&](int u, int v) {
    const std::uint8_t* pixel = image.pixel(u, v);
    return pixel[0] + pixel[1] + pixel[2] > 0;
  };
  int left = 400, right = 0, top = 400, bottom = 0;
  for (int v = 0; v < 400; ++v) {
    for (int u = 0; u < 400; ++u) {
      if (!is_drawn(u, v)) continue;
      left = std::min(left, u), right = std::max(right, u);
      top = std::min(top, v), bottom = std::max(bottom, v);
    }
  }
  EXPECT_GT(std::min({left, top, 399 - right, 399 - bottom}), 0);
  EXPECT_GT(std::max(right - left, bottom - top), 330);
}

// The synthetic camera sees what the map was coloured with: where the map is drawn, both agree.
TEST_F(Pictures, ACamerasPictureLooksLikeThePhotographBelowIt) {
  const ProgramRun run = render("'" + drive_.string() + "' --frame 4");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const Image image = read_image(picture());
  const int height = image.height / 2;
  double error = 0;
  int drawn = 0;
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < image.width; ++u) {
      const std::uint8_t* pixel = image.pixel(u, v);
      if (pixel[0] + pixel[1] + pixel[2] == 0) continue;
      ++drawn;
      for (int c = 0; c < 3; ++c) error += std::abs(pixel[c] - image.pixel(u, height + v)[c]) / 3.0;
    }
  }
  EXPECT_GT(drawn, 10'000);
  EXPECT_LT(error / drawn, 6);
}

TEST_F(Pictures, WrongRequestsAreOneLine) {
  const ProgramRun unknown = render("--frame 77");
  EXPECT_EQ(unknown.exit_code, 1);
  EXPECT_THAT(unknown.err, HasSubstr("frame 77 is not in the map"));
  EXPECT_FALSE(std::filesystem::exists(picture()));
  EXPECT_EQ(render("--view sideways").exit_code, 2);
  EXPECT_EQ(render("--from=1,2,3").exit_code, 2);
  EXPECT_EQ(render("--from=1,2,3 --to=1,2,3").exit_code, 2);
  EXPECT_THAT(render("--from=1,2 --to=1,2,3").err, HasSubstr("X,Y,Z"));
  ASSERT_EQ(render("").exit_code, 0);
  EXPECT_EQ(render("").exit_code, 1) << "an existing picture is not overwritten without --force";
}

TEST_F(Pictures, ReproduceWritesAPageAndGoesOnWhereItStopped) {
  const std::string command = "reproduce '" + drive_.string() + "' -o '" + (own_ / "out").string() +
                              "' --rows E0,default,no-refinement,tau-1 --quiet";
  const ProgramRun run = run_fovea(command);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const std::string page = read_text(own_ / "out/results.md");
  for (const char* section :
       {"## Held out", "## Table I", "## Table II", "## The four charts", "| E0 |", "## Ablations",
        "Each part switched off:", "| no-refinement |", "| tau-1 |"}) {
    EXPECT_THAT(page, HasSubstr(section));
  }
  const auto json = nlohmann::json::parse(read_text(own_ / "out/results.json"));
  EXPECT_EQ(json["drives"][0]["rows"].size(), 4u);
  EXPECT_EQ(json["drives"][0]["upsampling"].size(), 5u);
  EXPECT_GT(json["drives"][0]["rows"][0]["held_out"]["held_out"]["points"], 100);

  const std::string report = "report-" + drive_.filename().string() + ".html";
  EXPECT_THAT(page, HasSubstr("(" + report + ")"));
  EXPECT_THAT(read_text(own_ / "out" / report), HasSubstr("</html>"));

  // A row that stands there is taken as it is.
  const auto kept = own_ / ("out/rows-" + drive_.filename().string()) / "E0.json";
  auto row = nlohmann::ordered_json::parse(read_text(kept));
  row["held_out"]["held_out"]["te_mean"] = 123.25;
  std::ofstream(kept) << row.dump();
  ASSERT_EQ(run_fovea(command).exit_code, 0);
  EXPECT_THAT(read_text(own_ / "out/results.md"), HasSubstr("123.25"));
}

/// What upsampling_bench --json writes, with times that nobody measured.
nlohmann::json mls_times() {
  nlohmann::json json{{"drive", "d"}, {"runs", 5}, {"search_radius", 0.3}, {"polynomial_order", 1}};
  for (const int points : {10'000, 30'000, 90'000, 180'000, 450'000}) {
    nlohmann::json column{{"points", points}, {"rate", 1}};
    for (const int threads : {1, 2}) {
      for (const char* method : {"fovea", "local plane"}) {
        column["results"].push_back({{"method", method},
                                     {"threads", threads},
                                     {"given", points / 2},
                                     {"produced", points + 1},
                                     {"seconds", points * 1e-6 / threads},
                                     {"times_fovea", 2.5}});
      }
    }
    json["columns"].push_back(column);
  }
  return json;
}

TEST_F(Pictures, ReproduceShowsMeasuredTimesOfMovingLeastSquares) {
  const std::string file = (own_ / "mls.json").string();
  std::ofstream(file) << mls_times().dump();
  const std::string command = "reproduce '" + drive_.string() + "' -o '" + (own_ / "mls").string() +
                              "' --rows E0 --quiet --mls '" + file + "'";
  const ProgramRun run = run_fovea(command);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const std::string page = read_text(own_ / "mls/results.md");
  EXPECT_THAT(page,
              HasSubstr("| PCL's MLS, local plane, d | 10.0 | 30.0 | 90.0 | 180.0 | 450.0 |"));
  EXPECT_THAT(page, HasSubstr("| 5000, 10001, 2.5 |"));
  EXPECT_THAT(page, testing::Not(HasSubstr("MLS, fovea")));

  auto damaged = mls_times();
  damaged["columns"][3]["results"].clear();
  for (const std::string& text : {damaged.dump(), std::string("{}"), std::string("nothing")}) {
    std::ofstream(file) << text;
    const ProgramRun wrong = run_fovea(command);
    EXPECT_EQ(wrong.exit_code, 1) << text;
    EXPECT_THAT(wrong.err, HasSubstr("mls.json"));
    EXPECT_EQ(std::count(wrong.err.begin(), wrong.err.end(), '\n'), 1) << wrong.err;
  }
}

// Simulated drives all have the same folder inside; each must keep its own rows.
TEST_F(Pictures, ReproduceTellsDrivesOfOneNameApart) {
  const std::string drive = " '" + drive_.string() + "'";
  const ProgramRun run = run_fovea("reproduce" + drive + drive + " -o '" + (own_ / "two").string() +
                                   "' --rows E0 --quiet");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const auto drives = nlohmann::json::parse(read_text(own_ / "two/results.json"))["drives"];
  const std::string name = drive_.filename().string();
  EXPECT_EQ(drives[0]["name"], name);
  EXPECT_EQ(drives[1]["name"], name + "-2");
  EXPECT_TRUE(std::filesystem::exists(own_ / "two" / ("rows-" + name + "-2") / "E0.json"));
}

TEST_F(Pictures, ReproduceRefusesAFolderThatCannotBe) {
  std::ofstream(own_ / "file") << "x";
  const ProgramRun run = run_fovea("reproduce '" + drive_.string() + "' -o '" +
                                   (own_ / "file/out").string() + "' --rows E0");
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.err, HasSubstr("the folder cannot be made"));
}

}  // namespace fovea::pictures_program_test
