#include "app/drive_arguments.h"

#include <CLI/Error.hpp>
#include <charconv>

#include "fovea/errors.h"

namespace fovea::app {
namespace {

int parse_number(std::string_view text, const char* option, const char* form) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || value < 0) {
    throw CLI::ValidationError(option, form);
  }
  return value;
}

}  // namespace

std::vector<int> parse_cameras(const std::string& text) {
  std::vector<int> cameras;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t comma = std::min(text.find(',', begin), text.size());
    cameras.push_back(parse_number(std::string_view(text).substr(begin, comma - begin), "--cameras",
                                   "camera numbers joined by commas, e.g. 2,3, or none"));
    begin = comma + 1;
  }
  return cameras;
}

HoldOut parse_frame_set(const std::string& spec, const std::string& option) {
  try {
    return HoldOut::parse(spec);
  } catch (const ConfigError& error) {
    throw CLI::ValidationError(option, error.problem() + ", " + error.remedy());
  }
}

HoldOut parse_hold_out(const std::string& spec) { return parse_frame_set(spec, "--hold-out"); }

void add_mask_option(CLI::App& command, DriveArguments& arguments) {
  command
      .add_option("--mask", arguments.masks,
                  "Picture whose dark pixels camera K does not use; may be repeated")
      ->type_name("K=FILE")
      ->allow_extra_args(false);
}

DriveOptions DriveArguments::options() const {
  DriveOptions options;
  for (const std::string& mask : masks) {
    const char* form = "a camera and a picture, e.g. 2=mask.png";
    const std::size_t equals = mask.find('=');
    if (equals == std::string::npos || equals + 1 == mask.size()) {
      throw CLI::ValidationError("--mask", form);
    }
    const int camera = parse_number(std::string_view(mask).substr(0, equals), "--mask", form);
    if (!options.masks.emplace(camera, mask.substr(equals + 1)).second) {
      throw CLI::ValidationError("--mask", "one mask for each camera");
    }
  }
  options.use_navigation = !no_navigation;
  options.use_imu = !no_imu;
  options.use_images = cameras != kNoCameras;
  if (options.use_images && !cameras.empty()) options.cameras = parse_cameras(cameras);
  if (!frames.empty()) {
    const char* form = "a half-open range A:B, either end may be left out";
    const std::size_t colon = frames.find(':');
    if (colon == std::string::npos) throw CLI::ValidationError("--frames", form);
    const std::string_view range(frames), first = range.substr(0, colon),
                                          last = range.substr(colon + 1);
    if (!first.empty()) options.begin = parse_number(first, "--frames", form);
    if (!last.empty()) options.end = parse_number(last, "--frames", form);
  }
  return options;
}

std::unique_ptr<FrameSource> DriveArguments::open(bool use_navigation) const {
  DriveOptions wanted = options();
  wanted.use_navigation = wanted.use_navigation && use_navigation;
  wanted.use_imu = wanted.use_imu && use_navigation;
  return open_drive(drive, wanted);
}

}  // namespace fovea::app
