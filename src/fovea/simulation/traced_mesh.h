// Triangle meshes in the structures of Embree, which finds the triangle that a ray meets.
#pragma once

#include <embree3/rtcore.h>

#include <cstddef>
#include <memory>
#include <type_traits>

#include "fovea/world/triangle_mesh.h"

namespace fovea {

struct ReleaseDevice {
  void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
};
struct ReleaseScene {
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};
using EmbreeDevice = std::unique_ptr<std::remove_pointer_t<RTCDevice>, ReleaseDevice>;
using EmbreeScene = std::unique_ptr<std::remove_pointer_t<RTCScene>, ReleaseScene>;

/// Triangles and the tree that finds them. The tree has float vertices relative to `center`.
struct TracedMesh {
  TriangleMesh mesh;
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  EmbreeScene scene;
};

EmbreeScene new_scene(RTCDevice device);

/// Builds the tree of a scene on one thread. Which of two equally near triangles Embree reports
/// depends on the tree, and the same seed must give the same bytes at any number of threads. (The
/// option "threads=1" of the device would hold back every thread of the program.)
void commit(RTCScene scene);

TracedMesh trace(RTCDevice device, TriangleMesh mesh, const Eigen::Vector3d& center);

RTCRay make_ray(const Eigen::Vector3d& from, const Eigen::Vector3d& along, double min, double max);

/// Sets one ray of a packet.
void fill_ray(RTCRay8& rays, std::size_t i, const Eigen::Vector3d& from,
              const Eigen::Vector3d& along, double min, double max);

}  // namespace fovea
