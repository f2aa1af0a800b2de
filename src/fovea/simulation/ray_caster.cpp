#include "fovea/simulation/ray_caster.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

#include "fovea/simulation/traced_mesh.h"

namespace fovea {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

/// Surface and paint of a placed model's triangle are the placement's.
void apply_placement(const Placement& placement, RayHit& hit) {
  hit.surface = placement.surface;
  if (hit.material == Palette::kPaint) hit.material = placement.paint;
}

/// The hit on a triangle known to be met, in double: Embree's own distance is good to 1e-5 m only.
/// @param a,b,c  its corners in the world
RayHit exact_hit(const TriangleMesh& mesh, std::uint32_t triangle, const Vector3d& a,
                 const Vector3d& b, const Vector3d& c, const Vector3d& from, const Vector3d& along,
                 double approximate) {
  const Vector3d cross = (b - a).cross(c - a);
  const double across = cross.dot(along);
  RayHit hit;
  hit.distance = approximate;
  if (std::abs(across) > 1e-12 * cross.norm()) hit.distance = cross.dot(a - from) / across;
  hit.position = from + hit.distance * along;
  hit.normal = cross.normalized();
  if (across > 0) hit.normal = -hit.normal;
  const double area = cross.squaredNorm();
  const auto v = static_cast<float>(cross.dot((hit.position - a).cross(c - a)) / area);
  const auto w = static_cast<float>(cross.dot((b - a).cross(hit.position - a)) / area);
  const auto& corners = mesh.triangle[triangle];
  const Vector3f &ta = mesh.texture[corners[0]], &tb = mesh.texture[corners[1]],
                 &tc = mesh.texture[corners[2]];
  hit.texture = ta + v * (tb - ta) + w * (tc - ta);
  hit.material = mesh.material[triangle];
  hit.surface = mesh.surface[triangle];
  return hit;
}

/// Whether a ball lies on the way of a ray no longer than `max`.
bool meets_ball(const Vector3d& center, double radius, const Vector3d& from, const Vector3d& along,
                double max) {
  const Vector3d to = center - from;
  const double nearest = to.dot(along);
  if (nearest < -radius || nearest > max + radius) return false;
  return (to - nearest * along).squaredNorm() <= radius * radius;
}

}  // namespace

/// What Embree says of a ray: which triangle of which instance.
struct RayCaster::Found {
  float distance = 0;
  std::uint32_t triangle = 0, instance = 0;
};

struct RayCaster::Resident {
  EmbreeDevice device{rtcNewDevice(nullptr)};
  std::vector<TracedMesh> models;
  std::map<std::uint32_t, TracedMesh> chunks;
  EmbreeScene scene;
  Vector3d anchor = Vector3d::Zero();        // world; the scene's floats are relative to it
  std::vector<const TracedMesh*> instances;  // chunks by instance id
};

RayCaster::RayCaster(const Scenery& scenery)
    : scenery_(scenery), resident_(std::make_unique<Resident>()) {
  if (!resident_->device) throw std::runtime_error("Embree cannot be started");
  for (const Model& model : scenery.models()) {
    resident_->models.push_back(trace(resident_->device.get(), model.mesh, Vector3d::Zero()));
  }
}
RayCaster::~RayCaster() = default;

void RayCaster::move_to(const Eigen::Vector2d& place, double radius) {
  const std::vector<ChunkPlace> wanted = scenery_.chunks_near(place, radius);
  auto& chunks = resident_->chunks;
  bool changed = std::erase_if(chunks, [&](const auto& entry) {
                   return std::none_of(wanted.begin(), wanted.end(),
                                       [&](const ChunkPlace& c) { return c.id == entry.first; });
                 }) > 0;
  for (const ChunkPlace& c : wanted) {
    if (chunks.contains(c.id)) continue;
    const Vector3d center(c.center.x(), c.center.y(), 0);
    chunks.emplace(c.id, trace(resident_->device.get(), scenery_.chunk(c.id).mesh_world, center));
    changed = true;
  }
  if (!changed && resident_->scene) return;
  resident_->anchor = Vector3d(place.x(), place.y(), 0);
  rebuild();
}

void RayCaster::rebuild() {
  Resident& r = *resident_;
  r.scene = new_scene(r.device.get());
  r.instances.clear();
  for (const auto& [id, chunk] : r.chunks) {
    // A chunk's floats are relative to its center, the scene's to the anchor.
    Eigen::Matrix4f T = Eigen::Matrix4f::Identity();
    T.topRightCorner<3, 1>() = (chunk.center - r.anchor).cast<float>();
    RTCGeometry instance = rtcNewGeometry(r.device.get(), RTC_GEOMETRY_TYPE_INSTANCE);
    rtcSetGeometryInstancedScene(instance, chunk.scene.get());
    rtcSetGeometryTimeStepCount(instance, 1);
    rtcSetGeometryTransform(instance, 0, RTC_FORMAT_FLOAT4X4_COLUMN_MAJOR, T.data());
    rtcCommitGeometry(instance);
    rtcAttachGeometryByID(r.scene.get(), instance, static_cast<unsigned>(r.instances.size()));
    rtcReleaseGeometry(instance);
    r.instances.push_back(&chunk);
  }
  commit(r.scene.get());
}

RayCaster::Moment RayCaster::moment(double time, double way) const {
  Moment moment;
  for (const Placement& placement : scenery_.movers(time, way)) {
    moment.movers.push_back({placement, placement.T_world_model.inverse(),
                             placement.T_world_model.translation(),
                             scenery_.models()[placement.model].radius});
  }
  return moment;
}

RayHit RayCaster::exact(const Found& found, const Vector3d& from, const Vector3d& along) const {
  const TriangleMesh& mesh = resident_->instances[found.instance]->mesh;
  return exact_hit(mesh, found.triangle, mesh.corner(found.triangle, 0),
                   mesh.corner(found.triangle, 1), mesh.corner(found.triangle, 2), from, along,
                   found.distance);
}

void RayCaster::cast_at_movers(const Moment& moment, const Vector3d& from, const Vector3d& along,
                               double min, double max, std::optional<RayHit>& hit) const {
  for (const Moment::Mover& mover : moment.movers) {
    const double nearer = hit ? hit->distance : max;
    if (!meets_ball(mover.center, mover.radius, from, along, nearer)) continue;
    const TracedMesh& traced = resident_->models[mover.placement.model];
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRayHit query{};
    query.ray =
        make_ray(mover.T_model_world * from, mover.T_model_world.linear() * along, min, nearer);
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(traced.scene.get(), &context, &query);
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) continue;
    const RigidMotion& T = mover.placement.T_world_model;
    const std::uint32_t triangle = query.hit.primID;
    hit = exact_hit(traced.mesh, triangle, T * traced.mesh.corner(triangle, 0),
                    T * traced.mesh.corner(triangle, 1), T * traced.mesh.corner(triangle, 2), from,
                    along, query.ray.tfar);
    apply_placement(mover.placement, *hit);
  }
}

std::optional<RayHit> RayCaster::cast(const Moment& moment, const Vector3d& from,
                                      const Vector3d& along, double min, double max) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRayHit query{};
  query.ray = make_ray(from - resident_->anchor, along, min, max);
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(resident_->scene.get(), &context, &query);
  std::optional<RayHit> hit;
  if (query.hit.geomID != RTC_INVALID_GEOMETRY_ID) {
    hit = exact({query.ray.tfar, query.hit.primID, query.hit.instID[0]}, from, along);
  }
  cast_at_movers(moment, from, along, min, max, hit);
  return hit;
}

auto RayCaster::cast(const Moment& moment, const Vector3d& from, const Packet<Vector3d>& along,
                     double min, double max) const -> Packet<std::optional<RayHit>> {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  alignas(32) const Packet<int> valid{-1, -1, -1, -1, -1, -1, -1, -1};
  RTCRayHit8 query{};
  for (std::size_t i = 0; i < kPacket; ++i) {
    fill_ray(query.ray, i, from - resident_->anchor, along[i], min, max);
    query.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
  }
  rtcIntersect8(valid.data(), resident_->scene.get(), &context, &query);
  Packet<std::optional<RayHit>> hits;
  for (std::size_t i = 0; i < kPacket; ++i) {
    if (query.hit.geomID[i] != RTC_INVALID_GEOMETRY_ID) {
      hits[i] =
          exact({query.ray.tfar[i], query.hit.primID[i], query.hit.instID[0][i]}, from, along[i]);
    }
    cast_at_movers(moment, from, along[i], min, max, hits[i]);
  }
  return hits;
}

auto RayCaster::blocked(const Moment& moment, const Packet<Vector3d>& from,
                        const Packet<bool>& wanted, const Vector3d& along, double min,
                        double max) const -> Packet<bool> {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  alignas(32) Packet<int> valid{};
  RTCRay8 query{};
  for (std::size_t i = 0; i < kPacket; ++i) {
    valid[i] = wanted[i] ? -1 : 0;
    fill_ray(query, i, from[i] - resident_->anchor, along, min, max);
  }
  rtcOccluded8(valid.data(), resident_->scene.get(), &context, &query);
  Packet<bool> blocked{};
  for (std::size_t i = 0; i < kPacket; ++i) {
    blocked[i] =
        wanted[i] && (query.tfar[i] < 0 || blocked_by_mover(moment, from[i], along, min, max));
  }
  return blocked;
}

bool RayCaster::blocked_by_mover(const Moment& moment, const Vector3d& from, const Vector3d& along,
                                 double min, double max) const {
  return std::any_of(moment.movers.begin(), moment.movers.end(), [&](const Moment::Mover& mover) {
    if (!meets_ball(mover.center, mover.radius, from, along, max)) return false;
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRay ray =
        make_ray(mover.T_model_world * from, mover.T_model_world.linear() * along, min, max);
    rtcOccluded1(resident_->models[mover.placement.model].scene.get(), &context, &ray);
    return ray.tfar < 0;
  });
}

}  // namespace fovea
