// The bytes of a recording, from its beginning to its end.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "fovea/core/input_file.h"

namespace fovea {

class BagStream {
 public:
  /// @param shown  name of the file in errors
  BagStream(const std::filesystem::path& file, const std::filesystem::path& shown);

  const std::string& name() const { return name_; }
  std::uint64_t size() const { return size_; }
  std::uint64_t place() const { return place_; }  ///< of the next byte
  std::uint64_t left() const { return size_ - place_; }
  /// "FILE, byte N", of the next byte.
  std::string here() const;
  /// The report of a file that ends early.
  /// @param place  up to which it was read
  std::string cut_short_at(std::uint64_t place) const;

  /// The next bytes, valid until the next call. InputError if a block has more than kMaxBagBlock.
  /// @param size  at most left()
  std::string_view take(std::uint64_t size);
  /// @param size  as above
  void skip(std::uint64_t size);

 private:
  std::string name_;
  InputFile input_;
  std::istream& stream_;
  std::uint64_t size_, place_ = 0;
  std::string buffer_;
};

}  // namespace fovea
