// Messages of a Foxglove bridge. The first byte says whether one is text.
#include "fovea/drive/bridge/bridge_address.h"
#include "fovea/drive/bridge/bridge_messages.h"
#include "fovea/errors.h"
#include "fuzz_input.h"

using namespace fovea;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string_view message = as_text(data, size).substr(1);
  read_or_refuse([&] {
    const bridge::ServerMessage parsed =
        data[0] == 't' ? bridge::parse_text(message) : bridge::parse_binary(message);
    if (const auto* content = std::get_if<bridge::MessageData>(&parsed)) {
      require(message.ends_with(content->payload), "the payload is the end of the message");
    }
  });
  read_or_refuse<ConfigError>([&] {
    const bridge::Address address = bridge::parse_address(std::string(message));
    require(!address.host.empty() && !address.port.empty(), "an address has a host and a port");
    require(address.path.starts_with('/'), "a path begins at the root");
  });
  return 0;
}
