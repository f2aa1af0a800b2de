// The optional columns of a point cloud, one after the other.
#pragma once

#include "fovea/point_cloud.h"

namespace fovea {

/// Calls `f(name, column)` for each optional column of a (const) cloud.
template <class Cloud, class F>
void for_each_optional_column(Cloud& cloud, F&& f) {
  f("intensity", cloud.intensity);
  f("ring", cloud.ring);
  f("sensor", cloud.sensor);
  f("time", cloud.time);
  f("normal", cloud.normal);
  f("range", cloud.range);
  f("incidence", cloud.incidence);
  f("color", cloud.color);
  f("frame", cloud.frame);
  f("camera", cloud.camera);
  f("interpolated", cloud.interpolated);
  f("views", cloud.views);
  f("spread", cloud.spread);
  f("weight", cloud.weight);
  f("saturated", cloud.saturated);
  f("reason", cloud.reason);
  f("sampling_level", cloud.sampling_level);
}

/// Calls `f(name, column_a, column_b)` for each optional column of two clouds.
template <class CloudA, class CloudB, class F>
void for_each_optional_column(CloudA& a, CloudB& b, F&& f) {
  f("intensity", a.intensity, b.intensity);
  f("ring", a.ring, b.ring);
  f("sensor", a.sensor, b.sensor);
  f("time", a.time, b.time);
  f("normal", a.normal, b.normal);
  f("range", a.range, b.range);
  f("incidence", a.incidence, b.incidence);
  f("color", a.color, b.color);
  f("frame", a.frame, b.frame);
  f("camera", a.camera, b.camera);
  f("interpolated", a.interpolated, b.interpolated);
  f("views", a.views, b.views);
  f("spread", a.spread, b.spread);
  f("weight", a.weight, b.weight);
  f("saturated", a.saturated, b.saturated);
  f("reason", a.reason, b.reason);
  f("sampling_level", a.sampling_level, b.sampling_level);
}

}  // namespace fovea
