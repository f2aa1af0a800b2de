#include "fovea/drive/command_files.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <optional>
#include <set>
#include <utility>

#include "fovea/core/output_file.h"
#include "fovea/drive/calibrated_drive.h"
#include "fovea/drive/kitti/kitti_drives.h"
#include "fovea/errors.h"

namespace fovea {
namespace {

namespace fs = std::filesystem;

/// Device and inode: the same for all names of a file.
using FileIdentity = std::pair<dev_t, ino_t>;

std::optional<FileIdentity> identity_of(const fs::path& path) {
  struct ::stat status = {};
  if (::stat(path.c_str(), &status) != 0) return std::nullopt;
  return FileIdentity(status.st_dev, status.st_ino);
}

fs::path resolved(const fs::path& path) {
  std::error_code ignored;
  fs::path name = path;
  if (!name.has_filename() && name.has_parent_path()) name = name.parent_path();
  const fs::path real = fs::weakly_canonical(fs::absolute(name, ignored), ignored);
  return ignored ? name : real;
}

bool is_same(const fs::path& a, const fs::path& b) {
  const auto first = identity_of(a), second = identity_of(b);
  return first && second ? *first == *second : resolved(a) == resolved(b);
}

bool lies_in(const fs::path& path, const fs::path& folder) {
  const fs::path inner = resolved(path), outer = resolved(folder);
  return std::mismatch(outer.begin(), outer.end(), inner.begin(), inner.end()).first == outer.end();
}

/// Whether a folder has this file, also through links.
bool has_file(const fs::path& folder, const FileIdentity& file) {
  std::error_code error;
  fs::recursive_directory_iterator entry(folder,
                                         fs::directory_options::follow_directory_symlink |
                                             fs::directory_options::skip_permission_denied,
                                         error);
  std::set<FileIdentity> folders;  // links may make a loop
  while (!error && entry != fs::recursive_directory_iterator()) {
    const auto identity = identity_of(entry->path());
    if (identity == file) return true;
    std::error_code ignored;
    if (identity && entry->is_directory(ignored) && !folders.insert(*identity).second) {
      entry.disable_recursion_pending();
    }
    entry.increment(error);
  }
  return false;
}

/// Files that the writing of an output makes or removes next to it.
std::vector<fs::path> names_of(const OutputPath& output) {
  const fs::path file = resolved(output.path);
  std::vector<fs::path> names{output.path, partial_path(file)};
  if (output.kind != ContentKind::kMap) return names;
  for (const char* ending : {"-wal", "-shm", "-journal"}) names.push_back(fs::path(file) += ending);
  return names;
}

/// Whether a drive or recording can have files of this kind.
bool can_be_in_a_drive(ContentKind kind) {
  constexpr std::array kKinds{ContentKind::kPly, ContentKind::kPcd, ContentKind::kPng,
                              ContentKind::kPoses, ContentKind::kPoseTable};
  return std::find(kKinds.begin(), kKinds.end(), kind) != kKinds.end();
}

constexpr const char* kOtherName = "give another name";

void require_other_file(const OutputPath& output, const std::string& input) {
  if (is_same(output.path, input)) {
    const std::string other_name = input == output.path ? "" : fmt::format(" ({})", input);
    throw OutputError(fmt::format("the output is a file that the command reads{}", other_name),
                      output.path, kOtherName);
  }
  for (const fs::path& name : names_of(output)) {
    if (!is_same(name, input)) continue;
    throw OutputError(
        fmt::format("the command reads {}, which the writing of the output replaces", input),
        output.path, kOtherName);
  }
  std::error_code ignored;
  const auto existing = identity_of(output.path);
  if (existing && can_be_in_a_drive(output.kind) && fs::is_directory(input, ignored) &&
      (has_file(input, *existing) || identity_of(shipped_poses(input)) == existing)) {
    throw OutputError(
        fmt::format("the output is a file of the drive or folder {}, which the command reads",
                    input),
        output.path, kOtherName);
  }
  // A log or journal belongs to the map that is read.
  for (const char* ending : {"-wal", "-journal"}) {
    const fs::path side = fs::path(input) += ending;
    if (fs::exists(side, ignored) && is_same(output.path, side)) {
      throw OutputError(fmt::format("the output is a part of {}, which the command reads", input),
                        output.path, kOtherName);
    }
  }
}

void require_other_output(const OutputPath& a, const OutputPath& b) {
  for (const fs::path& of_a : names_of(a)) {
    for (const fs::path& of_b : names_of(b)) {
      if (!is_same(of_a, of_b)) continue;
      throw OutputError("two outputs of the command are one file",
                        fmt::format("{} and {}", a.path, b.path), "give them different names");
    }
  }
}

std::string ending_of(const fs::path& path) {
  std::string ending = path.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return ending;
}

/// A map under the name of a point cloud would be taken for one, and the other way round.
void check_ending(const OutputPath& output) {
  constexpr std::array kOtherFormats{".ply",  ".pcd", ".las",  ".laz",  ".e57",  ".xyz",  ".bin",
                                     ".csv",  ".txt", ".png",  ".jpg",  ".jpeg", ".glb",  ".gltf",
                                     ".html", ".htm", ".json", ".toml", ".md",   ".mcap", ".bag"};
  const std::string ending = ending_of(output.path);
  const bool is_other =
      std::find(kOtherFormats.begin(), kOtherFormats.end(), ending) != kOtherFormats.end();
  if (output.kind == ContentKind::kMap && is_other) {
    throw OutputError(fmt::format("a map cannot have a name that ends in '{}', as another format "
                                  "does",
                                  ending),
                      output.path, "give a name that ends in .fovea; 'fovea export' writes others");
  }
  if (output.kind != ContentKind::kMap && ending == ".fovea") {
    throw OutputError(fmt::format("only a map has a name that ends in .fovea, and this is {}",
                                  describe(output.kind)),
                      output.path, kOtherName);
  }
}

/// A partial file that a killed program left is replaced, but it is never of another known kind.
void check_partial(const OutputPath& output) {
  const fs::path partial = partial_path(resolved(output.path));
  std::error_code ignored;
  if (!fs::is_regular_file(partial, ignored)) return;
  const ContentKind kind = content_kind_of(partial);
  const bool can_be_left = kind == output.kind || kind == ContentKind::kEmpty ||
                           kind == ContentKind::kOther || kind == ContentKind::kSqlite;
  if (can_be_left) return;
  throw OutputError(
      fmt::format("the output grows under a name that exists and is {}", describe(kind)),
      partial.string(), "give the output another name, or move this file");
}

void check_existing(const OutputPath& output) {
  std::error_code ignored;
  if (fs::is_regular_file(output.path, ignored)) {
    const ContentKind kind = content_kind_of(output.path);
    if (kind != output.kind && kind != ContentKind::kEmpty) {
      throw OutputError(fmt::format("the output exists and is {}, which {} does not replace",
                                    describe(kind), describe(output.kind)),
                        output.path, "give another name, or remove the file first");
    }
  }
  check_output_path(output.path, output.force);
}

/// Calibrated drives have their files in the folders of other drives.
std::vector<std::string> with_corrected_drives(const std::vector<std::string>& inputs) {
  std::vector<std::string> all = inputs;
  for (const std::string& input : inputs) {
    if (input.empty()) continue;
    try {
      for (const fs::path& folder : corrected_folders(input)) all.push_back(folder.string());
    } catch (const Error&) {
      continue;  // Opening the drive reports it.
    }
  }
  return all;
}

void require_outside(const OutputPath& output, const OutputFolderPath& folder) {
  if (folder.path.empty() || folder.use != FolderUse::kReplace) return;
  if (!lies_in(output.path, folder.path)) return;
  throw OutputError("two outputs of the command are at one place",
                    fmt::format("{} and the folder {}", output.path, folder.path),
                    "give them different places");
}

void check_folder(const OutputFolderPath& folder, const std::vector<std::string>& inputs) {
  if (folder.path.empty()) return;
  std::error_code ignored;
  for (const std::string& input : inputs) {
    if (!fs::exists(input, ignored)) continue;
    if (fs::is_directory(input, ignored) && lies_in(folder.path, input)) {
      throw OutputError(fmt::format("the output folder lies in {}, which the command reads", input),
                        folder.path, "give a folder outside of it");
    }
    if (folder.use == FolderUse::kReplace && lies_in(input, folder.path)) {
      throw OutputError(
          fmt::format("the output folder contains {}, which the command reads", input), folder.path,
          "give another folder");
    }
  }
}

}  // namespace

void check_files(const CommandFiles& files) {
  const std::vector<std::string> inputs = with_corrected_drives(files.inputs);
  std::vector<OutputPath> outputs;
  std::copy_if(files.outputs.begin(), files.outputs.end(), std::back_inserter(outputs),
               [](const OutputPath& output) { return !output.path.empty(); });
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    for (const std::string& input : inputs) {
      if (!input.empty()) require_other_file(outputs[i], input);
    }
    for (std::size_t j = 0; j < i; ++j) require_other_output(outputs[j], outputs[i]);
  }
  check_folder(files.folder, inputs);
  for (const OutputPath& output : outputs) {
    require_outside(output, files.folder);
    check_existing(output);
    check_partial(output);
    check_ending(output);
  }
}

}  // namespace fovea
