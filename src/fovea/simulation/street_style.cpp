#include "fovea/simulation/street_style.h"

namespace fovea {

using Eigen::Vector3d;

StreetStyle style_of(Scene scene) {
  StreetStyle style;
  switch (scene) {
    case Scene::kStreet:
    case Scene::kTraffic:
      break;
    case Scene::kCrossing:  // the next street is not far
    case Scene::kTown:
      style.far = 20;
      style.backdrop = false;
      break;
    case Scene::kCanyon:
      style.front = 7.6;
      style.min_floors = 11;
      style.max_floors = 15;
      style.gap_chance = 0;
      style.trees = 0;
      style.parked = 0.35;
      break;
    case Scene::kPlaza:
      style.front = 32;
      style.raised = false;
      style.trees = 0.15;
      style.gap_chance = 0.1;
      style.furniture = 0.25;
      break;
    case Scene::kStress:
      style.parked = 0.95;
      style.trees = 1;
      style.furniture = 1;
      style.bushes = 0.30;
      style.railings = 0.6;
      style.bystanders = 0.20;
      break;
  }
  return style;
}

Vector3d StreetAxis::place(double s, double d, double z) const {
  const Eigen::Vector2d p = path->offset(begin + s, d);
  return T_world_path * Vector3d(p.x(), p.y(), z);
}

RigidMotion StreetAxis::frame(double s, double d, double z, double turn) const {
  RigidMotion T = RigidMotion::Identity();
  T.translation() = place(s, d, z);
  T.linear() = T_world_path.linear() *
               Eigen::AngleAxisd(path->at(begin + s).heading + turn, Vector3d::UnitZ()).matrix();
  return T;
}

}  // namespace fovea
