#include "fovea/drive/bridge/bridge_address.h"

#include <gtest/gtest.h>

#include "fovea/errors.h"

namespace fovea::bridge_address_test {
namespace {

using namespace fovea::bridge;

void expect_address(const std::string& text, const Address& expected) {
  const Address address = parse_address(text);
  EXPECT_EQ(address.host, expected.host) << text;
  EXPECT_EQ(address.port, expected.port) << text;
  EXPECT_EQ(address.path, expected.path) << text;
}

TEST(BridgeAddress, HasAHostAPortAndAPath) {
  expect_address("ws://robot", {"robot", "8765", "/"});
  expect_address("ws://robot:90", {"robot", "90", "/"});
  expect_address("ws://10.0.0.1:65535/a/b?c", {"10.0.0.1", "65535", "/a/b?c"});
  expect_address("ws://[::1]:90/", {"::1", "90", "/"});
  expect_address("ws://[fe80::1]", {"fe80::1", "8765", "/"});
}

TEST(BridgeAddress, OthersAreRefused) {
  for (const char* text :
       {"ws://", "ws:///path", "ws://:8765", "ws://robot:", "ws://robot:0", "ws://robot:65536",
        "ws://robot:8765x", "ws://[::1", "ws://[::1]9000", "ws://[::1]x:90", "ws://[]:90",
        "ws://a b", "ws://a\r\nHost: b", "wss://robot", "http://robot", "robot:8765"}) {
    EXPECT_THROW(parse_address(text), ConfigError) << text;
  }
}

TEST(BridgeAddress, HasATextForMessages) {
  EXPECT_EQ(parse_address("ws://robot:90/path").text(), "robot:90");
  EXPECT_EQ(parse_address("ws://[::1]").text(), "[::1]:8765");
}

TEST(BridgeAddress, IsNoFile) {
  EXPECT_TRUE(is_address("ws://robot"));
  EXPECT_TRUE(is_address("wss://robot"));
  EXPECT_FALSE(is_address("drive/ws:"));
  EXPECT_FALSE(is_address("wsp.mcap"));
}

}  // namespace
}  // namespace fovea::bridge_address_test
