// Writes messages to an MCAP file (mcap.dev/spec), for BagSink's readers.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <string_view>
#include <tuple>

#include "fovea/drive/recordings/bag_sink.h"
#include "fovea/time.h"

namespace fovea {

///   McapWriter writer("street.mcap");
///   writer.add(topic, message, time);
///   writer.finish();
///
/// The file grows under its name: after a crash, a reader takes what was written. Messages are
/// neither compressed nor indexed, and have no definitions of their types.
class McapWriter {
 public:
  /// @throws OutputError  if the file exists, or cannot be made
  explicit McapWriter(const std::filesystem::path& path);

  /// Appends a message. @throws OutputError  if the disk is full, or of more than 65,535 topics
  void add(const BagTopic& topic, std::string_view message, TimeNs time);
  /// Passes all messages to the system. @throws OutputError  if the disk is full
  void flush();
  /// Marks the end. @throws OutputError  if the disk is full
  void finish();

 private:
  std::uint16_t channel_of(const BagTopic& topic);
  void put(std::uint8_t opcode, std::string_view content, std::string_view data = {});
  void check();

  std::filesystem::path path_;
  std::ofstream stream_;
  std::map<std::tuple<std::string, std::string, std::string>, std::uint16_t> channels_;
};

}  // namespace fovea
