// Numbers as a plane of differences (docs/map-format.md). Private to map/.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace fovea {

inline constexpr std::size_t kPlaneBytes = 2;  // of a number

/// The differences' lower bytes, then their upper ones.
void pack_plane(std::span<const std::uint16_t> values, std::byte* bytes);
void unpack_plane(std::size_t n, const std::byte* bytes, std::vector<std::uint16_t>& values);

}  // namespace fovea
