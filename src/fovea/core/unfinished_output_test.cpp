#include "fovea/core/unfinished_output.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <thread>

#include "../../../tests/file_content.h"
#include "../../../tests/temporary_folder.h"
#include "fovea/core/output_file.h"
#include "fovea/core/output_folder.h"

namespace fovea::unfinished_output_test {

using ::testing::ElementsAre;

/// Runs `body` in a process of its own, which it must end. True if its exit code was 0.
template <class Body>
bool in_child(Body&& body) {
  const pid_t child = ::fork();
  if (child == 0) body();
  int status = -1;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

TEST(UnfinishedOutput, DiscardRemovesOnlyWhatIsNotFinished) {
  const TemporaryFolder folder;
  EXPECT_TRUE(in_child([&] {
    OutputFile done(folder / "done", false), open(folder / "open", false);
    {
      const OutputFile given_up(folder / "given_up", false);
    }
    OutputFolder done_folder(folder / "done_folder", false, {"a"});
    const OutputFolder open_folder(folder / "open_folder", false, {"a"});
    open.stream() << std::string(3 << 20, 'x');
    done_folder.write("a/b", "whole");
    open_folder.write("a/b", "a part");
    done.commit();
    done_folder.commit();
    const OutputNames names = discard_unfinished_outputs();
    using Paths = std::vector<std::filesystem::path>;
    const bool right = names.finished == Paths{folder / "done", folder / "done_folder"} &&
                       names.discarded == Paths{folder / "open", folder / "open_folder"};
    ::_exit(right ? 0 : 1);
  }));
  EXPECT_THAT(folder.names(), ElementsAre("done", "done_folder"));
}

TEST(UnfinishedOutput, AReplacedOutputStaysAsItWas) {
  const TemporaryFolder folder;
  {
    OutputFolder before(folder / "tiles", false, {"a"});
    before.write("a", "before");
    before.commit();
  }
  EXPECT_TRUE(in_child([&] {
    const OutputFolder again(folder / "tiles", true, {"a"});
    again.write("a", "again");
    discard_unfinished_outputs();
    ::_exit(0);
  }));
  EXPECT_THAT(folder.names(), ElementsAre("tiles"));
  EXPECT_EQ(content(folder / "tiles" / "a"), "before");
}

// Other threads write and publish while the register is discarded: no part of theirs is left.
TEST(UnfinishedOutput, ThreadsThatStillWriteLeaveNothing) {
  for (int attempt = 0; attempt < 10; ++attempt) {
    const TemporaryFolder folder;
    EXPECT_TRUE(in_child([&] {
      std::atomic<int> written{0};
      std::vector<std::thread> threads;
      for (int t = 0; t < 3; ++t) {
        threads.emplace_back([&, t] {
          for (int i = 0;; ++i) {
            OutputFolder out(folder / std::to_string(t), true, {"a"});
            for (int k = 0; k < 5; ++k) {
              out.write("a/" + std::to_string(k), std::string(100, 'x'));
              ++written;
            }
            if (i % 2 == 0) out.commit();
          }
        });
      }
      while (written < 20 + 7 * attempt) std::this_thread::yield();
      discard_unfinished_outputs();
      ::_exit(0);  // the threads do not end
    }));
    for (const std::string& name : folder.names()) {
      EXPECT_EQ(name.find(".partial"), std::string::npos) << name;
      // A folder with its name is whole.
      for (int k = 0; k < 5; ++k) {
        EXPECT_EQ(content(folder / name / "a" / std::to_string(k)), std::string(100, 'x'));
      }
    }
  }
}

}  // namespace fovea::unfinished_output_test
