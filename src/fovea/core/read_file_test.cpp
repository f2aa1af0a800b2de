#include "fovea/core/read_file.h"

#include <gtest/gtest.h>

#include "../../../tests/kitti_test_drive.h"
#include "fovea/errors.h"

namespace fovea::read_file_test {

using test::TemporaryFolder;
using test::write_text;

TEST(ReadFile, LinesOfEitherLineEnd) {
  const TemporaryFolder folder;
  const auto lines = [&](const char* text) {
    write_text(folder.path() / "a.txt", text);
    return read_lines(folder.path() / "a.txt");
  };
  EXPECT_EQ(lines("a\r\n\nb"), (std::vector<std::string>{"a", "", "b"}));
  EXPECT_EQ(lines("a\n\n"), (std::vector<std::string>{"a", ""}));
  EXPECT_TRUE(lines("").empty());
}

TEST(ReadFile, AByteOrderMarkIsNoText) {
  const TemporaryFolder folder;
  write_text(folder.path() / "a.txt",
             "\xEF\xBB\xBF"
             "a\r\nb\r\n");
  EXPECT_EQ(read_lines(folder.path() / "a.txt"), (std::vector<std::string>{"a", "b"}));
  write_text(folder.path() / "a.txt", std::string("\xFF\xFE"
                                                  "a\0\r\0\n\0",
                                                  8));
  const auto error = test::error_of<InputError>([&] { read_lines(folder.path() / "a.txt"); });
  EXPECT_NE(error.find("the text is UTF-16"), std::string::npos) << error;
  EXPECT_NE(error.find("a.txt"), std::string::npos) << error;
}

TEST(ReadFile, FailuresNameTheFile) {
  const TemporaryFolder folder;
  const auto message = [](const test::fs::path& file) {
    return test::error_of<InputError>([&] { read_bytes(file); });
  };
  EXPECT_NE(message(folder.path() / "none").find("none"), std::string::npos);
  EXPECT_NE(message(folder.path()).find("it is a folder"), std::string::npos);
}

TEST(ReadFile, AnExpectedFileNeedNotBeThere) {
  const TemporaryFolder folder;
  write_text(folder.path() / "a.txt", "x");
  expect_file(folder.path() / "a.txt");
  expect_file(folder.path() / "none");
  expect_file(folder.path());
  EXPECT_EQ(read_lines(folder.path() / "a.txt"), std::vector<std::string>{"x"});
}

TEST(ReadFile, NumbersInAnyNotation) {
  EXPECT_EQ(parse_numbers(" 1 -2.5e+03\t7.215377e+02\r\n"),
            (std::vector<double>{1, -2500, 721.5377}));
  EXPECT_EQ(parse_numbers("  "), std::vector<double>{});
  EXPECT_TRUE(std::isnan(parse_numbers("nan")->at(0)));
  EXPECT_FALSE(parse_numbers("1 x"));
  EXPECT_FALSE(parse_numbers("1,5"));
  EXPECT_FALSE(parse_numbers("1.5m"));
}

TEST(ReadFile, NumberedFilesOnly) {
  const TemporaryFolder folder;
  for (const char* name : {"0000000003.png", "000007.JPG", "0000000003.jpg", "9.jpeg", "a1.png",
                           "1.txt", "-2.png", "1.5.png", "._1.png", "20110926130824.png", ".png"}) {
    write_text(folder.path() / name, "x");
  }
  const NumberedFiles files = list_numbered_files(folder.path(), {".png", ".jpg", ".jpeg"});
  const NumberedFiles expected{{3, folder.path() / "0000000003.jpg"},  // the first by name
                               {7, folder.path() / "000007.JPG"},
                               {9, folder.path() / "9.jpeg"}};
  EXPECT_EQ(files, expected);
  EXPECT_TRUE(list_numbered_files(folder.path() / "none", {".png"}).empty());
}

}  // namespace fovea::read_file_test
