// What binary glTF 2.0 files have in common: their container, buffers, axes and colours.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <string>

#include "fovea/platform.h"

namespace fovea {

/// glTF's numbers for the types of components.
enum class GltfType : int {
  kByte = 5120,
  kUnsignedByte = 5121,
  kUnsignedShort = 5123,
  kUnsignedInt = 5125,
  kFloat = 5126
};

/// Values of one kind, which lie one behind the other.
struct GltfColumn {
  GltfType component;
  bool normalized;
  const char* type;    ///< "SCALAR", "VEC2", ...
  std::size_t stride;  ///< bytes; of vertices' attributes a multiple of 4
  bool indices = false;
};

/// The accessors of a file's one buffer, each with a view of its own.
class GltfBuffer {
 public:
  /// One more behind those before; its bytes are to be filled up to a multiple of 4.
  /// @param bounds  more members of the accessor's object, each with a comma before it
  /// @return its number
  std::size_t add(const GltfColumn& column, std::size_t count, const std::string& bounds = "");
  std::size_t bytes() const { return bytes_; }
  /// The members accessors, bufferViews and buffers of the file's object.
  std::string json() const;

 private:
  std::size_t count_ = 0, bytes_ = 0;
  std::string accessors_, views_;
};

/// An object's begin, with the member asset and a comma behind it.
std::string gltf_begin();

/// A file's bytes before its binary chunk's content.
/// @param json    an object
/// @param binary  bytes of that content, a multiple of 4; 0: there is none
std::string glb_head(std::string json, std::size_t binary);

/// A file with a scene of nothing.
std::string empty_glb();

/// The matrix of a node that holds z-up coordinates: glTF's axes are y up, x stays.
/// @param step  m, of the coordinates
/// @param low   m, z up: where they count from
std::string gltf_matrix(double step, const Eigen::Vector3d& low);

/// Linear light of a channel of sRGB (IEC 61966-2-1), 16 bits: glTF's colours are light.
std::uint16_t linear_light(std::uint8_t channel);

}  // namespace fovea
