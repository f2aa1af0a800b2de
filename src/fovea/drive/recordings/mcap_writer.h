// Writes messages to an MCAP file (mcap.dev/spec), which other programs read, too.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>

#include "fovea/core/output_file.h"
#include "fovea/core/time.h"
#include "fovea/drive/recordings/bag_sink.h"

namespace fovea {

///   McapWriter writer("street.mcap", /*force=*/false);
///   writer.add(topic, message, time);
///   writer.finish();
///
/// Without finish() there is no file. Messages are neither compressed nor indexed.
class McapWriter {
 public:
  /// @throws OutputError  as OutputFile
  McapWriter(const std::filesystem::path& path, bool force);

  /// Appends a message. @throws OutputError  if the disk is full, or of more than 65,535 topics
  void add(const BagTopic& topic, std::string_view message, TimeNs time);
  /// @throws OutputError  if the disk is full
  void finish();

 private:
  std::uint16_t channel_of(const BagTopic& topic);
  void put(std::uint8_t opcode, std::string_view content, std::string_view data = {});

  OutputFile file_;
  std::map<std::string, std::uint16_t> channels_;  // by topic
};

}  // namespace fovea
