#include "app/error_line.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include <array>
#include <cerrno>
#include <filesystem>
#include <new>
#include <system_error>

#include "fovea/core/machine_error.h"
#include "fovea/core/path_remedy.h"
#include "fovea/errors.h"

namespace fovea::app {
namespace {

/// What makes a command use less memory.
std::string_view memory_remedy(std::string_view command) {
  struct Remedy {
    std::string_view command, text;
  };
  static constexpr std::array<Remedy, 13> kRemedies = {{
      {"map", "map fewer frames (--frames) or at a lower upsampling rate"},
      {"reproduce", "take fewer frames (--frames)"},
      {"simulate", "simulate smaller images and scans (--set camera.width=W, lidar.columns=N)"},
      {"convert", "split the recording"},
      {"merge", "merge parts of the maps (fovea crop)"},
      {"crop", "crop a smaller region"},
      {"export", "export a part of the map (fovea crop)"},
      {"evaluate", "evaluate a part of the map (fovea crop)"},
      {"recolor", "recolor a part of the map (fovea crop)"},
      {"render", "render a part of the map (fovea crop)"},
      {"view", "view a part of the map (fovea crop)"},
      {"localize", "localize in a part of the map (fovea crop)"},
      {"upsample", "upsample at a lower --rate"},
  }};
  for (const Remedy& remedy : kRemedies) {
    if (remedy.command == command) return remedy.text;
  }
  return "end other programs";
}

std::string memory_line(std::string_view command) {
  rlimit limit{};
  if (getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY) {
    return fmt::format(
        "out of memory, fovea {} within the limit of {} MB (ulimit -v), raise the "
        "limit, or {}",
        command, limit.rlim_cur >> 20, memory_remedy(command));
  }
  return fmt::format("out of memory, fovea {} on this machine, {}", command,
                     memory_remedy(command));
}

constexpr const char* kNoThread =
    "no thread can be started, this machine, end other programs or raise the limits of processes "
    "and memory (ulimit -u, -v)";

bool has_no_thread(const std::exception& error) {
  // TBB throws std::runtime_error with this text.
  return std::string_view(error.what()).starts_with("pthread_create");
}

/// An error of the operating system.
std::string system_line(const std::system_error& error) {
  const int code = error.code().value();
  const auto* of_file = dynamic_cast<const std::filesystem::filesystem_error*>(&error);
  const std::string where =
      of_file != nullptr && !of_file->path1().empty() ? of_file->path1().string() : "this machine";
  if (code == EAGAIN && of_file == nullptr) {
    return kNoThread;
  }
  return fmt::format("{}, {}, check the path, its permissions and the disk", error.code().message(),
                     where);
}

}  // namespace

std::string error_line(const std::exception& error, std::string_view command) {
  if (dynamic_cast<const Error*>(&error) != nullptr) return error.what();
  if (dynamic_cast<const std::bad_alloc*>(&error) != nullptr) return memory_line(command);
  if (const auto* of_system = dynamic_cast<const std::system_error*>(&error)) {
    return system_line(*of_system);
  }
  if (has_no_thread(error)) return kNoThread;
  return fmt::format("{}, inside fovea, please report this with the command that caused it",
                     error.what());
}

bool is_of_machine(const std::exception& error) {
  if (const auto* of_system = dynamic_cast<const std::system_error*>(&error)) {
    const int code = of_system->code().value();
    return is_machine_error(code) || code == EAGAIN;  // EAGAIN: no thread can be started
  }
  return dynamic_cast<const MachineError*>(&error) != nullptr ||
         dynamic_cast<const std::bad_alloc*>(&error) != nullptr || has_no_thread(error);
}

}  // namespace fovea::app
