// Output files that appear under their name only when they are whole.
#pragma once

#include <filesystem>
#include <memory>
#include <ostream>

namespace fovea {

class UnfinishedOutput;

/// Checks, before any work is done, that an output can be made at `path`. OutputError if there is
/// something already and `force` is false, if it is not an ordinary file, or if its folder does not
/// exist or cannot be written to.
/// @return the file to make: `path`, or what it points to where it is a symbolic link
std::filesystem::path check_output_path(const std::filesystem::path& path, bool force);

/// The name beside `path` under which its contents grow: "PATH.partial".
std::filesystem::path partial_path(const std::filesystem::path& path);

/// Makes `partial` durable and renames it to `path`, which replaces what was there in one step.
/// @param output  finished by this
void publish_file(const std::filesystem::path& partial, const std::filesystem::path& path,
                  UnfinishedOutput& output);

/// A name that no other program uses, for a file in a folder that machines share:
/// "NAME.HOST-PROCESS-NUMBER.partial".
std::filesystem::path scratch_name(const std::filesystem::path& path);

/// Copies `partial`, which it removes, to `copy` in the folder of `path`; makes the copy durable
/// and read-only, and renames it to `path`. OutputError names the file that cannot be written.
/// @param output  of `partial` and `copy`; finished by this
void publish_copy(const std::filesystem::path& partial, const std::filesystem::path& copy,
                  const std::filesystem::path& path, UnfinishedOutput& output);

/// Makes a file's name durable: flushes the folder that it is in.
void sync_folder_of(const std::filesystem::path& path);

/// Throws the OutputError of a failed write, by `error` (errno); a full disk has its own remedy.
[[noreturn]] void throw_output_error(const std::filesystem::path& path, int error);

/// A file written through a stream and kept only if commit() is called. A write that fails throws
/// OutputError out of the stream's operation itself.
class OutputFile {
 public:
  /// OutputError as check_output_path(), or if another program is writing the same output.
  OutputFile(const std::filesystem::path& path, bool force);
  /// Removes what was not committed.
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  /// Of seeking it knows seekp(POSITION).
  std::ostream& stream() { return stream_; }
  /// Flushes everything to disk and gives the file its name. Nothing can be written afterwards.
  void commit();

 private:
  class Buffer;

  bool force_;
  std::filesystem::path path_;
  std::unique_ptr<Buffer> buffer_;
  std::ostream stream_;
};

}  // namespace fovea
