#include "fovea/core/output_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "../../../tests/file_content.h"
#include "../../../tests/file_size_limit.h"
#include "../../../tests/temporary_folder.h"
#include "fovea/core/machine_error.h"
#include "fovea/errors.h"

namespace fovea::output_file_test {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// Message of the OutputError that `f` throws.
template <class F>
std::string output_error(F&& f) {
  try {
    f();
  } catch (const OutputError& error) {
    return error.what();
  }
  return "no OutputError";
}

/// Whether `f` throws an OutputError that the machine causes.
template <class F>
bool is_of_machine(F&& f) {
  try {
    f();
  } catch (const OutputError& error) {
    return dynamic_cast<const MachineError*>(&error) != nullptr;
  }
  return false;
}

TEST(OutputFile, AppearsWholeAtCommit) {
  const TemporaryFolder folder;
  std::string expected;
  {
    OutputFile file(folder / "out.bin", false);
    for (int i = 0; i < 300'000; ++i) {  // more than the buffer, in pieces that do not divide it
      const std::string piece = std::to_string(i) + ' ';
      file.stream() << piece;
      expected += piece;
    }
    const std::string large(3'000'001, 'x');
    file.stream() << large;
    expected += large;
    EXPECT_FALSE(std::filesystem::exists(folder / "out.bin"));
    file.commit();
  }
  EXPECT_EQ(content(folder / "out.bin"), expected);
  EXPECT_THAT(folder.names(), ElementsAre("out.bin"));
}

TEST(OutputFile, ItsBeginningCanBeWrittenAgain) {
  const TemporaryFolder folder;
  OutputFile file(folder / "out.bin", false);
  const std::string rest(3 << 20, 'x');  // more than the buffer
  file.stream() << "????" << rest;
  file.stream().seekp(0);
  file.stream() << "head";
  file.commit();
  EXPECT_EQ(content(folder / "out.bin"), "head" + rest);
}

TEST(OutputFile, LeavesNothingWithoutCommit) {
  const TemporaryFolder folder;
  {
    OutputFile file(folder / "out.txt", false);
    file.stream() << "half";
    file.stream().flush();
    EXPECT_THAT(folder.names(), ElementsAre("out.txt.partial"));
  }
  EXPECT_THAT(folder.names(), IsEmpty());
}

TEST(OutputFile, ReplacesOnlyWithForceAndOnlyAtCommit) {
  const TemporaryFolder folder;
  std::ofstream(folder / "out.txt") << "old";
  EXPECT_THAT(output_error([&] { OutputFile(folder / "out.txt", false); }), HasSubstr("--force"));
  {
    OutputFile file(folder / "out.txt", true);
    file.stream() << "new";
  }
  EXPECT_EQ(content(folder / "out.txt"), "old");
  OutputFile file(folder / "out.txt", true);
  file.stream() << "new";
  file.commit();
  EXPECT_EQ(content(folder / "out.txt"), "new");
  EXPECT_THROW(file.commit(), std::logic_error);
}

TEST(OutputFile, DoesNotReplaceWhatAppearedMeanwhile) {
  const TemporaryFolder folder;
  OutputFile file(folder / "out.txt", false);
  std::ofstream(folder / "out.txt") << "somebody else's";
  EXPECT_THROW(file.commit(), OutputError);
  EXPECT_EQ(content(folder / "out.txt"), "somebody else's");
}

TEST(OutputFile, RefusesPathsWhereNoFileCanBe) {
  const TemporaryFolder folder;
  std::ofstream(folder / "file") << "x";
  const auto refusal = [](const std::filesystem::path& path) {
    return output_error([&] { OutputFile(path, true); });
  };
  EXPECT_THAT(refusal(folder.path()), HasSubstr("is a folder"));
  EXPECT_THAT(refusal(folder / "no/out.txt"), HasSubstr("folder does not exist"));
  EXPECT_THAT(refusal(folder / "file/out.txt"), HasSubstr("folder does not exist"));
  EXPECT_THAT(refusal("/dev/null"), HasSubstr("not an ordinary file"));
  EXPECT_THAT(refusal(""), HasSubstr("not a file name"));
  EXPECT_THAT(refusal("/proc/out.txt"), HasSubstr("cannot be written"));
  EXPECT_THAT(folder.names(), ElementsAre("file"));
}

TEST(OutputFile, WritesThroughASymbolicLink) {
  const TemporaryFolder folder;
  std::ofstream(folder / "real") << "old";
  std::filesystem::create_symlink(folder / "real", folder / "link");
  OutputFile file(folder / "link", true);
  file.stream() << "new";
  file.commit();
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "link"));
  EXPECT_EQ(content(folder / "real"), "new");
}

TEST(OutputFile, RefusesASecondWriterButTakesUpAStalePartialFile) {
  const TemporaryFolder folder;
  std::ofstream(folder / "out.txt.partial") << "what a killed program left, longer than the new";
  OutputFile file(folder / "out.txt", false);
  EXPECT_THAT(output_error([&] { OutputFile(folder / "out.txt", false); }),
              HasSubstr("another program"));
  file.stream() << "new";
  file.commit();
  EXPECT_EQ(content(folder / "out.txt"), "new");
}

TEST(OutputFile, ReportsAFullDiskWhereItHappensAndLeavesNothing) {
  const TemporaryFolder folder;
  {
    OutputFile file(folder / "out.txt", false);
    const FileSizeLimit limit(2'000'000);
    const std::string block(100'000, 'x');
    EXPECT_THAT(output_error([&] {
                  for (int i = 0; i < 100; ++i) file.stream() << block;
                }),
                HasSubstr("the disk is full"));
  }
  EXPECT_THAT(folder.names(), IsEmpty());
}

TEST(OutputFile, AFullDiskIsAnErrorOfTheMachine) {
  const TemporaryFolder folder;
  OutputFile file(folder / "out.txt", false);
  file.stream() << "buffered until commit";
  const FileSizeLimit limit(3);
  EXPECT_TRUE(is_of_machine([&] { file.commit(); }));
  EXPECT_FALSE(is_of_machine([&] { OutputFile(folder / "missing" / "out.txt", false); }));
}

TEST(OutputFile, ReportsAFullDiskAtCommit) {
  const TemporaryFolder folder;
  {
    OutputFile file(folder / "out.txt", false);
    file.stream() << "buffered until commit";
    const FileSizeLimit limit(3);
    EXPECT_THAT(output_error([&] { file.commit(); }), HasSubstr("the disk is full"));
  }
  EXPECT_THAT(folder.names(), IsEmpty());
}

}  // namespace fovea::output_file_test
