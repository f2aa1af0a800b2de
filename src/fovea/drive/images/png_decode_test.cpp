#include "fovea/drive/images/png_decode.h"

#include <gtest/gtest.h>
#include <png.h>

#include <optional>
#include <stdexcept>
#include <string>

#include "../../../../tests/peak_memory.h"
#include "fovea/core/random.h"
#include "fovea/drive/images/image_decode.h"
#include "fovea/drive/images/png_plain_decode.h"

namespace fovea::png_decode_test {

using Bytes = std::vector<std::uint8_t>;

struct Kind {
  int color_type = PNG_COLOR_TYPE_RGB;
  int filters = PNG_ALL_FILTERS;
  int bits = 8;
  bool interlaced = false;
  bool note = false;  // a text before the samples
  std::size_t piece = 8192;
};

int channels_of(int color_type) {
  const bool alpha = (color_type & PNG_COLOR_MASK_ALPHA) != 0;
  return ((color_type & PNG_COLOR_MASK_COLOR) != 0 ? 3 : 1) + (alpha ? 1 : 0);
}

/// Smooth with noise, as photographs are, so that all filters are chosen and all their cases meet.
Bytes natural_samples(int width, int height, int channels, std::uint64_t seed) {
  Random random(seed);
  Bytes samples;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      for (int c = 0; c < channels; ++c) {
        const bool noise = random.below(16) == 0;
        samples.push_back(static_cast<std::uint8_t>(noise ? random.below(256)
                                                          : 3 * x + 5 * y * (c + 1) + 40 * c));
      }
    }
  }
  return samples;
}

void append(png_structp png, png_bytep data, std::size_t count) {
  auto& file = *static_cast<Bytes*>(png_get_io_ptr(png));
  file.insert(file.end(), data, data + count);
}

[[noreturn]] void fail(png_structp, png_const_charp message) { throw std::logic_error(message); }

/// A file as libpng writes it: an independent source of all kinds.
Bytes png_file(int width, int height, const Bytes& samples, const Kind& kind) {
  Bytes file;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, &fail, nullptr);
  png_infop info = png_create_info_struct(png);
  png_set_write_fn(png, &file, &append, nullptr);
  png_set_compression_buffer_size(png, kind.piece);
  png_set_IHDR(png, info, static_cast<png_uint_32>(width), static_cast<png_uint_32>(height),
               kind.bits, kind.color_type,
               kind.interlaced ? PNG_INTERLACE_ADAM7 : PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_set_filter(png, PNG_FILTER_TYPE_BASE, kind.filters);
  if (kind.note) png_set_gAMA(png, info, 0.45455);
  Bytes rows = samples;
  std::vector<png_bytep> row;
  const std::size_t stride = rows.size() / static_cast<std::size_t>(height);
  for (int y = 0; y < height; ++y) row.push_back(rows.data() + stride * static_cast<unsigned>(y));
  png_set_rows(png, info, row.data());
  png_write_png(png, info, PNG_TRANSFORM_IDENTITY, nullptr);
  png_destroy_write_struct(&png, &info);
  return file;
}

/// What decode_png must make of the samples written: without alpha.
Bytes without_alpha(const Bytes& samples, int channels) {
  const int kept = channels < 3 ? 1 : 3;
  Bytes pixels;
  for (std::size_t i = 0; i < samples.size(); i += static_cast<std::size_t>(channels)) {
    for (int c = 0; c < kept; ++c) pixels.push_back(samples[i + static_cast<std::size_t>(c)]);
  }
  return pixels;
}

struct Outcome {
  std::optional<Image> image;
  std::string error;
};

template <class Decode>
Outcome outcome_of(const Bytes& file, Decode decode) {
  try {
    return {decode(file), ""};
  } catch (const std::runtime_error& error) {
    return {std::nullopt, error.what()};
  }
}

void expect_as_libpng(const Bytes& file, const std::string& what) {
  const Outcome ours = outcome_of(file, &decode_png);
  const Outcome theirs = outcome_of(file, &decode_png_by_libpng);
  ASSERT_EQ(ours.error, theirs.error) << what;
  ASSERT_EQ(ours.image.has_value(), theirs.image.has_value()) << what;
  if (!ours.image) return;
  ASSERT_EQ(ours.image->width, theirs.image->width) << what;
  ASSERT_EQ(ours.image->height, theirs.image->height) << what;
  ASSERT_EQ(ours.image->channels, theirs.image->channels) << what;
  ASSERT_EQ(ours.image->data, theirs.image->data) << what;
}

constexpr std::array kColorTypes{PNG_COLOR_TYPE_GRAY, PNG_COLOR_TYPE_GRAY_ALPHA, PNG_COLOR_TYPE_RGB,
                                 PNG_COLOR_TYPE_RGB_ALPHA};

TEST(PngDecode, EveryFilterColourTypeAndWidthIsExact) {
  for (const int color_type : kColorTypes) {
    const int channels = channels_of(color_type);
    for (const int filters : {PNG_FILTER_NONE, PNG_FILTER_SUB, PNG_FILTER_UP, PNG_FILTER_AVG,
                              PNG_FILTER_PAETH, PNG_ALL_FILTERS}) {
      for (int width = 1; width <= 70; ++width) {
        const Bytes samples =
            natural_samples(width, 9, channels, static_cast<std::uint64_t>(width));
        const Bytes file = png_file(width, 9, samples, {color_type, filters});
        const std::optional<Image> image = decode_plain_png(file);
        ASSERT_TRUE(image) << color_type << " " << filters << " " << width;
        ASSERT_EQ(image->data, without_alpha(samples, channels))
            << color_type << " " << filters << " " << width;
        expect_as_libpng(file, "whole");
      }
    }
  }
}

TEST(PngDecode, SamplesInManyPiecesAndNotesBesideThem) {
  const Bytes samples = natural_samples(200, 120, 3, 1);
  for (const std::size_t piece : {6u, 100u, 8192u}) {
    const Bytes file = png_file(
        200, 120, samples, {PNG_COLOR_TYPE_RGB, PNG_ALL_FILTERS, 8, false, piece == 100u, piece});
    const std::optional<Image> image = decode_plain_png(file);
    ASSERT_TRUE(image) << piece;
    EXPECT_EQ(image->data, samples);
  }
}

TEST(PngDecode, OtherKindsAreLeftToLibpng) {
  const Bytes rgb = natural_samples(40, 30, 3, 2);
  Kind kind;
  kind.interlaced = true;
  const Bytes interlaced = png_file(40, 30, rgb, kind);
  EXPECT_FALSE(decode_plain_png(interlaced));
  EXPECT_EQ(decode_png(interlaced).data, rgb);

  const Bytes two_bytes =
      png_file(40, 30, natural_samples(40, 30, 2, 3), {PNG_COLOR_TYPE_GRAY, PNG_ALL_FILTERS, 16});
  EXPECT_FALSE(decode_plain_png(two_bytes));
  EXPECT_THROW(decode_png(two_bytes), std::runtime_error);

  const Bytes bits =
      png_file(40, 30, natural_samples(20, 30, 1, 4), {PNG_COLOR_TYPE_GRAY, PNG_ALL_FILTERS, 4});
  EXPECT_FALSE(decode_plain_png(bits));
  EXPECT_EQ(decode_png(bits).channels, 1);
}

TEST(PngDecode, EveryByteThatIsWrongIsNoticedAsByLibpng) {
  const Bytes file = png_file(12, 5, natural_samples(12, 5, 3, 5),
                              {PNG_COLOR_TYPE_RGB, PNG_ALL_FILTERS, 8, false, true, 20});
  for (std::size_t i = 0; i < file.size(); ++i) {
    for (const int flip : {1, 0x20, 0x80, 0xff}) {
      Bytes damaged = file;
      damaged[i] = static_cast<std::uint8_t>(damaged[i] ^ flip);
      ASSERT_FALSE(decode_plain_png(damaged)) << "byte " << i << " ^ " << flip;
      expect_as_libpng(damaged, "byte " + std::to_string(i) + " ^ " + std::to_string(flip));
    }
  }
}

TEST(PngDecode, EveryTruncationIsNoticedAsByLibpng) {
  const Bytes file = png_file(12, 5, natural_samples(12, 5, 4, 6),
                              {PNG_COLOR_TYPE_RGB_ALPHA, PNG_ALL_FILTERS, 8, false, true, 20});
  for (std::size_t size = 0; size < file.size(); ++size) {
    const Bytes part(file.begin(), file.begin() + static_cast<std::ptrdiff_t>(size));
    ASSERT_FALSE(decode_plain_png(part)) << size;
    expect_as_libpng(part, "the first " + std::to_string(size) + " bytes");
  }
}

std::uint32_t big_endian(const Bytes& bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t k = 0; k < 4; ++k) value = value << 8 | bytes[at + k];
  return value;
}

/// Recomputed for what was changed: without these, most damage stops at the first checksum.
void mend_checksums(Bytes& file) {
  for (std::size_t at = 8; at + 12 <= file.size();) {
    const std::size_t length = big_endian(file, at);
    if (length > file.size() - at - 12) return;
    std::uint32_t crc = ~0u;
    for (std::size_t i = at + 4; i < at + 8 + length; ++i) {
      crc ^= file[i];
      for (int bit = 0; bit < 8; ++bit) crc = crc >> 1 ^ ((crc & 1) != 0 ? 0xedb88320u : 0u);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      file[at + 8 + length + k] = static_cast<std::uint8_t>(~crc >> (24 - 8 * k));
    }
    at += 12 + length;
  }
}

TEST(PngDecode, DamageUnderRightChecksumsIsTakenAsByLibpng) {
  Random random(7);
  int decoded = 0;
  for (int round = 0; round < 6000; ++round) {
    const int color_type = kColorTypes[random.below(kColorTypes.size())];
    const int width = 1 + static_cast<int>(random.below(30));
    Bytes file =
        png_file(width, 7, natural_samples(width, 7, channels_of(color_type), random.next()),
                 {color_type, PNG_ALL_FILTERS, 8, false, random.below(2) == 0, 30});
    for (std::uint64_t flips = random.below(3); flips < 3; ++flips) {
      // The header often, where each byte decides; sizes stay small.
      const std::size_t at =
          random.below(4) == 0 ? 24 + random.below(5) : random.below(file.size());
      const bool is_size = at >= 16 && at < 24;
      file[at] = static_cast<std::uint8_t>(is_size ? file[at] & 0xf : random.below(256));
    }
    mend_checksums(file);
    expect_as_libpng(file, "round " + std::to_string(round));
    if (HasFatalFailure()) return;
    decoded += decode_plain_png(file) ? 1 : 0;
  }
  EXPECT_GT(decoded, 30);  // gAMA's numbers, for one, are nobody's business
}

TEST(PngDecode, FilterThatDoesNotExistIsAnError) {
  // One row of one grey pixel, stored: zlib's header, one last block of two bytes, Adler-32.
  for (const std::uint8_t filter : {std::uint8_t{0}, std::uint8_t{4}, std::uint8_t{5}}) {
    const auto adler_low = static_cast<std::uint8_t>(1 + filter + 9);
    const auto adler_high = static_cast<std::uint8_t>(1 + filter + adler_low);
    Bytes file{0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
    for (const Bytes& part :
         {Bytes{0, 0, 0, 13, 'I', 'H', 'D', 'R', 0, 0, 0, 1, 0, 0, 0, 1, 8, 0, 0, 0, 0, 0, 0, 0, 0},
          Bytes{0,    0,    0,      13, 'I', 'D',        'A', 'T',       0x08, 0x1d, 1, 2, 0,
                0xfd, 0xff, filter, 9,  0,   adler_high, 0,   adler_low, 0,    0,    0, 0},
          Bytes{0, 0, 0, 0, 'I', 'E', 'N', 'D', 0, 0, 0, 0}}) {
      file.insert(file.end(), part.begin(), part.end());
    }
    mend_checksums(file);
    EXPECT_EQ(decode_plain_png(file).has_value(), filter < 5) << int{filter};
    expect_as_libpng(file, "filter " + std::to_string(filter));
  }
}

TEST(PngDecode, SizesThatTheSamplesDoNotFillAreErrors) {
  for (const int height : {8, 10, static_cast<int>(kMaxImageSide) + 1}) {
    Bytes file = png_file(20, 9, natural_samples(20, 9, 3, 8), {});
    file[22] = static_cast<std::uint8_t>(height >> 8);
    file[23] = static_cast<std::uint8_t>(height & 0xff);
    mend_checksums(file);
    EXPECT_FALSE(decode_plain_png(file)) << height;
    expect_as_libpng(file, "height " + std::to_string(height));
  }
}

TEST(PngDecode, AChunkThatClaimsGigabytesTakesNoMemory) {
  Bytes file = png_file(7, 3, natural_samples(7, 3, 3, 10), {});
  file.resize(33);  // the header
  file.insert(file.end(), {0x7c, 0xff, 0xff, 0xff, 'z', 'T', 'X', 't', 'a', 0, 0});
  EXPECT_LT(rise_of_peak_memory(
                [&] { EXPECT_EQ(outcome_of(file, &decode_png).error, "the file is truncated"); }),
            kMemoryOfASmallFile);
}

TEST(PngDecode, SizesThatNoFileOfItsLengthHoldsAreRefusedBeforeMemoryIsTaken) {
  for (const int bits : {8, 16}) {
    Bytes file = png_file(20, 9, natural_samples(20, 9, bits / 8, 9),
                          {PNG_COLOR_TYPE_GRAY, PNG_ALL_FILTERS, bits});
    for (const std::size_t side : {18u, 22u}) {
      file[side] = kMaxImageSide >> 8;
      file[side + 1] = 0;
    }
    mend_checksums(file);
    const auto decode = [&](const Bytes& bytes) {
      if (bits == 16) decode_png_16(bytes);
      return decode_png(bytes);
    };
    EXPECT_EQ(outcome_of(file, decode).error, "the file is too short for its pixels") << bits;
  }
}

}  // namespace fovea::png_decode_test
