#include "fovea/core/output_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <limits.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <stdexcept>
#include <streambuf>
#include <system_error>
#include <vector>

#include "fovea/core/machine_error.h"
#include "fovea/core/path_remedy.h"
#include "fovea/core/unfinished_output.h"
#include "fovea/errors.h"

namespace fovea {
namespace fs = std::filesystem;

namespace {

/// Makes a file or folder durable. Some file systems refuse this for folders: no error then.
bool sync_to_disk(const fs::path& path, int open_flags) {
  const int fd = ::open(path.c_str(), open_flags | O_CLOEXEC);
  if (fd < 0) return false;
  const bool synced = ::fsync(fd) == 0;
  const int error = errno;
  ::close(fd);
  errno = error;
  return synced;
}

fs::path folder_of(const fs::path& path) {
  return path.has_parent_path() ? path.parent_path() : fs::path(".");
}

}  // namespace

void throw_output_error(const fs::path& path, int error) {
  const std::string reason = std::generic_category().message(error);
  if (error == EFBIG) {  // 4 GB on FAT
    throw OfMachine<OutputError>(
        fmt::format("the disk is full or the file is larger than a limit allows ({})", reason),
        path.string(), "free some space, raise the limit (ulimit -f) or write to another disk");
  }
  if (error == ENOSPC || error == EDQUOT) {
    throw OfMachine<OutputError>(fmt::format("the disk is full ({})", reason), path.string(),
                                 "free some space or write to another disk");
  }
  throw_error<OutputError>(is_machine_error(error), fmt::format("cannot be written ({})", reason),
                           path.string(), "check the path and its permissions");
}

fs::path check_output_path(const fs::path& path, bool force) {
  if (path.empty() || !path.has_filename()) {
    throw OutputError("the output is not a file name", fmt::format("'{}'", path.string()),
                      "give the name of the file to make");
  }
  std::error_code error, ignored;
  const fs::file_status status = fs::status(path, error);
  // Otherwise such a path would be taken for a new file.
  if (error.value() == ELOOP || error.value() == ENAMETOOLONG) {
    throw OutputError(fmt::format("cannot be written ({})", error.message()), path.string(),
                      path_remedy(error.value(), ""));
  }
  if (fs::is_directory(status)) {
    throw OutputError("the output is a folder", path.string(), "give the name of a file in it");
  }
  if (fs::exists(status) && !fs::is_regular_file(status)) {
    throw OutputError("the output is not an ordinary file", path.string(), "give another name");
  }
  if (fs::exists(status) && !force) {
    throw OutputError("the output exists already", path.string(),
                      "use --force to replace it or give another name");
  }
  fs::path target = fs::exists(status) ? fs::canonical(path) : path;
  const fs::path folder = folder_of(target);
  if (!fs::is_directory(folder, ignored)) {
    throw OutputError("the output's folder does not exist", folder.string(), "make it first");
  }
  if (::access(folder.c_str(), W_OK | X_OK) != 0) throw_output_error(target, errno);
  return target;
}

fs::path partial_path(const fs::path& path) {
  fs::path partial = path;
  partial += ".partial";
  return partial;
}

void publish_file(const fs::path& partial, const fs::path& path, UnfinishedOutput& output) {
  if (!sync_to_disk(partial, O_RDONLY)) throw_output_error(path, errno);
  {
    const OutputStep step;
    if (::rename(partial.c_str(), path.c_str()) != 0) throw_output_error(path, errno);
    output.finish();
  }
  sync_folder_of(path);
}

fs::path scratch_name(const fs::path& path) {
  std::array<char, HOST_NAME_MAX + 1> host{};
  ::gethostname(host.data(), host.size() - 1);
  static std::atomic<int> number = 0;
  return fmt::format("{}.{}-{}-{}.partial", path.filename().string(), host.data(), ::getpid(),
                     ++number);
}

void publish_copy(const fs::path& partial, const fs::path& copy, const fs::path& path,
                  UnfinishedOutput& output) {
  constexpr auto kReadOnly = fs::perms::owner_read | fs::perms::group_read | fs::perms::others_read;
  std::error_code error, ignored;
  const auto drop_copy = [&] { fs::remove(copy, ignored); };
  if (!fs::copy_file(partial, copy, fs::copy_options::overwrite_existing, error)) {
    drop_copy();
    throw_output_error(path, error.value());
  }
  fs::permissions(copy, kReadOnly, ignored);  // where the file system has permissions
  try {
    publish_file(copy, path, output);
  } catch (...) {
    drop_copy();
    throw;
  }
  fs::remove(partial, ignored);
}

void sync_folder_of(const fs::path& path) { sync_to_disk(folder_of(path), O_RDONLY | O_DIRECTORY); }

/// A file descriptor behind a buffer; std::filebuf would lose why a write failed.
class OutputFile::Buffer : public std::streambuf {
 public:
  explicit Buffer(const fs::path& target)
      : target_(target),
        partial_(partial_path(target)),
        unfinished_(target_, {partial_}, [this] { open_partial_file(); }) {
    setp(memory_.data(), memory_.data() + memory_.size());
  }
  Buffer(const Buffer&) = delete;
  Buffer& operator=(const Buffer&) = delete;
  ~Buffer() override { discard(); }

  bool is_open() const { return fd_ >= 0; }

  void flush() {
    write_all(pbase(), static_cast<std::size_t>(pptr() - pbase()));
    setp(memory_.data(), memory_.data() + memory_.size());
  }

  /// The lock goes with the descriptor, so it is kept until the file has its name.
  void publish() {
    flush();
    publish_file(partial_, target_, unfinished_);
    close();
  }

 protected:
  int_type overflow(int_type c) override {
    if (!is_open()) return traits_type::eof();
    flush();
    if (!traits_type::eq_int_type(c, traits_type::eof())) {
      sputc(traits_type::to_char_type(c));
    }
    return traits_type::not_eof(c);
  }

  std::streamsize xsputn(const char* data, std::streamsize count) override {
    if (!is_open()) return 0;
    if (count < epptr() - pptr()) {
      std::copy_n(data, count, pptr());
      pbump(static_cast<int>(count));
      return count;
    }
    flush();
    write_all(data, static_cast<std::size_t>(count));
    return count;
  }

  int sync() override {
    if (is_open()) flush();
    return 0;
  }

  /// For headers that are known only behind what they describe.
  pos_type seekpos(pos_type position, std::ios_base::openmode) override {
    if (!is_open()) return pos_type(off_type(-1));
    flush();
    const off_t reached = ::lseek(fd_, position, SEEK_SET);
    if (reached < 0) throw_output_error(target_, errno);
    return reached;
  }

 private:
  void open_partial_file() {
    fd_ = ::open(partial_.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0666);
    if (fd_ < 0) throw_output_error(target_, errno);
    // A partial file without a lock was left behind by a killed program.
    // Some shared folders have no locks.
    const bool is_busy = ::flock(fd_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
    if (is_busy || !still_named()) {
      ::close(fd_);
      throw OutputError("another program is writing this output", target_.string(),
                        "wait until it has ended or give another name");
    }
    if (::ftruncate(fd_, 0) != 0) {
      const int error = errno;
      discard();
      throw_output_error(target_, error);
    }
  }

  void write_all(const char* data, std::size_t count) {
    while (count > 0) {
      const ssize_t written = ::write(fd_, data, count);
      if (written < 0 && errno == EINTR) continue;
      if (written < 0) throw_output_error(target_, errno);
      data += written;
      count -= static_cast<std::size_t>(written);
    }
  }

  /// Whether the name still belongs to the file that is open: its former writer may have published
  /// or removed it between open() and flock().
  bool still_named() const {
    struct ::stat opened = {}, named = {};
    return ::fstat(fd_, &opened) == 0 && ::stat(partial_.c_str(), &named) == 0 &&
           opened.st_ino == named.st_ino && opened.st_dev == named.st_dev;
  }

  void close() {
    if (fd_ >= 0) ::close(fd_);
    fd_ = -1;
    setp(nullptr, nullptr);
  }

  void discard() {
    if (fd_ >= 0) ::unlink(partial_.c_str());
    close();
  }

  fs::path target_;
  fs::path partial_;
  int fd_ = -1;
  UnfinishedOutput unfinished_;  // below fd_, which it opens
  std::vector<char> memory_ = std::vector<char>(std::size_t{1} << 20);
};

OutputFile::OutputFile(const fs::path& path, bool force)
    : force_(force),
      path_(path),
      buffer_(std::make_unique<Buffer>(check_output_path(path, force))),
      stream_(buffer_.get()) {
  // With badbit in the mask the stream lets the buffer's own exception through.
  stream_.exceptions(std::ios::badbit);
}

OutputFile::~OutputFile() = default;

void OutputFile::commit() {
  if (!buffer_->is_open()) throw std::logic_error("an output file was committed twice");
  check_output_path(path_, force_);  // another program may have made it meanwhile
  buffer_->publish();
}

}  // namespace fovea
