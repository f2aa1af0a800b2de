#include "fovea/drive/recordings/bag.h"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include "fovea/core/file_format.h"
#include "fovea/core/input_file.h"
#include "fovea/drive/recordings/decompress.h"
#include "fovea/drive/recordings/mcap_file.h"
#include "fovea/drive/recordings/ros1_bag.h"
#include "fovea/drive/recordings/sqlite_bag.h"
#include "fovea/errors.h"

namespace fovea {
namespace {

namespace fs = std::filesystem;

std::string beginning_of(const fs::path& file) {
  return InputFile(file, kStreamedFile).beginning(kSniffedBytes);
}

std::vector<fs::path> listed_files(const fs::path& folder) {
  const fs::path file = folder / "metadata.yaml";
  std::error_code unknown;
  if (!fs::exists(file, unknown)) {
    throw InputError("the folder has no metadata.yaml", folder.string(),
                     "give a bag that 'ros2 bag record' wrote, or its .mcap or .db3 files");
  }
  std::vector<fs::path> files;
  try {
    const std::vector<std::uint8_t> text = InputFile(file, kSettingsFile).bytes();
    const YAML::Node bag =
        YAML::Load(std::string(text.begin(), text.end()))["rosbag2_bagfile_information"];
    const std::string format = bag["compression_format"].as<std::string>("");
    if (!format.empty() && format != "zstd") {
      throw InputError(fmt::format("the bag is compressed by '{:.40}'", format), file.string(),
                       "write it with zstd or uncompressed ('ros2 bag convert')");
    }
    // The folder may have been renamed since; older versions wrote its name, too.
    for (const YAML::Node& name : bag["relative_file_paths"]) {
      files.push_back(folder / fs::path(name.as<std::string>()).filename());
    }
  } catch (const YAML::Exception& error) {
    throw InputError(fmt::format("this is no description of a bag ({})", error.what()),
                     file.string(), "write it anew with 'ros2 bag reindex'");
  }
  if (files.empty()) {
    throw InputError("the bag has no files", file.string(),
                     "write it anew with 'ros2 bag reindex'");
  }
  return files;
}

/// Decompresses messages that were compressed one by one.
class Unpacker : public BagSink {
 public:
  explicit Unpacker(BagSink& sink) : sink_(sink) {}

  bool is_requested(const BagTopic& topic) override { return sink_.is_requested(topic); }
  void add(const BagTopic& topic, std::string_view message) override {
    if (!is_zstd(message)) return sink_.add(topic, message);
    std::string unpacked;
    try {
      unpacked = decompress_zstd(message, kMaxBagBlock, topic.name);
    } catch (const InputError&) {
      return sink_.add(topic, message);  // as it is: no message of ROS 2 to whom it reads
    }
    sink_.add(topic, unpacked);
  }
  void skip(const BagTopic& topic) override { sink_.skip(topic); }
  void report_loss(const std::string& problem) override { sink_.report_loss(problem); }

 private:
  BagSink& sink_;
};

/// @param shown  the file that the user knows of
void read_plain(const fs::path& file, const fs::path& shown, BagSink& sink) {
  const SniffedFormat found = sniff_format(beginning_of(file));
  switch (found.format) {
    case FileFormat::kMcap:
      return read_mcap(file, shown, sink);
    case FileFormat::kSqlite:
      return read_sqlite_bag(file, shown, sink);
    case FileFormat::kRosBag1:
      return read_ros1_bag(file, shown, sink);
    default:
      throw InputError(fmt::format("this is no recording of ROS, but {}", found.name),
                       shown.string(), "give a .bag, .mcap or .db3 file, or a bag's folder");
  }
}

}  // namespace

std::vector<fs::path> bag_files(const fs::path& path) {
  std::error_code error;
  if (fs::is_directory(path, error)) return listed_files(path);
  if (fs::exists(path, error)) return {path};
  throw InputError("there is no such recording", path.string(), "check the path");
}

void read_bag_file(const fs::path& file, const fs::path& scratch, BagSink& sink) {
  Unpacker unpacker(sink);
  if (sniff_format(beginning_of(file)).format == FileFormat::kZstd) {
    const DecompressedFile plain(file, scratch);
    read_plain(plain.path(), file, unpacker);
  } else {
    read_plain(file, file, unpacker);
  }
}

}  // namespace fovea
