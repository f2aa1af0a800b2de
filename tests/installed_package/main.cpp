// Registers two clouds with the installed library: headers, archives and their dependencies are
// there.
#include <fovea/core/version.h>
#include <fovea/mapping/registration/registration.h>
#include <fovea/pipeline/config.h>

#include <cstdio>

int main() {
  const fovea::MapSettings settings = fovea::load_preset("default");
  std::vector<Eigen::Vector3f> points;
  for (int i = 0; i < 20; ++i) {
    for (int j = 0; j < 20; ++j) {
      const float a = 0.2f * float(i), b = 0.2f * float(j);
      points.insert(points.end(), {{a, b, 0}, {a, 0, b}, {0, a, b}});
    }
  }
  const auto cloud = fovea::prepare_cloud(points, settings.mapper().refinement.registration);
  const fovea::PointIndex index(cloud.points);
  fovea::RigidMotion guess = fovea::RigidMotion::Identity();
  guess.translation() = Eigen::Vector3d(0.05, -0.03, 0.02);
  const auto result =
      fovea::register_clouds(cloud, index, cloud, guess, settings.mapper().refinement.registration);
  std::printf("fovea %s: off by %g m\n", fovea::version(),
              result.T_target_source.translation().norm());
  return result.converged && result.T_target_source.translation().norm() < 0.02 ? 0 : 1;
}
