// The files that a command reads and writes, checked in one place before it begins.
#pragma once

#include <string>
#include <vector>

#include "fovea/core/content_kind.h"

namespace fovea {

struct OutputPath {
  std::string path;  ///< empty: the command does not write it
  ContentKind kind = ContentKind::kOther;
  bool force = false;  ///< an existing file of the same kind may be replaced
};

/// What a command does with a folder that it writes.
enum class FolderUse {
  kReplace,  ///< makes it, or with --force replaces it by a new one
  kAddTo,    ///< makes it or adds files to it
};

struct OutputFolderPath {
  std::string path;  ///< empty: the command writes none
  FolderUse use = FolderUse::kReplace;
};

struct CommandFiles {
  std::vector<std::string> inputs;  ///< files and folders; names of nothing are ignored
  std::vector<OutputPath> outputs;
  OutputFolderPath folder = {};
};

/// Each command calls this once, before it reads or writes anything. OutputError if an output is an
/// input, a file of an input folder or another output, under whatever name; if an output exists and
/// is a file of another kind or may not be replaced; if a name has the ending of another format; or
/// if an output folder lies in an input, or would replace one or hold another output.
void check_files(const CommandFiles& files);

}  // namespace fovea
