#include "fovea/drive/recordings/recent_messages.h"

#include <gtest/gtest.h>

namespace fovea::recent_messages_test {

TEST(RecentMessages, DropsTheOlderHalfBeyondItsLimit) {
  RecentMessages recent(100);
  const BagTopic topic{"/points", "a/msg/Type", "cdr"};
  for (const char c : {'a', 'b', 'c', 'd', 'e'}) {
    EXPECT_FALSE(recent.add(topic, std::string(20, c)));
  }
  EXPECT_TRUE(recent.add(topic, std::string(20, 'f')));
  ASSERT_EQ(recent.messages().size(), 2u);
  EXPECT_EQ(recent.messages()[0].bytes, std::string(20, 'e'));
  EXPECT_EQ(recent.messages()[1].bytes, std::string(20, 'f'));
  EXPECT_EQ(recent.messages()[1].topic.name, "/points");
  EXPECT_TRUE(recent.add(topic, std::string(200, 'g')));
  EXPECT_TRUE(recent.messages().empty());
  EXPECT_FALSE(recent.add(topic, "h"));
}

}  // namespace fovea::recent_messages_test
