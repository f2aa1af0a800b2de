// Runs the built program in the background, for tests that send it signals.
#pragma once

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "tests/program.h"
#include "tests/temporary_folder.h"

namespace fovea {

class BackgroundProgram {
 public:
  /// Starts `fovea ARGUMENTS...` directly, without a shell, with the default action of all signals.
  /// @param ignored  a signal that the program inherits as ignored, or 0
  explicit BackgroundProgram(std::vector<std::string> arguments, int ignored = 0) {
    arguments.insert(arguments.begin(), FOVEA_PROGRAM);
    std::vector<char*> words;
    for (std::string& argument : arguments) words.push_back(argument.data());
    words.push_back(nullptr);
    posix_spawn_file_actions_t files;
    posix_spawn_file_actions_init(&files);
    posix_spawn_file_actions_addopen(&files, 1, out().c_str(), O_WRONLY | O_CREAT, 0666);
    posix_spawn_file_actions_addopen(&files, 2, err().c_str(), O_WRONLY | O_CREAT, 0666);
    posix_spawnattr_t attributes;
    posix_spawnattr_init(&attributes);
    sigset_t signals;
    sigfillset(&signals);
    if (ignored != 0) sigdelset(&signals, ignored);
    const auto action = ignored != 0 ? ::signal(ignored, SIG_IGN) : SIG_DFL;
    posix_spawnattr_setsigdefault(&attributes, &signals);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGDEF);
    const int error =
        posix_spawn(&process_, FOVEA_PROGRAM, &files, &attributes, words.data(), environ);
    if (ignored != 0) ::signal(ignored, action);
    posix_spawn_file_actions_destroy(&files);
    posix_spawnattr_destroy(&attributes);
    if (error != 0) throw std::runtime_error("the program cannot be started");
  }
  ~BackgroundProgram() {
    if (ended_) return;
    ::kill(process_, SIGKILL);
    wait();
  }
  BackgroundProgram(const BackgroundProgram&) = delete;
  BackgroundProgram& operator=(const BackgroundProgram&) = delete;

  /// Waits for a state; false if the program ended before, or after a minute.
  bool wait_until(const std::function<bool()>& reached) {
    const auto latest = std::chrono::steady_clock::now() + std::chrono::minutes(1);
    while (!has_ended() && std::chrono::steady_clock::now() < latest) {
      if (reached()) return true;
      std::this_thread::sleep_for(std::chrono::microseconds(200));
    }
    return false;
  }

  /// Whether the program waits for signals itself: it blocks SIGTERM.
  bool waits_for_signals() const {
    std::ifstream status("/proc/" + std::to_string(process_) + "/status");
    for (std::string line; std::getline(status, line);) {
      if (!line.starts_with("SigBlk:")) continue;
      return (std::stoull(line.substr(7), nullptr, 16) >> (SIGTERM - 1) & 1) != 0;
    }
    return false;
  }

  void kill(int signal) const { ::kill(process_, signal); }
  std::string printed() const { return read_text(out()); }

  ProgramRun wait() {
    if (!ended_) {
      ::waitpid(process_, &status_, 0);
      ended_ = true;
    }
    ProgramRun run;
    run.exit_code = WIFEXITED(status_) ? WEXITSTATUS(status_) : 128 + WTERMSIG(status_);
    run.out = read_text(out());
    run.err = read_text(err());
    return run;
  }

 private:
  bool has_ended() {
    ended_ = ended_ || ::waitpid(process_, &status_, WNOHANG) == process_;
    return ended_;
  }
  std::filesystem::path out() const { return scratch_ / "out"; }
  std::filesystem::path err() const { return scratch_ / "err"; }

  TemporaryFolder scratch_;
  pid_t process_ = 0;
  int status_ = 0;
  bool ended_ = false;
};

}  // namespace fovea
