// Runs the built program and the folders that its tests need.
#pragma once

#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "tests/temporary_folder.h"

namespace fovea {

struct ProgramRun {
  int exit_code = -1;  ///< 128 + signal if it was killed
  std::string out, err;
};

inline std::string read_text(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::stringstream text;
  text << stream.rdbuf();
  return text.str();
}

/// Runs `fovea ARGUMENTS` (a shell's words), with `before` in front of it (e.g. "timeout 5 ").
inline ProgramRun run_fovea(const std::string& arguments, const std::string& before = "") {
  const TemporaryFolder scratch;
  const std::string command = before + " '" FOVEA_PROGRAM "' " + arguments + " >'" +
                              (scratch / "out").string() + "' 2>'" + (scratch / "err").string() +
                              "'";
  const int status = std::system(command.c_str());
  ProgramRun run;
  run.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  run.out = read_text(scratch / "out");
  run.err = read_text(scratch / "err");
  return run;
}

}  // namespace fovea
