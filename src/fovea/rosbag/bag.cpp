#include "fovea/rosbag/bag.h"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <fstream>

#include "fovea/base/errors.h"
#include "fovea/rosbag/decompress.h"
#include "fovea/rosbag/mcap_file.h"
#include "fovea/rosbag/sqlite_bag.h"

namespace fovea {
namespace {

namespace fs = std::filesystem;

std::string beginning_of(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::string bytes(16, '\0');
  if (stream) stream.read(bytes.data(), std::streamsize(bytes.size()));
  if (!stream && !stream.eof()) {
    throw InputError("the file cannot be read", file.string(), "check the path");
  }
  bytes.resize(std::size_t(stream.gcount()));
  return bytes;
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
    const YAML::Node bag = YAML::LoadFile(file.string())["rosbag2_bagfile_information"];
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

  bool wants(const BagTopic& topic) override { return sink_.wants(topic); }
  bool add(const BagTopic& topic, std::string_view message) override {
    if (!is_zstd(message)) return sink_.add(topic, message);
    std::string unpacked;
    try {
      unpacked = decompress_zstd(message, kMaxBagBlock, topic.name);
    } catch (const InputError&) {
      return sink_.add(topic, message);  // as it is: no message of ROS 2 to whom it reads
    }
    return sink_.add(topic, unpacked);
  }

 private:
  BagSink& sink_;
};

/// @param shown  the file that the user knows of
void read_plain(const fs::path& file, const fs::path& shown, BagSink& sink) {
  const std::string beginning = beginning_of(file);
  if (is_mcap(beginning)) {
    read_mcap(file, shown, sink);
  } else if (is_sqlite(beginning)) {
    read_sqlite_bag(file, shown, sink);
  } else if (beginning.starts_with("#ROSBAG V")) {
    throw InputError("this is a recording of ROS 1", shown.string(),
                     "turn it into one of ROS 2 ('rosbags-convert', 'mcap convert')");
  } else {
    throw InputError("this is no recording of ROS 2", shown.string(),
                     "give an .mcap file, a .db3 file or a bag's folder");
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
  if (is_zstd(beginning_of(file))) {
    const DecompressedFile plain(file, scratch);
    read_plain(plain.path(), file, unpacker);
  } else {
    read_plain(file, file, unpacker);
  }
}

}  // namespace fovea
