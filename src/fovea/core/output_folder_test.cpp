#include "fovea/core/output_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "../../../tests/file_content.h"
#include "../../../tests/file_size_limit.h"
#include "../../../tests/temporary_folder.h"
#include "fovea/errors.h"

namespace fovea::output_folder_test {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

const std::vector<std::string> kContents = {"index", "parts"};

TEST(OutputFolder, AppearsWholeAtCommit) {
  const TemporaryFolder folder;
  OutputFolder output((folder / "out").string() + "/", false, kContents);
  output.write("index", "abc");
  output.write("parts/0/1", "def");
  EXPECT_THAT(folder.names(), ElementsAre("out.partial"));
  output.commit();
  EXPECT_THAT(folder.names(), ElementsAre("out"));
  EXPECT_EQ(content(folder / "out/index"), "abc");
  EXPECT_EQ(content(folder / "out/parts/0/1"), "def");
}

TEST(OutputFolder, LeavesNothingWithoutCommitOrOnAFullDisk) {
  const TemporaryFolder folder;
  {
    OutputFolder output(folder / "out", false, kContents);
    output.write("parts/0", "abc");
  }
  EXPECT_THAT(folder.names(), IsEmpty());
  {
    OutputFolder output(folder / "out", false, kContents);
    const FileSizeLimit limit(1000);
    EXPECT_THROW(output.write("index", std::string(2000, 'x')), OutputError);
  }
  EXPECT_THAT(folder.names(), IsEmpty());
}

TEST(OutputFolder, ReplacesOnlyWithForceAndOnlyItsLike) {
  const TemporaryFolder folder;
  const auto make = [&](bool force, const std::string& text) {
    OutputFolder output(folder / "out", force, kContents);
    output.write("index", text);
    output.commit();
  };
  make(false, "old");
  std::filesystem::create_directory(folder / "out/parts");
  EXPECT_THROW(make(false, "new"), OutputError);
  EXPECT_EQ(content(folder / "out/index"), "old");
  make(true, "new");
  EXPECT_EQ(content(folder / "out/index"), "new");
  EXPECT_FALSE(std::filesystem::exists(folder / "out/parts"));
  std::ofstream(folder / "out/letter.txt") << "dear";
  EXPECT_THROW(make(true, "newer"), OutputError);
  EXPECT_EQ(content(folder / "out/letter.txt"), "dear");
  EXPECT_THAT(folder.names(), ElementsAre("out"));
}

TEST(OutputFolder, GetsANameThatDependsOnItsContents) {
  const TemporaryFolder folder;
  const auto make = [&](bool force, const std::string& text) {
    OutputFolder output(folder / "out", force, kContents);
    output.write("index", text);
    output.commit_as("out_1");
  };
  make(false, "old");
  EXPECT_THAT(folder.names(), ElementsAre("out_1"));
  EXPECT_THROW(make(false, "new"), OutputError);
  EXPECT_THAT(folder.names(), ElementsAre("out_1"));
  EXPECT_EQ(content(folder / "out_1/index"), "old");
  make(true, "new");
  EXPECT_EQ(content(folder / "out_1/index"), "new");
  std::ofstream(folder / "out_1/letter.txt") << "dear";
  EXPECT_THROW(make(true, "newer"), OutputError);
  EXPECT_EQ(content(folder / "out_1/letter.txt"), "dear");
  EXPECT_THAT(folder.names(), ElementsAre("out_1"));
}

TEST(OutputFolder, RefusesPathsWhereNoFolderCanBe) {
  const TemporaryFolder folder;
  std::ofstream(folder / "file") << "text";
  for (const std::string name : {"file", "missing/out", ".", ".."}) {
    EXPECT_THROW(OutputFolder(folder / name, true, kContents), OutputError) << name;
  }
  EXPECT_THROW(OutputFolder("", true, kContents), OutputError);
  EXPECT_THAT(folder.names(), ElementsAre("file"));
}

TEST(OutputFolder, RefusesASecondWriterButTakesUpAStaleOne) {
  const TemporaryFolder folder;
  {
    const OutputFolder first(folder / "out", false, kContents);
    EXPECT_THROW(OutputFolder(folder / "out", false, kContents), OutputError);
  }
  std::filesystem::create_directory(folder / "out.partial");
  std::ofstream(folder / "out.partial/index") << "stale";
  OutputFolder output(folder / "out", false, kContents);
  output.commit();
  EXPECT_FALSE(std::filesystem::exists(folder / "out/index"));
  std::filesystem::create_directory(folder / "b.partial");
  std::ofstream(folder / "b.partial/thesis.txt") << "years of work";
  EXPECT_THROW(OutputFolder(folder / "b", true, kContents), OutputError);
  EXPECT_TRUE(std::filesystem::exists(folder / "b.partial/thesis.txt"));
}

}  // namespace fovea::output_folder_test
