// fovea evaluate --html, as a user meets it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>
#include <pugixml.hpp>
#include <set>

#include "fovea/drive/images/image_decode.h"
#include "tests/program.h"

namespace fovea::html_report_program_test {

using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

constexpr int kWidth = 320, kHeight = 110;

std::vector<std::uint8_t> decoded(std::string_view base64) {
  constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::vector<std::uint8_t> bytes;
  std::uint32_t bits = 0;
  int held = 0;
  for (const char c : base64) {
    if (c == '=') break;
    const std::size_t digit = kDigits.find(c);
    EXPECT_NE(digit, std::string_view::npos) << "no base64 digit";
    bits = bits << 6 | static_cast<std::uint32_t>(digit);
    held += 6;
    if (held >= 8) bytes.push_back(static_cast<std::uint8_t>(bits >> (held -= 8)));
  }
  return bytes;
}

class HtmlReport : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    scratch_ = new TemporaryFolder;
    ASSERT_EQ(run_fovea("simulate -o '" + drive() +
                        "' --frames 14 --quiet --set camera.width=320 --set camera.height=110"
                        " --set camera.focal=190 --set camera.cx=159.5 --set camera.cy=54.5"
                        " --set lidar.columns=900")
                  .exit_code,
              0);
    const ProgramRun run =
        run_fovea("map '" + drive() + "' -o '" + map() + "' --hold-out 4:2 --quiet");
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const ProgramRun evaluated = run_fovea("evaluate '" + map() + "' '" + drive() + "' --html '" +
                                           page_file() + "' --json '" + json_file() + "'");
    ASSERT_EQ(evaluated.exit_code, 0) << evaluated.err;
    page_ = new pugi::xml_document;
    // Strict XML: every tag closed, every attribute quoted.
    const auto parsed = page_->load_file(page_file().c_str());
    ASSERT_TRUE(parsed) << parsed.description();
  }
  static void TearDownTestSuite() {
    delete page_;
    delete scratch_;
  }

  static std::string drive() { return (*scratch_ / "drive").string(); }
  static std::string map() { return (*scratch_ / "map.fovea").string(); }
  static std::string page_file() { return (*scratch_ / "page.html").string(); }
  static std::string json_file() { return (*scratch_ / "figures.json").string(); }
  static std::vector<pugi::xml_node> select(const char* path) {
    std::vector<pugi::xml_node> nodes;
    for (const auto& found : page_->select_nodes(path)) nodes.push_back(found.node());
    return nodes;
  }
  /// The picture of an <img>.
  Image picture(const pugi::xml_node& img) const {
    const std::string uri = img.attribute("src").value();
    const std::size_t comma = uri.find(",");
    EXPECT_THAT(uri.substr(0, comma),
                testing::AnyOf("data:image/jpeg;base64", "data:image/png;base64"));
    const std::vector<std::uint8_t> bytes = decoded(std::string_view(uri).substr(comma + 1));
    const auto file = own_ / "picture";
    std::ofstream(file, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
    return read_image(file);
  }

  static TemporaryFolder* scratch_;
  static pugi::xml_document* page_;
  TemporaryFolder own_;
};
TemporaryFolder* HtmlReport::scratch_ = nullptr;
pugi::xml_document* HtmlReport::page_ = nullptr;

TEST_F(HtmlReport, NeedsNothingElse) {
  const std::string text = read_text(page_file());
  EXPECT_THAT(text, AllOf(Not(HasSubstr("http://")), Not(HasSubstr("https://")),
                          Not(HasSubstr("url(")), Not(HasSubstr("@import"))));
  for (const auto& node : select("//*[@src]")) {
    EXPECT_EQ(std::string(node.attribute("src").value()).substr(0, 11), "data:image/");
  }
  EXPECT_THAT(select("//link"), IsEmpty());
  EXPECT_THAT(select("//script[@src]"), IsEmpty());
  EXPECT_LT(text.size(), 15'000'000u);
  std::set<std::string> ids;
  for (const auto& node : select("//*[@id]")) {
    EXPECT_TRUE(ids.insert(node.attribute("id").value()).second) << node.attribute("id").value();
  }
  for (const auto& link : select("//nav/a")) {
    EXPECT_EQ(ids.count(link.attribute("href").value() + 1), 1u) << link.attribute("href").value();
  }
}

TEST_F(HtmlReport, FiguresAreTheJsons) {
  const auto json = nlohmann::json::parse(read_text(json_file()));
  std::size_t rows = 0;
  for (const auto& row : select("//tr[@data-key]")) {
    std::string pointer = std::string("/") + row.attribute("data-key").value();
    std::replace(pointer.begin(), pointer.end(), '.', '/');
    const auto value = json.at(nlohmann::json::json_pointer(pointer));
    EXPECT_EQ(value, nlohmann::json::parse(row.attribute("data-value").value())) << pointer;
    EXPECT_STRNE(row.last_child().text().get(), "") << pointer << " is not explained";
    ++rows;
  }
  EXPECT_GE(rows, 99u);
  EXPECT_EQ(select("//table[contains(@class, 'views')]/tbody/tr").size(), json["frames"].size());
}

TEST_F(HtmlReport, ViewsAreThePhotographsWorstFirst) {
  const auto json = nlohmann::json::parse(read_text(json_file()));
  const auto views = select("//article[@class='view']");
  ASSERT_EQ(views.size(), 3u);  // frames 2, 6, 10
  EXPECT_EQ(views[0].attribute("data-frame").as_int(), json["worst_frame"]["frame"].get<int>());
  EXPECT_EQ(select("//div[@class='picker']/button").size(), 3u);
  for (const auto& view : views) {
    const auto compare = view.find_child_by_attribute("div", "class", "compare");
    const Image photograph = picture(compare.find_child_by_attribute("img", "class", "photograph"));
    const Image drawn = picture(compare.find_child_by_attribute("img", "class", "drawn"));
    ASSERT_EQ(photograph.width, kWidth);
    ASSERT_EQ(photograph.height, kHeight);
    ASSERT_EQ(drawn.width, kWidth);
    ASSERT_EQ(drawn.height, kHeight);
    // Where the map is drawn, it looks like the photograph.
    double error = 0, pixels = 0;
    for (std::size_t i = 0; i < drawn.data.size(); i += 3) {
      if (drawn.data[i] + drawn.data[i + 1] + drawn.data[i + 2] < 60) continue;
      for (std::size_t c = 0; c < 3; ++c)
        error += std::abs(drawn.data[i + c] - photograph.data[i + c]) / 3.0;
      ++pixels;
    }
    EXPECT_GT(pixels, 3000);
    EXPECT_LT(error / pixels, 30);
  }
}

// A dot for every scored point, in the class that its error belongs to.
TEST_F(HtmlReport, HeatMapsShowEveryScoredPoint) {
  const auto json = nlohmann::json::parse(read_text(json_file()));
  for (const auto& view : json["frames"]) {
    const std::string at = "//article[@data-frame='" + view["frame"].dump() + "']";
    for (const char* layer : {"te", "me"}) {
      const auto paths = select((at + "//svg[@class='heat " + layer + "']/path").c_str());
      std::size_t dots = 0;
      for (const auto& path : paths) {
        const std::string d = path.attribute("d").value();
        dots += static_cast<std::size_t>(std::count(d.begin(), d.end(), 'm'));
      }
      EXPECT_EQ(dots, view["points"].get<std::size_t>()) << layer;
    }
  }
}

TEST_F(HtmlReport, ShowsThePapersPictures) {
  EXPECT_EQ(select("//section[@id='registration']//figure[@class='scans']").size(), 4u);
  EXPECT_EQ(select("//section[@id='fovea']//figure").size(), 3u);
  EXPECT_EQ(select("//section[@id='texture']//figure").size() % 3, 0u);
  EXPECT_GT(select("//section[@id='texture']//figure").size(), 0u);
  for (const auto& img : select("//img")) {
    const Image shown = picture(img);
    EXPECT_GT(shown.width, 100);
    EXPECT_STRNE(img.attribute("alt").value(), "");
    const auto lit = std::count_if(shown.data.begin(), shown.data.end(),
                                   [](std::uint8_t value) { return value > 30; });
    EXPECT_GT(lit, 300) << img.attribute("alt").value() << " is black";
  }
}

TEST_F(HtmlReport, TheJsonIsTheSameWithoutAndThePageTheSameAgain) {
  const std::string json = (own_ / "a.json").string(), page = (own_ / "a.html").string();
  const std::string command = "evaluate '" + map() + "' '" + drive() + "' --json '" + json + "'";
  ASSERT_EQ(run_fovea(command).exit_code, 0);
  EXPECT_EQ(read_text(json), read_text(json_file()));
  ASSERT_EQ(run_fovea(command + " --threads 1 --html '" + page + "'").exit_code, 0);
  EXPECT_EQ(read_text(page), read_text(page_file()));
}

TEST_F(HtmlReport, CloudsOfOtherProgramsHaveAPageToo) {
  const std::string ply = (own_ / "map.ply").string(), poses = (own_ / "poses.txt").string(),
                    page = (own_ / "page.html").string();
  ASSERT_EQ(run_fovea("export '" + map() + "' '" + ply + "'").exit_code, 0);
  ASSERT_EQ(run_fovea("export '" + map() + "' '" + poses + "' --format kitti-poses").exit_code, 0);
  const ProgramRun run = run_fovea("evaluate '" + ply + "' '" + drive() + "' --poses '" + poses +
                                   "' --hold-out 4:2 --html '" + page + "'");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  pugi::xml_document document;
  const auto parsed = document.load_file(page.c_str());
  ASSERT_TRUE(parsed) << parsed.description();
  EXPECT_THAT(read_text(page), HasSubstr("does not say how long its frames took"));
  EXPECT_EQ(document.select_nodes("//section[@id='registration']//figure[@class='scans']").size(),
            4u);
}

TEST_F(HtmlReport, TheTruthHasAPageToo) {
  const std::string file = (own_ / "truth.html").string(), again = (own_ / "again.html").string(),
                    json_path = (own_ / "truth.json").string();
  const std::string command = "evaluate '" + map() + "' '" + drive() + "' --truth --html '";
  const ProgramRun run = run_fovea(command + file + "' --json '" + json_path + "'");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  pugi::xml_document document;
  const auto parsed = document.load_file(file.c_str());
  ASSERT_TRUE(parsed) << parsed.description();
  EXPECT_THAT(read_text(file), AllOf(Not(HasSubstr("http://")), Not(HasSubstr("https://"))));
  const auto json = nlohmann::json::parse(read_text(json_path));
  for (const auto& node : document.select_nodes("//tr[@data-key]")) {
    std::string pointer = std::string("/") + node.node().attribute("data-key").value();
    std::replace(pointer.begin(), pointer.end(), '.', '/');
    EXPECT_EQ(json.at(nlohmann::json::json_pointer(pointer)),
              nlohmann::json::parse(node.node().attribute("data-value").value()))
        << pointer;
  }
  const auto views = document.select_nodes("//article[@class='view']");
  ASSERT_EQ(views.size(), 12u);  // of 14 frames
  EXPECT_EQ(views[0].node().attribute("data-frame").as_int(),
            json.at("worst_frame").at("frame").get<int>());
  for (const auto& found : views) {  // the same dots for both kinds of error
    std::map<std::string, std::ptrdiff_t> dots;
    for (const auto& path : found.node().select_nodes(".//svg/path")) {
      const std::string d = path.node().attribute("d").value();
      dots[path.node().parent().attribute("class").value()] += std::count(d.begin(), d.end(), 'm');
    }
    EXPECT_GT(dots["heat te"], 100);
    EXPECT_EQ(dots["heat te"], dots["heat me"]);
  }
  // True poses beside the map's, a dot a frame.
  EXPECT_EQ(document.select_nodes("//path[@class='navigation']").size(), 1u);
  EXPECT_EQ(document.select_nodes("//circle[contains(@class, 'spot')]").size(), 14u);
  EXPECT_GE(document.select_nodes("//section[@id='errors']//img").size(), 1u);
  EXPECT_EQ(document.select_nodes("//section[@id='fovea']//figure").size(), 3u);
  for (const auto& img : document.select_nodes("//img")) {
    const Image shown = picture(img.node());
    EXPECT_GT(shown.width, 100);
    EXPECT_GT(std::count_if(shown.data.begin(), shown.data.end(),
                            [](std::uint8_t value) { return value > 30; }),
              300)
        << img.node().attribute("alt").value();
  }
  ASSERT_EQ(run_fovea(command + again + "' --threads 1").exit_code, 0);
  EXPECT_EQ(read_text(again), read_text(file));
}

TEST_F(HtmlReport, ABadPlaceCostsNoRunAndLeavesNothing) {
  const ProgramRun run = run_fovea("evaluate '" + map() + "' '" + drive() + "' --html '" +
                                   (own_ / "none/page.html").string() + "'");
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.err, HasSubstr("does not exist"));
  EXPECT_THAT(run.out, IsEmpty());
  EXPECT_THAT(own_.names(), IsEmpty());
}

}  // namespace fovea::html_report_program_test
