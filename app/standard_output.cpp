#include "app/standard_output.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <system_error>

#include "fovea/core/machine_error.h"
#include "fovea/errors.h"

namespace fovea::app {

void prepare_standard_streams() {
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
  for (const int fd : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (::fcntl(fd, F_GETFD) >= 0 || errno != EBADF) continue;
    // Opened the wrong way round, so that its use still fails. It gets the lowest free number.
    static_cast<void>(::open("/dev/null", fd == STDIN_FILENO ? O_WRONLY : O_RDONLY));
  }
}

namespace {

/// Only the machine can fail to write to a regular file. The reason of an earlier failure is lost.
bool is_regular_file(int fd) {
  struct ::stat status = {};
  return ::fstat(fd, &status) == 0 && S_ISREG(status.st_mode);
}

}  // namespace

bool standard_output_failed() { return std::ferror(stdout) != 0; }

void finish_standard_output() {
  const bool failed_before = standard_output_failed();
  errno = 0;
  if (std::fflush(stdout) == 0 && !failed_before) return;
  const int error = errno;
  const std::string reason =
      error != 0 ? fmt::format(" ({})", std::generic_category().message(error)) : std::string();
  const bool of_machine = error != 0 ? is_machine_error(error) : is_regular_file(STDOUT_FILENO);
  throw_error<OutputError>(of_machine, fmt::format("the output cannot be written{}", reason),
                           "standard output", "check the disk or the program that reads it");
}

}  // namespace fovea::app
