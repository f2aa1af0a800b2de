// `fovea view`, `map --live` and `export --viewer` as a user calls them; the page itself is tested
// in tests/web.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "fovea/map/map_store.h"
#include "tests/program.h"
#include "tests/sample_map.h"
#include "tests/temporary_folder.h"

namespace fovea::view_program_test {

using ::testing::HasSubstr;
using ::testing::IsSupersetOf;

class ViewProgram : public testing::Test {
 protected:
  void SetUp() override { write_sample_map(folder_ / "a.fovea"); }
  std::string map() const { return (folder_ / "a.fovea").string(); }
  TemporaryFolder folder_;
};

TEST_F(ViewProgram, SaysWhatIsWrong) {
  const auto error = [&](const std::string& arguments) {
    const ProgramRun result = run_fovea(arguments);
    EXPECT_NE(result.exit_code, 0) << arguments;
    return result.err;
  };
  EXPECT_THAT(error("view " + (folder_ / "none.fovea").string()), HasSubstr("does not exist"));
  EXPECT_THAT(error("view " + map() + " --drive " + (folder_ / "none").string()),
              HasSubstr("does not exist"));
  EXPECT_THAT(error("view " + map() + " --port 70000"), HasSubstr("--port"));
  EXPECT_THAT(error("view " + map() + " --port 0 --address nowhere"), HasSubstr("not an address"));
  EXPECT_THAT(error("view " + map() + " --cameras 2"), HasSubstr("--drive"));
  EXPECT_THAT(error("map drive -o out.fovea --live=70000"), HasSubstr("no port"));
  EXPECT_THAT(error("export " + map() + " " + (folder_ / "a.ply").string() + " --viewer"),
              HasSubstr("--viewer: is for 3dtiles"));
}

TEST_F(ViewProgram, AFolderWithThePage) {
  const std::filesystem::path site = folder_ / "site";
  const std::string command = "export " + map() + " " + site.string() + " --format 3dtiles";
  ASSERT_EQ(run_fovea(command + " --viewer").exit_code, 0);
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(site)) {
    names.push_back(std::filesystem::relative(entry.path(), site).string());
  }
  EXPECT_THAT(names, IsSupersetOf({"index.html", "assets/page.js", "assets/page.css", "map.json",
                                   "frames.json", "tileset.json"}));
  EXPECT_EQ(run_fovea(command + " --viewer --force").exit_code, 0);
  // A page is not thrown away for a tileset without one: that would not know its files.
  EXPECT_NE(run_fovea(command + " --force").exit_code, 0);
}

TEST_F(ViewProgram, AFolderWithAMesh) {
  const std::filesystem::path site = folder_ / "mesh";
  ASSERT_EQ(
      run_fovea("export " + map() + " " + site.string() + " --format mesh --viewer").exit_code, 0);
  EXPECT_TRUE(std::filesystem::exists(site / "index.html"));
  EXPECT_TRUE(std::filesystem::exists(site / "tileset.json"));
  EXPECT_THAT(read_text(site / "map.json"), HasSubstr(R"("mesh":true)"));
}

}  // namespace fovea::view_program_test
