#include "fovea/simulation/traced_mesh.h"

#include <tbb/task_arena.h>

#include <algorithm>
#include <cstdint>
#include <new>
#include <utility>

namespace fovea {

using Eigen::Vector3d;
using Eigen::Vector3f;

EmbreeScene new_scene(RTCDevice device) {
  EmbreeScene scene(rtcNewScene(device));
  rtcSetSceneFlags(scene.get(), RTC_SCENE_FLAG_ROBUST);  // no ray slips between neighbours
  return scene;
}

void commit(RTCScene scene) {
  tbb::task_arena(1).execute([&] { rtcJoinCommitScene(scene); });
}

TracedMesh trace(RTCDevice device, TriangleMesh mesh, const Vector3d& center) {
  TracedMesh traced{std::move(mesh), center, new_scene(device)};
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0,
                                                               RTC_FORMAT_FLOAT3, 3 * sizeof(float),
                                                               traced.mesh.position.size()));
  auto* indices = static_cast<std::uint32_t*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                              3 * sizeof(std::uint32_t), traced.mesh.size()));
  if (vertices == nullptr || indices == nullptr) throw std::bad_alloc();
  for (std::size_t i = 0; i < traced.mesh.position.size(); ++i) {
    Eigen::Map<Vector3f>(vertices + 3 * i) = (traced.mesh.position[i] - center).cast<float>();
  }
  for (std::size_t i = 0; i < traced.mesh.size(); ++i) {
    std::copy(traced.mesh.triangle[i].begin(), traced.mesh.triangle[i].end(), indices + 3 * i);
  }
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(traced.scene.get(), geometry);
  rtcReleaseGeometry(geometry);
  commit(traced.scene.get());
  return traced;
}

RTCRay make_ray(const Vector3d& from, const Vector3d& along, double min, double max) {
  RTCRay ray{};
  ray.org_x = static_cast<float>(from.x());
  ray.org_y = static_cast<float>(from.y());
  ray.org_z = static_cast<float>(from.z());
  ray.dir_x = static_cast<float>(along.x());
  ray.dir_y = static_cast<float>(along.y());
  ray.dir_z = static_cast<float>(along.z());
  ray.tnear = static_cast<float>(min);
  ray.tfar = static_cast<float>(max);
  ray.mask = ~0u;
  return ray;
}

void fill_ray(RTCRay8& rays, std::size_t i, const Vector3d& from, const Vector3d& along, double min,
              double max) {
  const RTCRay ray = make_ray(from, along, min, max);
  rays.org_x[i] = ray.org_x;
  rays.org_y[i] = ray.org_y;
  rays.org_z[i] = ray.org_z;
  rays.dir_x[i] = ray.dir_x;
  rays.dir_y[i] = ray.dir_y;
  rays.dir_z[i] = ray.dir_z;
  rays.tnear[i] = ray.tnear;
  rays.tfar[i] = ray.tfar;
  rays.mask[i] = ray.mask;
}

}  // namespace fovea
