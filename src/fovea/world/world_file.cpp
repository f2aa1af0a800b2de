#include "fovea/world/world_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <nlohmann/json.hpp>
#include <utility>

#include "fovea/core/input_file.h"
#include "fovea/core/nesting.h"
#include "fovea/core/output_file.h"
#include "fovea/errors.h"
#include "fovea/world/mesh_ply.h"

namespace fovea {
namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

Json to_json(const Material& m) {
  return {{"name", m.name},
          {"pattern", to_string(m.pattern)},
          {"color", {m.color.x(), m.color.y(), m.color.z()}},
          {"color_2", {m.color_2.x(), m.color_2.y(), m.color_2.z()}},
          {"scale", m.scale},
          {"size", {m.size.x(), m.size.y()}},
          {"contrast", m.contrast},
          {"seed", m.seed},
          {"text", m.text},
          {"gloss", m.gloss},
          {"reflectance", m.reflectance},
          {"glass", m.glass}};
}

template <int N>
Eigen::Matrix<float, N, 1> vector_of(const Json& json) {
  const auto numbers = json.get<std::array<float, N>>();
  if (json.size() != N) throw std::invalid_argument(fmt::format("{} numbers expected", N));
  return Eigen::Map<const Eigen::Matrix<float, N, 1>>(numbers.data());
}

/// The library converts what it finds, and 1e300 to no integer that there is.
std::uint32_t seed_of(const Json& json) {
  if (!json.is_number_unsigned() || !std::in_range<std::uint32_t>(json.get<std::uint64_t>())) {
    throw std::invalid_argument("a seed is no whole number");
  }
  return static_cast<std::uint32_t>(json.get<std::uint64_t>());
}

Material material_of(const Json& json) {
  Material m;
  m.name = json.at("name").get<std::string>();
  m.pattern = parse_pattern(json.at("pattern").get<std::string>());
  m.color = vector_of<3>(json.at("color"));
  m.color_2 = vector_of<3>(json.at("color_2"));
  m.scale = json.at("scale").get<float>();
  m.size = vector_of<2>(json.at("size"));
  m.contrast = json.at("contrast").get<float>();
  m.seed = seed_of(json.at("seed"));
  m.text = json.at("text").get<std::string>();
  m.gloss = json.at("gloss").get<float>();
  m.reflectance = json.at("reflectance").get<float>();
  m.glass = json.at("glass").get<bool>();
  return m;
}

std::uint32_t surface_id(const std::string& key) {
  std::uint32_t id = 0;
  const char* end = key.data() + key.size();
  const auto [rest, error] = std::from_chars(key.data(), end, id);
  if (error != std::errc() || rest != end) {
    throw std::invalid_argument("a surface has the id \"" + key + "\"");
  }
  return id;
}

void read_lists(const fs::path& file, World& world) {
  const std::vector<std::uint8_t> bytes = InputFile(file, kDescriptionFile).bytes();
  if (nesting_depth({reinterpret_cast<const char*>(bytes.data()), bytes.size()}) > kMaxNesting) {
    throw InputError("the world's materials are nested too deep", file.string(), kWorldRemedy);
  }
  try {
    const Json json = Json::parse(bytes);
    for (const Json& material : json.at("materials")) {
      world.materials.push_back(material_of(material));
    }
    for (const auto& [key, kind] : json.at("surfaces").items()) {
      world.surfaces[surface_id(key)] = kind.get<std::string>();
    }
  } catch (const std::exception& error) {  // nlohmann's, parse_pattern's and ours
    throw InputError(fmt::format("the world's materials are damaged ({})", error.what()),
                     file.string(), kWorldRemedy);
  }
}

}  // namespace

void write_world(const World& world, const fs::path& folder) {
  write_mesh(world.mesh_local, folder / "world.ply");
  Json json;
  json["materials"] = Json::array();
  for (const Material& material : world.materials) json["materials"].push_back(to_json(material));
  json["surfaces"] = Json::object();
  for (const auto& [id, kind] : world.surfaces) json["surfaces"][fmt::format("{}", id)] = kind;
  OutputFile output(folder / "world.json", /*force=*/true);
  output.stream() << json.dump(1, ' ', false, Json::error_handler_t::replace) << "\n";
  output.commit();
}

World read_world(const fs::path& folder) {
  World world;
  read_lists(folder / "world.json", world);
  const fs::path mesh_file = folder / "world.ply";
  world.mesh_local = read_mesh(mesh_file);
  const auto& used = world.mesh_local.material;
  const auto highest = std::max_element(used.begin(), used.end());
  if (highest != used.end() && *highest >= world.materials.size()) {
    throw InputError(fmt::format("a triangle names material {}, world.json has {}", *highest,
                                 world.materials.size()),
                     mesh_file.string(), kWorldRemedy);
  }
  return world;
}

}  // namespace fovea
