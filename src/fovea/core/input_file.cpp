#include "fovea/core/input_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <streambuf>
#include <system_error>
#include <utility>

#include "fovea/core/machine_error.h"
#include "fovea/errors.h"

namespace fovea {
namespace {

/// Names what is no regular file; empty for a regular file.
const char* special_type(mode_t mode) {
  if (S_ISREG(mode)) return "";
  if (S_ISDIR(mode)) return "it is a folder";
  if (S_ISFIFO(mode)) return "it is a pipe";
  if (S_ISSOCK(mode)) return "it is a socket";
  return "it is a device";
}

[[noreturn]] void throw_unreadable(const std::filesystem::path& path, const FileKind& kind,
                                   const std::string& reason, const char* remedy,
                                   bool of_machine = false) {
  throw_error<InputError>(of_machine, fmt::format("the {} cannot be read ({})", kind.noun, reason),
                          path.string(), remedy);
}

constexpr const char* kRestore = "restore it or make it readable";

/// By errno.
[[noreturn]] void throw_system_error(const std::filesystem::path& path, const FileKind& kind,
                                     int error) {
  throw_unreadable(path, kind, std::generic_category().message(error), kRestore,
                   is_machine_error(error));
}

void require_regular(const std::filesystem::path& path, const FileKind& kind,
                     const struct ::stat& status) {
  const std::string type = special_type(status.st_mode);
  if (!type.empty()) throw_unreadable(path, kind, type, "give a regular file");
}

}  // namespace

/// The content behind a stream that can seek.
class InputFile::Buffer : public std::streambuf {
 public:
  explicit Buffer(const InputFile& file) : file_(file), memory_(kBytes) { set_position(0); }

 protected:
  int_type underflow() override {
    const std::uintmax_t begin = position();
    const std::size_t got = file_.read_at(begin, memory_.data(), memory_.size());
    setg(memory_.data(), memory_.data(), memory_.data() + got);
    end_of_buffer_ = begin + got;
    return got == 0 ? traits_type::eof() : traits_type::to_int_type(memory_.front());
  }

  pos_type seekoff(off_type offset, std::ios_base::seekdir from, std::ios_base::openmode) override {
    off_type base = 0;
    if (from == std::ios_base::cur) base = static_cast<off_type>(position());
    if (from == std::ios_base::end) base = static_cast<off_type>(file_.size());
    if (base + offset < 0) return pos_type(off_type(-1));
    // A question for the position must not cost the buffer.
    if (from != std::ios_base::cur || offset != 0) {
      set_position(static_cast<std::uintmax_t>(base + offset));
    }
    return base + offset;
  }
  pos_type seekpos(pos_type position, std::ios_base::openmode which) override {
    return seekoff(position, std::ios_base::beg, which);
  }

 private:
  static constexpr std::size_t kBytes = std::size_t{1} << 16;

  std::uintmax_t position() const {
    return end_of_buffer_ - static_cast<std::uintmax_t>(egptr() - gptr());
  }
  void set_position(std::uintmax_t position) {
    end_of_buffer_ = position;
    setg(memory_.data(), memory_.data(), memory_.data());
  }

  const InputFile& file_;
  std::vector<char> memory_;
  std::uintmax_t end_of_buffer_ = 0;  // in the file
};

InputFile::InputFile(const std::filesystem::path& path, const FileKind& kind)
    : path_(path), kind_(kind) {
  // Before the file is opened: to open a device can have effects of its own.
  require_regular_if_present(path, kind);
  descriptor_ = ::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
  if (descriptor_ < 0) throw_system_error(path, kind, errno);
  struct ::stat status = {};
  try {
    if (::fstat(descriptor_, &status) != 0) throw_system_error(path, kind, errno);
    require_regular(path, kind, status);
    size_ = static_cast<std::uintmax_t>(status.st_size);
    if (size_ > kind.max_size) {
      throw InputError(fmt::format("the file has {} bytes, more than any {} ({})", size_, kind.noun,
                                   kind.max_size),
                       path.string(), "check what the file is (docs/limits.md)");
    }
  } catch (...) {
    ::close(descriptor_);
    throw;
  }
}

InputFile::~InputFile() { ::close(descriptor_); }

void InputFile::fail(const std::string& reason) const {
  throw_unreadable(path_, kind_, reason, kRestore);
}

std::size_t InputFile::read_at(std::uintmax_t offset, char* bytes, std::size_t count) const {
  std::size_t got = 0;
  while (got < count) {
    const ssize_t part =
        ::pread(descriptor_, bytes + got, count - got, static_cast<off_t>(offset + got));
    if (part < 0 && errno == EINTR) continue;
    if (part < 0) throw_system_error(path_, kind_, errno);
    if (part == 0) break;
    got += static_cast<std::size_t>(part);
  }
  return got;
}

std::string InputFile::range(std::uintmax_t offset, std::size_t count) const {
  std::string bytes(count, '\0');
  bytes.resize(read_at(offset, bytes.data(), bytes.size()));
  return bytes;
}

std::vector<std::uint8_t> InputFile::bytes() const {
  std::vector<std::uint8_t> bytes(size_);
  const std::size_t got = read_at(0, reinterpret_cast<char*>(bytes.data()), bytes.size());
  if (got != bytes.size()) fail(fmt::format("only {} bytes could be read", got));
  return bytes;
}

std::istream& InputFile::stream() {
  if (!stream_) {
    buffer_ = std::make_unique<Buffer>(*this);
    stream_ = std::make_unique<std::istream>(buffer_.get());
  }
  return *stream_;
}

void require_regular_if_present(const std::filesystem::path& path, const FileKind& kind) {
  struct ::stat status = {};
  if (::stat(path.c_str(), &status) == 0) require_regular(path, kind, status);
}

}  // namespace fovea
