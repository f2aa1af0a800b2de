#include "fovea/world/surface_index.h"

#include <embree3/rtcore.h>

#include <limits>
#include <stdexcept>

namespace fovea {
namespace {

/// Owns one of Embree's reference-counted handles.
template <class Handle, void (*release)(Handle)>
struct Owned {
  Handle handle = nullptr;
  explicit Owned(Handle h) : handle(h) {}
  ~Owned() {
    if (handle != nullptr) release(handle);
  }
  Owned(const Owned&) = delete;
  Owned& operator=(const Owned&) = delete;
};

Eigen::Vector3d center_of(const TriangleMesh& mesh) {
  Eigen::Vector3d low = mesh.corner(0, 0), high = low;
  for (std::size_t t = 0; t < mesh.size(); ++t) {
    for (int k = 0; k < 3; ++k) {
      low = low.cwiseMin(mesh.corner(t, k));
      high = high.cwiseMax(mesh.corner(t, k));
    }
  }
  return 0.5 * (low + high);
}

/// What a query carries through Embree's callback.
struct Search {
  const TriangleMesh* mesh;
  Eigen::Vector3d p;
  double slack = 0;  ///< m, what float rounding can add to a distance that Embree sees
  double squared_distance = std::numeric_limits<double>::infinity();
  SurfacePoint nearest;
};

bool visit(RTCPointQueryFunctionArguments* arguments) {
  Search& search = *static_cast<Search*>(arguments->userPtr);
  const std::uint32_t triangle = arguments->primID;
  const SurfacePoint candidate = nearest_on_triangle(*search.mesh, triangle, search.p);
  const double squared = (candidate.position - search.p).squaredNorm();
  const bool nearer = squared < search.squared_distance;
  if (!nearer && !(squared == search.squared_distance && triangle < search.nearest.triangle)) {
    return false;
  }
  search.squared_distance = squared;
  search.nearest = candidate;
  // Embree culls by boxes around rounded corners: what it sees up to a slack farther away may be
  // nearer in truth, or as near with a lower number.
  const auto radius = static_cast<float>(std::sqrt(squared) + search.slack);
  if (!(radius < arguments->query->radius)) return false;
  arguments->query->radius = radius;
  return true;
}

}  // namespace

struct SurfaceIndex::Scene {
  const TriangleMesh& mesh;
  Eigen::Vector3d center;  // the corners are rounded relative to it
  double extent = 0;       // largest coordinate relative to it
  // One thread: the tree, and with it the time of a query, is the same in every run.
  Owned<RTCDevice, rtcReleaseDevice> device{rtcNewDevice(nullptr)};
  Owned<RTCScene, rtcReleaseScene> scene{nullptr};

  explicit Scene(const TriangleMesh& m) : mesh(m), center(center_of(m)) {
    require_no_error();
    scene.handle = rtcNewScene(device.handle);
    rtcSetSceneFlags(scene.handle, RTC_SCENE_FLAG_ROBUST);
    const Owned<RTCGeometry, rtcReleaseGeometry> geometry(
        rtcNewGeometry(device.handle, RTC_GEOMETRY_TYPE_TRIANGLE));
    fill(geometry.handle);
    rtcCommitGeometry(geometry.handle);
    rtcAttachGeometry(scene.handle, geometry.handle);
    rtcCommitScene(scene.handle);
    require_no_error();
  }

  void fill(RTCGeometry geometry) {
    auto* vertices = static_cast<float*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                3 * sizeof(float), mesh.position.size()));
    auto* triangles = static_cast<std::uint32_t*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                3 * sizeof(std::uint32_t), mesh.size()));
    require_no_error();
    for (const Eigen::Vector3d& p : mesh.position) {
      const Eigen::Vector3d relative = p - center;
      extent = std::max(extent, relative.cwiseAbs().maxCoeff());
      for (int k = 0; k < 3; ++k) *vertices++ = static_cast<float>(relative[k]);
    }
    for (const auto& corners : mesh.triangle) {
      triangles = std::copy(corners.begin(), corners.end(), triangles);
    }
  }

  void require_no_error() const {
    if (rtcGetDeviceError(device.handle) != RTC_ERROR_NONE) {
      throw std::runtime_error("Embree cannot index the surfaces (out of memory?)");
    }
  }
};

SurfaceIndex::SurfaceIndex(const TriangleMesh& mesh) {
  mesh.check();
  if (mesh.empty()) throw std::invalid_argument("surface index: the mesh is empty");
  scene_ = std::make_unique<Scene>(mesh);
}
SurfaceIndex::~SurfaceIndex() = default;
SurfaceIndex::SurfaceIndex(SurfaceIndex&&) noexcept = default;

SurfacePoint SurfaceIndex::nearest(const Eigen::Vector3d& p) const {
  const Eigen::Vector3d relative = p - scene_->center;
  Search search{&scene_->mesh, p, 0, std::numeric_limits<double>::infinity(), {}};
  // Eight roundings of a coordinate's last place, generously: corner, query and box distance.
  search.slack = 8 * (scene_->extent + relative.cwiseAbs().maxCoeff()) * 0x1.0p-23;
  RTCPointQuery query{};
  query.x = static_cast<float>(relative.x());
  query.y = static_cast<float>(relative.y());
  query.z = static_cast<float>(relative.z());
  query.radius = std::numeric_limits<float>::infinity();
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  rtcPointQuery(scene_->scene.handle, &query, &context, &visit, &search);
  return search.nearest;
}

}  // namespace fovea
