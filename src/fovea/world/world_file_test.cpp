#include "fovea/world/world_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "../../../tests/file_content.h"
#include "../../../tests/temporary_folder.h"
#include "fovea/errors.h"

namespace fovea::world_file_test {

namespace fs = std::filesystem;

World small_world() {
  World world;
  TriangleMesh& mesh = world.mesh_local;
  mesh.position = {{0.1, 1.0 / 3, 12345.678901}, {1, 0, 0}, {0, 1, 0}, {1e-9, -1, 7}};
  mesh.texture = {{0.1f, 0.2f, 0.3f}, {1, 0, 0}, {0, 1, 0}, {5, 6, 7}};
  mesh.triangle = {{0, 1, 2}, {3, 2, 1}};
  mesh.material = {1, 0};
  mesh.surface = {7, 70'000};
  Material plain;
  plain.name = "plaster";
  Material sign;
  sign.name = "sign \"A\"";
  sign.pattern = Pattern::kLettering;
  sign.color = {0.1f, 0.2f, 0.3f};
  sign.color_2 = {0.9f, 0.8f, 0.7f};
  sign.scale = 0.05f;
  sign.size = {1.5f, 0.4f};
  sign.contrast = 0.3f;
  sign.seed = 4'000'000'000u;
  sign.text = "HAUPTSTRASSE 5";
  sign.gloss = 0.04f;
  sign.reflectance = 0.9f;
  sign.glass = true;
  world.materials = {plain, sign};
  world.surfaces = {{7, "house"}, {70'000, "parked car"}};
  return world;
}

void overwrite(const fs::path& file, const std::string& text) {
  std::ofstream(file, std::ios::binary) << text;
}

std::string error_of(const fs::path& folder) {
  try {
    read_world(folder);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(WorldFile, ReadsBackWhatItWrote) {
  const TemporaryFolder folder;
  const World world = small_world();
  write_world(world, folder.path());
  const World read = read_world(folder.path());
  EXPECT_EQ(read.mesh_local.position, world.mesh_local.position);
  EXPECT_EQ(read.mesh_local.texture, world.mesh_local.texture);
  EXPECT_EQ(read.mesh_local.triangle, world.mesh_local.triangle);
  EXPECT_EQ(read.mesh_local.material, world.mesh_local.material);
  EXPECT_EQ(read.mesh_local.surface, world.mesh_local.surface);
  EXPECT_EQ(read.surfaces, world.surfaces);
  ASSERT_EQ(read.materials.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    const Material &a = read.materials[i], &b = world.materials[i];
    EXPECT_EQ(a.name, b.name);
    EXPECT_EQ(a.pattern, b.pattern);
    EXPECT_EQ(a.color, b.color);
    EXPECT_EQ(a.color_2, b.color_2);
    EXPECT_EQ(a.scale, b.scale);
    EXPECT_EQ(a.size, b.size);
    EXPECT_EQ(a.contrast, b.contrast);
    EXPECT_EQ(a.seed, b.seed);
    EXPECT_EQ(a.text, b.text);
    EXPECT_EQ(a.gloss, b.gloss);
    EXPECT_EQ(a.reflectance, b.reflectance);
    EXPECT_EQ(a.glass, b.glass);
  }
  EXPECT_THAT(folder.names(), testing::ElementsAre("world.json", "world.ply"));
}

TEST(WorldFile, TheMeshIsAPlyFile) {
  const TemporaryFolder folder;
  write_world(small_world(), folder.path());
  const std::string text = content(folder / "world.ply");
  EXPECT_TRUE(text.starts_with("ply\nformat binary_little_endian 1.0\nelement vertex 4\n"));
  const std::size_t body = text.find("end_header\n") + 11;
  EXPECT_EQ(text.size() - body, 4u * 36 + 2u * 19);
}

TEST(WorldFile, AnEmptyWorldIsOne) {
  const TemporaryFolder folder;
  write_world({}, folder.path());
  EXPECT_TRUE(read_world(folder.path()).mesh_local.empty());
}

TEST(WorldFile, DamageIsNamedWithItsFile) {
  const TemporaryFolder folder;
  EXPECT_THAT(error_of(folder.path()), testing::HasSubstr("world.json"));
  write_world(small_world(), folder.path());
  const std::string mesh = content(folder / "world.ply"), json = content(folder / "world.json");
  const std::size_t body = mesh.find("end_header\n") + 11;
  const auto damaged = [&](std::size_t at, const std::string& bytes) {
    std::string text = mesh;
    text.replace(at, bytes.size(), bytes);
    overwrite(folder / "world.ply", text);
    return error_of(folder.path());
  };
  const std::size_t face = body + 4 * 36;
  EXPECT_THAT(damaged(0, "plx"), testing::HasSubstr("header"));
  EXPECT_THAT(damaged(mesh.find("vertex 4") + 7, "9"), testing::HasSubstr("size does not fit"));
  EXPECT_THAT(damaged(body + 6, "\xff\xff"), testing::HasSubstr("vertex 0 is not finite"));
  EXPECT_THAT(damaged(face, "\x04"), testing::HasSubstr("face 0 has 4 corners"));
  EXPECT_THAT(damaged(face + 1, "\x09"), testing::HasSubstr("face 0 names vertex 9"));
  EXPECT_THAT(damaged(face + 13, "\x05"), testing::HasSubstr("names material 5"));
  overwrite(folder / "world.ply", mesh.substr(0, mesh.size() - 1));
  EXPECT_THAT(error_of(folder.path()), testing::HasSubstr("size does not fit"));
  overwrite(folder / "world.ply", "");
  EXPECT_THAT(error_of(folder.path()), testing::HasSubstr("world.ply"));
  fs::remove(folder / "world.ply");
  EXPECT_THAT(error_of(folder.path()), testing::HasSubstr("world.ply"));

  overwrite(folder / "world.ply", mesh);
  EXPECT_EQ(error_of(folder.path()), "no error");
  for (const std::string& bad :
       {std::string("{"), std::string("[]"), std::string(R"({"materials": [{}], "surfaces": {}})"),
        std::string(R"({"materials": [], "surfaces": {"x": "house"}})")}) {
    overwrite(folder / "world.json", bad);
    EXPECT_THAT(error_of(folder.path()), testing::HasSubstr("world.json")) << bad;
  }
  std::string unknown = json;
  unknown.replace(unknown.find("lettering"), 9, "scribbles");
  overwrite(folder / "world.json", unknown);
  EXPECT_THAT(error_of(folder.path()), testing::HasSubstr("damaged"));
  std::string endless = json;
  const std::size_t seed = endless.find("\"seed\": ") + 8;
  endless.replace(seed, endless.find(',', seed) - seed, "1e300");
  overwrite(folder / "world.json", endless);
  EXPECT_THAT(error_of(folder.path()), testing::HasSubstr("no whole number"));
}

TEST(WorldFile, AMissingFolderIsAnOutputError) {
  const TemporaryFolder folder;
  EXPECT_THROW(write_world(small_world(), folder / "missing"), OutputError);
}

}  // namespace fovea::world_file_test
