#include "fovea/core/printable.h"

#include <gtest/gtest.h>

namespace fovea::printable_test {

TEST(Printable, TextStaysAsItIs) {
  for (const char* text : {"", "a name",
                           "Stra\xc3\x9f"
                           "e",
                           "\xe6\xb1\x9f", "\xf0\x9f\x9a\x97"}) {
    EXPECT_EQ(printable(text), text);
    EXPECT_EQ(printable_lines(text), text);
  }
}

TEST(Printable, ControlCharactersAreReplaced) {
  using namespace std::string_literals;
  EXPECT_EQ(printable("\x1b[31mred\x1b[0m"), "?[31mred?[0m");
  EXPECT_EQ(printable("a\nb\tc\rd\0e\x7f"s), "a?b?c?d?e?");
  EXPECT_EQ(printable("\xc2\x9b"
                      "2J"),
            "?2J");  // U+009B, a control sequence
  EXPECT_EQ(printable("\x9b"
                      "2J"),
            "?2J");                                       // the same in Latin-1
  EXPECT_EQ(printable("a\xe2\x80\xa8z"), "a?z");          // U+2028, a line separator
  EXPECT_EQ(printable("a\xe2\x80\xaegnp.z"), "a?gnp.z");  // U+202E, from right to left
  EXPECT_EQ(printable_lines("a\n\tb\r\x1b[2K"), "a\n\tb??[2K");
}

TEST(Printable, BytesThatAreNoUtf8AreReplaced) {
  EXPECT_EQ(printable("a\xff"
                      "b"),
            "a?b");
  EXPECT_EQ(printable("a\xc3"), "a?");               // cut short
  EXPECT_EQ(printable("\xc0\x9b"), "??");            // escape in two bytes
  EXPECT_EQ(printable("\xe0\x80\x9b"), "???");       // escape in three
  EXPECT_EQ(printable("\xed\xa0\x80"), "???");       // half of a surrogate pair
  EXPECT_EQ(printable("\xf4\x90\x80\x80"), "????");  // beyond Unicode
}

}  // namespace fovea::printable_test
