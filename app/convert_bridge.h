// fovea convert ws://ROBOT: the topics of a running robot as a drive.
#pragma once

#include <filesystem>
#include <string>

#include "app/session.h"
#include "fovea/drive/recordings/convert_bags.h"

namespace fovea::app {

struct BridgeConversion {
  std::string address;  ///< "ws://robot:8765"
  std::filesystem::path output;
  ConvertOptions options;
  double reconnect = 30;  ///< s
  bool force = false, quiet = false;
};

/// Records to OUTPUT.mcap until the robot or the user ends it, then converts the recording, which
/// stays.
ConvertFigures convert_bridge(const BridgeConversion& conversion, Session& session);

/// Prints the topics that a bridge offers.
void list_bridge(const std::string& address);

}  // namespace fovea::app
