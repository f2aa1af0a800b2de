#include "fovea/core/output_folder.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <system_error>

#include "fovea/core/output_file.h"
#include "fovea/errors.h"

namespace fovea {
namespace fs = std::filesystem;

namespace {

/// Whether a folder holds nothing but entries of these names.
bool holds_only(const fs::path& folder, const std::vector<std::string>& names) {
  std::error_code error;
  fs::directory_iterator entries(folder, error);
  if (error) throw_output_error(folder, error.value());
  return std::all_of(begin(entries), end(entries), [&](const fs::directory_entry& entry) {
    return std::find(names.begin(), names.end(), entry.path().filename()) != names.end();
  });
}

/// "out/" names the same folder as "out".
fs::path without_trailing_slash(fs::path path) {
  if (!path.has_filename() && path.has_parent_path()) path = path.parent_path();
  return path;
}

}  // namespace

OutputFolder::OutputFolder(const fs::path& path, bool force, std::vector<std::string> contents)
    : path_(without_trailing_slash(path)),
      force_(force),
      contents_(std::move(contents)),
      target_(check_target()),
      partial_(partial_path(target_)),
      unfinished_(target_, {partial_}, [this] { open_partial_folder(); }) {}

void OutputFolder::open_partial_folder() {
  if (::mkdir(partial_.c_str(), 0777) != 0 && errno != EEXIST) throw_output_error(target_, errno);
  lock_ = ::open(partial_.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
  if (lock_ < 0) throw_output_error(partial_, errno);
  try {
    // What nobody has locked was left behind by a killed program.
    if (::flock(lock_, LOCK_EX | LOCK_NB) != 0) {
      throw OutputError("another program is writing this output", target_.string(),
                        "wait until it has ended or give another name");
    }
    if (!holds_only(partial_, contents_)) {
      throw OutputError("a folder of something else is in the way", partial_.string(),
                        "move it away or give another name");
    }
    for (const std::string& name : contents_) {
      std::error_code error;
      fs::remove_all(partial_ / name, error);
      if (error) throw_output_error(partial_, error.value());
    }
  } catch (...) {
    ::close(lock_);
    throw;
  }
}

OutputFolder::~OutputFolder() { discard(); }

fs::path OutputFolder::check_target() const {
  const fs::path name = path_.filename();
  if (name.empty() || name == "." || name == "..") {
    throw OutputError("the output is not the name of a folder", fmt::format("'{}'", path_.string()),
                      "give the name of the folder to make");
  }
  std::error_code ignored;
  const fs::file_status status = fs::status(path_, ignored);
  if (!fs::exists(status)) {
    const fs::path parent = path_.has_parent_path() ? path_.parent_path() : fs::path(".");
    if (!fs::is_directory(parent, ignored)) {
      throw OutputError("the output's folder does not exist", parent.string(), "make it first");
    }
    return path_;
  }
  if (!fs::is_directory(status)) {
    throw OutputError("the output is a folder, and this is a file", path_.string(),
                      "give another name");
  }
  if (!force_) {
    throw OutputError("the output exists already", path_.string(),
                      "use --force to replace it or give another name");
  }
  if (!holds_only(path_, contents_)) {
    throw OutputError("the folder holds something else than an earlier output", path_.string(),
                      "give another name");
  }
  return fs::canonical(path_);
}

void OutputFolder::write(const fs::path& relative, std::string_view bytes) const {
  const fs::path file = partial_ / relative;
  const int fd = [&] {
    const OutputStep step;  // the folder must not be made anew after a signal removed it
    std::error_code error;
    fs::create_directories(file.parent_path(), error);
    if (error) throw_output_error(target_, error.value());
    return ::open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  }();
  if (fd < 0) throw_output_error(target_, errno);
  while (!bytes.empty()) {
    const ssize_t written = ::write(fd, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) {
      const int reason = errno;
      ::close(fd);
      ::unlink(file.c_str());  // half a file; its room may be needed
      throw_output_error(target_, reason);
    }
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
  if (::close(fd) != 0) throw_output_error(target_, errno);
}

void OutputFolder::commit() {
  check_target();  // another program may have made it meanwhile
  // One flush for thousands of files, where an fsync each would take minutes.
  if (::syncfs(lock_) != 0) throw_output_error(target_, errno);
  {
    const OutputStep step;
    exchange();
    discard();  // of the old folder
    unfinished_.finish();
  }
  sync_folder_of(target_);
}

void OutputFolder::commit_as(const std::string& name) {
  path_.replace_filename(name);
  target_ = check_target();
  commit();
}

void OutputFolder::exchange() {
  std::error_code error;
  if (fs::exists(target_, error)) {
    if (::renameat2(AT_FDCWD, partial_.c_str(), AT_FDCWD, target_.c_str(), RENAME_EXCHANGE) == 0) {
      return;
    }
    if (errno != EINVAL && errno != ENOSYS) throw_output_error(target_, errno);
    fs::remove_all(target_, error);  // a file system without exchange
    if (error) throw_output_error(target_, error.value());
  }
  if (::rename(partial_.c_str(), target_.c_str()) != 0) throw_output_error(target_, errno);
}

void OutputFolder::discard() noexcept {
  if (lock_ < 0) return;
  std::error_code ignored;
  fs::remove_all(partial_, ignored);
  ::close(lock_);
  lock_ = -1;
}

}  // namespace fovea
