#include "fovea/core/text_encoding.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fovea/errors.h"

namespace fovea::text_encoding_test {

using namespace std::string_view_literals;

TEST(TextEncoding, TheMarkOfUtf8IsNotPartOfTheText) {
  EXPECT_EQ(without_byte_order_mark("\xEF\xBB\xBFindex", "a.csv"), "index");
  EXPECT_EQ(without_byte_order_mark("\xEF\xBB\xBF", "a.csv"), "");
}

TEST(TextEncoding, OtherTextsStayAsTheyAre) {
  for (const std::string_view text : {"", "i", "index", "\xEF\xBB", "\xC3\xBC"}) {
    EXPECT_EQ(without_byte_order_mark(text, "a.csv"), text);
  }
}

TEST(TextEncoding, OtherEncodingsAreNamed) {
  const auto problem = [](std::string_view text) -> std::string {
    try {
      return std::string(without_byte_order_mark(text, "a.csv"));
    } catch (const InputError& error) {
      EXPECT_EQ(error.where(), "a.csv");
      return error.problem();
    }
  };
  for (const std::string_view text :
       {"\xFF\xFEi\0n\0"sv, "\xFE\xFF\0i\0n"sv, "i\0n\0"sv, "\0i\0n"sv}) {
    EXPECT_EQ(problem(text), "the text is UTF-16");
  }
  EXPECT_EQ(problem("\xFF\xFE\0\0i\0\0\0"sv), "the text is UTF-32");
  EXPECT_EQ(problem("\0\0\xFE\xFF\0\0\0i"sv), "the text is UTF-32");
}

}  // namespace fovea::text_encoding_test
