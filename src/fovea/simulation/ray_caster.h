// What a ray meets in a scenery, at a moment (Embree finds the triangle, we intersect it in
// double).
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "fovea/simulation/scenery.h"

namespace fovea {

struct RayHit {
  double distance = 0;                                 ///< m along the unit direction
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< world
  Eigen::Vector3d normal =
      Eigen::Vector3d::UnitZ();  ///< unit, world, towards where the ray came from
  Eigen::Vector3f texture = Eigen::Vector3f::Zero();
  std::uint16_t material = 0;
  std::uint32_t surface = 0;
  bool moving() const { return (surface & Scenery::kMoving) != 0; }
};

/// The part of a scenery round a place, ready for rays.
class RayCaster {
 public:
  explicit RayCaster(const Scenery& scenery);
  ~RayCaster();
  RayCaster(const RayCaster&) = delete;
  RayCaster& operator=(const RayCaster&) = delete;

  /// Makes the chunks within `radius` of a place resident and drops the others. Not while rays are
  /// cast.
  void move_to(const Eigen::Vector2d& place, double radius);

  /// What moves, where it is at one moment: rays of that moment are cast against it too.
  struct Moment {
    struct Mover {
      Placement placement;
      RigidMotion T_model_world;
      Eigen::Vector3d center;  ///< world
      double radius;
    };
    std::vector<Mover> movers;
  };
  /// @param way  of the vehicle along the path at that time
  Moment moment(double time, double way) const;

  /// The nearest surface between `min` and `max` m along a ray (unit direction, world).
  /// Thread-safe.
  std::optional<RayHit> cast(const Moment& moment, const Eigen::Vector3d& from,
                             const Eigen::Vector3d& along, double min, double max) const;

  /// Rays that are cast together, which is faster where they are neighbours.
  static constexpr std::size_t kPacket = 8;
  template <class T>
  using Packet = std::array<T, kPacket>;

  /// The same for a packet from one place.
  Packet<std::optional<RayHit>> cast(const Moment& moment, const Eigen::Vector3d& from,
                                     const Packet<Eigen::Vector3d>& along, double min,
                                     double max) const;
  /// Whether anything stands between `from` and `max` m along a direction that a packet shares,
  /// such as that of the sun; false for rays that are not `wanted`.
  Packet<bool> blocked(const Moment& moment, const Packet<Eigen::Vector3d>& from,
                       const Packet<bool>& wanted, const Eigen::Vector3d& along, double min,
                       double max) const;

  const Scenery& scenery() const { return scenery_; }

 private:
  struct Resident;
  struct Found;

  void rebuild();
  RayHit exact(const Found& found, const Eigen::Vector3d& from, const Eigen::Vector3d& along) const;
  void cast_at_movers(const Moment& moment, const Eigen::Vector3d& from,
                      const Eigen::Vector3d& along, double min, double max,
                      std::optional<RayHit>& hit) const;
  bool blocked_by_mover(const Moment& moment, const Eigen::Vector3d& from,
                        const Eigen::Vector3d& along, double min, double max) const;

  const Scenery& scenery_;
  std::unique_ptr<Resident> resident_;
};

}  // namespace fovea
