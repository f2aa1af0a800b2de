#include "fovea/world/mesh_ply.h"

#include <fmt/format.h>

#include <bit>
#include <charconv>
#include <cstring>

#include "fovea/core/input_file.h"
#include "fovea/core/output_file.h"
#include "fovea/errors.h"

namespace fovea {
namespace {

static_assert(std::endian::native == std::endian::little, "the files are little endian");

constexpr std::size_t kVertexBytes = 3 * sizeof(double) + 3 * sizeof(float);
constexpr std::size_t kFaceBytes = 1 + 3 * sizeof(std::int32_t) + 2 + sizeof(std::uint32_t);
constexpr std::size_t kBlock = 1 << 14;  // elements read or written at once

std::string header(std::size_t vertices, std::size_t faces) {
  return fmt::format(
      "ply\nformat binary_little_endian 1.0\n"
      "element vertex {}\n"
      "property double x\nproperty double y\nproperty double z\n"
      "property float s\nproperty float t\nproperty float r\n"
      "element face {}\n"
      "property list uchar int vertex_indices\n"
      "property ushort material\nproperty uint surface\nend_header\n",
      vertices, faces);
}

template <class T>
char* put(char* out, const T& value) {
  std::memcpy(out, &value, sizeof value);
  return out + sizeof value;
}

template <class T>
const char* take(const char* in, T& value) {
  std::memcpy(&value, in, sizeof value);
  return in + sizeof value;
}

void put_vertex(const TriangleMesh& mesh, std::size_t v, char* out) {
  for (int k = 0; k < 3; ++k) out = put(out, mesh.position[v][k]);
  for (int k = 0; k < 3; ++k) out = put(out, mesh.texture[v][k]);
}

void put_face(const TriangleMesh& mesh, std::size_t t, char* out) {
  out = put(out, std::uint8_t{3});
  for (const std::uint32_t v : mesh.triangle[t]) out = put(out, v);
  out = put(out, mesh.material[t]);
  put(out, mesh.surface[t]);
}

/// Calls put(i, place) for each of `count` elements of `bytes` each, and writes them.
template <class Put>
void write_elements(std::ostream& stream, std::size_t count, std::size_t bytes,
                    const Put& put_one) {
  std::vector<char> buffer(kBlock * bytes);
  for (std::size_t begin = 0; begin < count; begin += kBlock) {
    const std::size_t n = std::min(kBlock, count - begin);
    for (std::size_t i = 0; i < n; ++i) put_one(begin + i, buffer.data() + i * bytes);
    stream.write(buffer.data(), static_cast<std::streamsize>(n * bytes));
  }
}

class MeshFile {
 public:
  explicit MeshFile(const std::filesystem::path& file)
      : name_(file.string()), input_(file, kStreamedFile), stream_(input_.stream()) {}

  TriangleMesh read() {
    const auto [vertices, faces] = read_counts();
    const std::string expected = header(vertices, faces);
    std::string found(expected.size(), '\0');
    stream_.seekg(0);
    stream_.read(found.data(), static_cast<std::streamsize>(found.size()));
    if (found != expected) reject("the header is not that of a world's mesh");
    // Before anything is allocated: the counts of a damaged header can be anything.
    if (vertices > input_.size() / kVertexBytes || faces > input_.size() / kFaceBytes ||
        input_.size() != expected.size() + vertices * kVertexBytes + faces * kFaceBytes) {
      reject(fmt::format("the file's size does not fit {} vertices and {} faces", vertices, faces));
    }
    read_vertices(vertices);
    read_faces(faces);
    return std::move(mesh_);
  }

 private:
  [[noreturn]] void reject(const std::string& what) const {
    throw InputError(what, name_, kWorldRemedy);
  }

  std::size_t read_count(std::string_view keyword) {
    for (std::string line; std::getline(stream_, line) && line != "end_header";) {
      if (!line.starts_with(keyword)) continue;
      std::size_t count = 0;
      const char *begin = line.data() + keyword.size(), *end = line.data() + line.size();
      const auto [rest, error] = std::from_chars(begin, end, count);
      if (error == std::errc() && rest == end) return count;
    }
    reject(fmt::format("the header has no line \"{}N\"", keyword));
  }

  std::pair<std::size_t, std::size_t> read_counts() {
    const std::size_t vertices = read_count("element vertex ");
    return {vertices, read_count("element face ")};
  }

  template <class Take>
  void read_elements(std::size_t count, std::size_t bytes, const Take& take_one) {
    std::vector<char> buffer(kBlock * bytes);
    for (std::size_t begin = 0; begin < count; begin += kBlock) {
      const std::size_t n = std::min(kBlock, count - begin);
      if (!stream_.read(buffer.data(), static_cast<std::streamsize>(n * bytes))) {
        reject("the file cannot be read to its end");
      }
      for (std::size_t i = 0; i < n; ++i) take_one(begin + i, buffer.data() + i * bytes);
    }
  }

  void read_vertices(std::size_t count) {
    mesh_.position.resize(count);
    mesh_.texture.resize(count);
    read_elements(count, kVertexBytes, [&](std::size_t v, const char* in) {
      for (int k = 0; k < 3; ++k) in = take(in, mesh_.position[v][k]);
      for (int k = 0; k < 3; ++k) in = take(in, mesh_.texture[v][k]);
      if (!mesh_.position[v].allFinite() || !mesh_.texture[v].allFinite()) {
        reject(fmt::format("vertex {} is not finite", v));
      }
    });
  }

  void read_faces(std::size_t count) {
    mesh_.triangle.resize(count);
    mesh_.material.resize(count);
    mesh_.surface.resize(count);
    read_elements(count, kFaceBytes, [&](std::size_t t, const char* in) {
      std::uint8_t corners = 0;
      in = take(in, corners);
      if (corners != 3) reject(fmt::format("face {} has {} corners", t, corners));
      for (std::uint32_t& v : mesh_.triangle[t]) {
        in = take(in, v);
        if (v >= mesh_.position.size()) reject(fmt::format("face {} names vertex {}", t, v));
      }
      in = take(in, mesh_.material[t]);
      take(in, mesh_.surface[t]);
    });
  }

  std::string name_;
  InputFile input_;
  std::istream& stream_;
  TriangleMesh mesh_;
};

}  // namespace

void write_mesh(const TriangleMesh& mesh, const std::filesystem::path& file) {
  mesh.check();
  OutputFile output(file, /*force=*/true);
  output.stream() << header(mesh.position.size(), mesh.size());
  write_elements(output.stream(), mesh.position.size(), kVertexBytes,
                 [&](std::size_t v, char* out) { put_vertex(mesh, v, out); });
  write_elements(output.stream(), mesh.size(), kFaceBytes,
                 [&](std::size_t t, char* out) { put_face(mesh, t, out); });
  output.commit();
}

TriangleMesh read_mesh(const std::filesystem::path& file) { return MeshFile(file).read(); }

}  // namespace fovea
