#include "app/html_report/markup.h"

#include <gtest/gtest.h>

#include <cmath>

namespace fovea::app::markup_test {

TEST(Escaped, MarkupCannotGetThrough) {
  EXPECT_EQ(escaped("a < b & \"c\" > d"), "a &lt; b &amp; &quot;c&quot; &gt; d");
  EXPECT_EQ(escaped("Stra\xC3\x9F"
                    "e \xE2\x82\xAC \xF0\x9F\x9A\x97"),
            "Stra\xC3\x9F"
            "e \xE2\x82\xAC \xF0\x9F\x9A\x97");
}

TEST(Escaped, WhatIsNoTextIsReplaced) {
  const std::string bad = "\xEF\xBF\xBD";
  EXPECT_EQ(escaped("Stra\xDF"
                    "e"),
            "Stra" + bad + "e");                                          // Latin-1
  EXPECT_EQ(escaped("x\xE2\x82"), "x" + bad + bad);                       // cut off
  EXPECT_EQ(escaped("\xC0\xAF"), bad + bad);                              // overlong
  EXPECT_EQ(escaped("\xED\xA0\x80"), bad + bad + bad);                    // surrogate
  EXPECT_EQ(escaped(std::string("a\0b\x1B", 4)), "a" + bad + "b" + bad);  // not allowed in XML
  EXPECT_EQ(escaped("a\tb\n"), "a\tb\n");
}

TEST(Number, IsReadable) {
  EXPECT_EQ(number(0.123456), "0.1235");
  EXPECT_EQ(number(std::nan("")), "none");
  EXPECT_EQ(number(INFINITY), "infinite");
  EXPECT_EQ(count(7), "7");
  EXPECT_EQ(count(123), "123");
  EXPECT_EQ(count(1234567),
            "1\xE2\x80\xAF"
            "234\xE2\x80\xAF"
            "567");
}

// RFC 4648, section 10.
TEST(Base64, TestVectors) {
  const auto encoded = [](std::string_view text) {
    return base64(std::vector<std::uint8_t>(text.begin(), text.end()));
  };
  EXPECT_EQ(encoded(""), "");
  EXPECT_EQ(encoded("f"), "Zg==");
  EXPECT_EQ(encoded("fo"), "Zm8=");
  EXPECT_EQ(encoded("foo"), "Zm9v");
  EXPECT_EQ(encoded("foobar"), "Zm9vYmFy");
  EXPECT_EQ(base64({0xFF, 0xFE, 0xFB}), "//77");
}

TEST(Shrunk, IsTheMeanOfWhatItCovers) {
  Image image(4, 2, 1);
  image.data = {0, 10, 100, 102, 20, 30, 104, 106};
  const Image small = shrunk(image, 2);
  ASSERT_EQ(small.width, 2);
  ASSERT_EQ(small.height, 1);
  EXPECT_EQ(small.data, (std::vector<std::uint8_t>{15, 103}));
  EXPECT_EQ(shrunk(image, 4).data, image.data);
  const Image odd = shrunk(Image(1999, 7, 3), 1280);
  EXPECT_EQ(odd.width, 1280);
  EXPECT_EQ(odd.height, 4);
}

}  // namespace fovea::app::markup_test
