#include "fovea/exporting/tileset/glb_reader.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "../../../../tests/temporary_folder.h"
#include "fovea/errors.h"
#include "fovea/exporting/tileset/glb.h"

namespace fovea::glb_reader_test {

using testing::HasSubstr;

std::vector<ExportPoint> some_points() {
  std::vector<ExportPoint> points(3);
  points[0].position = {10, -20, 30};
  points[1].position = {14.7, -21, 30};
  points[2].position = {10, -20, 33.1};
  points[0].color = {0, 128, 255};
  points[0].camera = 3;
  points[0].frame = 123'456;
  points[0].range = 12.34f;
  points[0].incidence = 0.5f;
  points[0].reason = 0x12;
  points[0].interpolated = 1;
  points[0].views = 7;
  points[0].spread = 9;
  points[1].incidence = std::nanf("");
  return points;
}

TEST(GlbReader, ReadsBackWhatWasWritten) {
  const std::vector<ExportPoint> points = some_points();
  const Glb glb = make_glb(points, /*with_sources=*/true);
  const std::vector<ExportPoint> read = read_glb(glb.bytes, "a.glb");
  ASSERT_EQ(read.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_LT((read[i].position - points[i].position).cwiseAbs().maxCoeff(), 0.51 * glb.step);
    EXPECT_EQ(read[i].color, points[i].color);
    EXPECT_EQ(read[i].camera, points[i].camera);
  }
  EXPECT_EQ(read[0].frame, 123'456);
  EXPECT_NEAR(read[0].range, 12.34, 1e-4);
  EXPECT_NEAR(read[0].incidence, 0.5, 1e-4);
  EXPECT_EQ(read[0].reason, 0x12);
  EXPECT_EQ(read[0].interpolated, 1);
  EXPECT_EQ(read[0].views, 7);
  EXPECT_EQ(read[0].spread, 9);
  EXPECT_TRUE(std::isnan(read[1].incidence));
  EXPECT_EQ(make_glb(read, true).bytes.size(), glb.bytes.size());
}

TEST(GlbReader, ReadsPlainPoints) {
  const auto read = read_glb(make_glb(some_points(), /*with_sources=*/false).bytes, "a.glb");
  EXPECT_EQ(read[0].color, (Rgb{0, 128, 255}));
  EXPECT_TRUE(read_glb(make_glb({}, true).bytes, "a.glb").empty());
}

TEST(GlbReader, TheHeadStatesTheBox) {
  const std::string bytes = make_glb(some_points(), true).bytes.substr(0, kGlbHead);
  const Eigen::AlignedBox3d box = glb_box(bytes, "a.glb");
  EXPECT_NEAR(box.min().y(), -21, 1e-3);
  EXPECT_NEAR(box.max().z(), 33.1, 1e-3);
  EXPECT_TRUE(glb_box(make_glb({}, true).bytes, "a.glb").isEmpty());
}

TEST(GlbReader, ReadsOnlyTheLevelThatIsRequested) {
  const std::vector<ExportPoint> points = some_points();
  const std::vector<std::size_t> levels{3, 2, 1};
  const std::string bytes = make_glb(points, /*with_sources=*/true, levels).bytes;
  const TemporaryFolder folder;
  std::ofstream(folder / "a.glb") << bytes;
  const InputFile file(folder / "a.glb", kStreamedFile);
  for (const std::size_t level : {0, 1, 2, 9}) {
    const std::size_t expected = levels[std::min<std::size_t>(level, 2)];
    const auto of_bytes = read_glb_level(bytes, level, "a.glb"),
               of_file = read_glb_level(file, level);
    ASSERT_EQ(of_bytes.size(), expected);
    ASSERT_EQ(of_file.size(), expected);
    for (std::size_t i = 0; i < expected; ++i) {
      EXPECT_EQ(of_file[i].position, of_bytes[i].position);
      EXPECT_EQ(of_file[i].color, points[i].color);
      EXPECT_EQ(of_file[i].views, points[i].views);
    }
  }
  EXPECT_EQ(read_glb(bytes, "a.glb").size(), 3u);
  EXPECT_EQ(read_glb_level(make_glb(points, true).bytes, 2, "a.glb").size(), 3u) << "no levels";
  EXPECT_TRUE(read_glb_level(make_glb({}, true, levels).bytes, 2, "a.glb").empty());
}

TEST(GlbReader, ImpossibleLevelsAreErrors) {
  const std::string whole = make_glb(some_points(), true, std::vector<std::size_t>{3, 1}).bytes;
  for (const std::string& levels : {std::string("[3,4]"), std::string("[3,x]")}) {
    std::string other = whole;
    other.replace(other.find("[3,1]"), 5, levels);
    EXPECT_THROW(read_glb_level(other, 1, "a.glb"), InputError) << levels;
  }
}

/// The file with other numbers for a text of the same length.
std::string with(std::string bytes, const std::string& text, std::string other) {
  other.resize(text.size(), ' ');
  return bytes.replace(bytes.find(text), text.size(), other);
}

TEST(GlbReader, ImpossiblePositionsAreErrors) {
  const Glb glb = make_glb(some_points(), true);
  constexpr std::string_view kMatrix = "\"matrix\":[";
  const std::size_t begin = glb.bytes.find(kMatrix) + kMatrix.size();
  const std::string step = glb.bytes.substr(begin, glb.bytes.find(',', begin) - begin);
  for (const char* impossible : {"0", "-1", "1e300", "1e5"}) {
    EXPECT_THROW(read_glb(with(glb.bytes, step, impossible), "a.glb"), InputError) << impossible;
  }
  EXPECT_THROW(read_glb(with(glb.bytes, ",10,30,21,1]", ",1e9,0,0,1]"), "a.glb"), InputError);
  EXPECT_THROW(read_glb(with(glb.bytes, "\"max\":[65535", "\"max\":[-1"), "a.glb"), InputError);
}

TEST(GlbReader, WhatIsNoCountIsAnError) {
  const std::string bytes = make_glb(some_points(), true).bytes;
  // The reader needs no types and no lengths, so that their space is free for other numbers.
  const auto is_refused = [&](const std::string& text, const std::string& other) {
    EXPECT_THROW(read_glb(with(bytes, text, other), "a.glb"), InputError) << other;
  };
  is_refused(R"("count":3,"type":"VEC4")", R"("count":3.5,"t":"VEC4")");
  is_refused(R"("count":3,"type":"VEC4")", R"("count":1e30,"t":"VEC4")");
  is_refused(R"("bufferView":1,"componentType")", R"("bufferView":1.5,"type")");
  is_refused(R"("bufferView":1,"componentType")", R"("bufferView":1e24,"type")");
  is_refused(R"("byteOffset":24,"byteLength")", R"("byteOffset":24.5,"bytes")");
}

TEST(GlbReader, AnImpossibleFrameIsAnError) {
  const std::string whole = make_glb(some_points(), true).bytes;
  const float frame = 123'456;
  const std::string known(reinterpret_cast<const char*>(&frame), sizeof(frame));
  for (const float impossible : {1e32f, -1e32f, std::nanf("")}) {
    const std::string other(reinterpret_cast<const char*>(&impossible), sizeof(impossible));
    std::string bytes = whole;
    bytes.replace(bytes.rfind(known), known.size(), other);
    EXPECT_THROW(read_glb(bytes, "a.glb"), InputError) << impossible;
  }
}

TEST(GlbReader, DamagedFilesAreErrors) {
  const std::string whole = make_glb(some_points(), true).bytes;
  for (const std::size_t size :
       {std::size_t{0}, std::size_t{3}, std::size_t{15}, std::size_t{100}, whole.size() - 1}) {
    EXPECT_THROW(read_glb(whole.substr(0, size), "a.glb"), InputError) << size;
  }
  std::string other = whole;
  other.replace(other.find("POSITION"), 8, "POSITIOM");
  EXPECT_THROW(read_glb(other, "a.glb"), InputError);
  other = whole;
  other.replace(other.find("\"count\":3"), 9, "\"count\":9");
  EXPECT_THROW(read_glb(other, "a.glb"), InputError);
  try {
    read_glb("no glTF", "a.glb");
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("a.glb"));
  }
}

}  // namespace fovea::glb_reader_test
