#include "fovea/core/input_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstring>
#include <fstream>

#include "../../../tests/temporary_folder.h"
#include "fovea/errors.h"

namespace fovea::input_file_test {

using testing::AllOf;
using testing::HasSubstr;

/// The error of opening a file; empty if there is none.
std::string error_of(const std::filesystem::path& file, const FileKind& kind = kScanFile) {
  try {
    const InputFile opened(file, kind);
    return "";
  } catch (const InputError& error) {
    return error.what();
  }
}

/// A socket with a name in a folder, until the end of the test.
class NamedSocket {
 public:
  explicit NamedSocket(const std::filesystem::path& file)
      : descriptor_(socket(AF_UNIX, SOCK_STREAM, 0)) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::strncpy(address.sun_path, file.c_str(), sizeof address.sun_path - 1);
    is_bound_ = bind(descriptor_, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0;
  }
  ~NamedSocket() { close(descriptor_); }
  bool is_bound() const { return is_bound_; }

 private:
  int descriptor_;
  bool is_bound_ = false;
};

TEST(InputFile, SpecialFilesAreRefusedAtOnce) {
  const TemporaryFolder folder;
  ASSERT_EQ(mkfifo((folder / "pipe").c_str(), 0600), 0);
  std::filesystem::create_symlink(folder / "pipe", folder / "link");
  const NamedSocket socket(folder / "socket");
  ASSERT_TRUE(socket.is_bound());
  EXPECT_THAT(error_of(folder / "pipe"),
              AllOf(HasSubstr("the scan cannot be read (it is a pipe)"), HasSubstr("/pipe")));
  EXPECT_THAT(error_of(folder / "link"), HasSubstr("it is a pipe"));
  EXPECT_THAT(error_of(folder / "socket"), HasSubstr("it is a socket"));
  EXPECT_THAT(error_of("/dev/null"), HasSubstr("it is a device"));
  EXPECT_THAT(error_of(folder.path()), HasSubstr("it is a folder"));
  EXPECT_THAT(error_of(folder / "none"), HasSubstr("No such file"));
}

TEST(InputFile, AFileIsNoLargerThanItsKindCanBe) {
  const TemporaryFolder folder;
  std::ofstream(folder / "a") << "";
  std::filesystem::resize_file(folder / "a", kImageFile.max_size + 1);  // sparse
  EXPECT_THAT(error_of(folder / "a", kImageFile),
              HasSubstr("has 268435457 bytes, more than any image (268435456)"));
  EXPECT_EQ(error_of(folder / "a", kScanFile), "");
  std::filesystem::resize_file(folder / "a", kImageFile.max_size);
  EXPECT_EQ(error_of(folder / "a", kImageFile), "");
}

TEST(InputFile, BytesAndStreamGiveTheContent) {
  const TemporaryFolder folder;
  std::string content;  // longer than a buffer of the stream
  for (int i = 0; i < 50'000; ++i) content += std::to_string(i) + "\n";
  std::ofstream(folder / "a", std::ios::binary) << content;
  InputFile file(folder / "a", kDataFile);
  EXPECT_EQ(file.size(), content.size());
  EXPECT_EQ(file.beginning(6), "0\n1\n2\n");
  const std::vector<std::uint8_t> bytes = file.bytes();
  EXPECT_EQ(std::string(bytes.begin(), bytes.end()), content);

  std::istream& stream = file.stream();
  std::size_t at = 0;
  int number = 0;
  for (std::string line; std::getline(stream, line); ++number) {
    ASSERT_EQ(line, std::to_string(number));
    at += line.size() + 1;
    ASSERT_EQ(stream.tellg(), std::streamoff(at));
  }
  EXPECT_EQ(number, 50'000);
}

TEST(InputFile, TheStreamSeeks) {
  const TemporaryFolder folder;
  std::ofstream(folder / "a", std::ios::binary) << "0123456789";
  InputFile file(folder / "a", kDataFile);
  std::istream& stream = file.stream();
  EXPECT_EQ(stream.get(), '0');
  stream.seekg(7);
  EXPECT_EQ(stream.get(), '7');
  stream.seekg(-2, std::ios::cur);
  EXPECT_EQ(stream.get(), '6');
  stream.seekg(-1, std::ios::end);
  EXPECT_EQ(stream.get(), '9');
  EXPECT_EQ(stream.get(), std::char_traits<char>::eof());
}

TEST(InputFile, ANameThatIsFreeIsNoSpecialFile) {
  const TemporaryFolder folder;
  EXPECT_NO_THROW(require_regular_if_present(folder / "none", kStreamedFile));
  std::ofstream(folder / "a") << "x";
  EXPECT_NO_THROW(require_regular_if_present(folder / "a", kStreamedFile));
  ASSERT_EQ(mkfifo((folder / "pipe").c_str(), 0600), 0);
  EXPECT_THROW(require_regular_if_present(folder / "pipe", kStreamedFile), InputError);
}

}  // namespace fovea::input_file_test
