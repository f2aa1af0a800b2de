// Uses the installed library: its headers, the shared library, and objects that go both ways. The
// compiler and its flags differ from the library's.
#include <fovea/fovea.h>

#include <cstdio>

namespace {

/// Registers two clouds.
bool registers() {
  fovea::PointCloud cloud;
  for (int i = 0; i < 20; ++i) {
    for (int j = 0; j < 20; ++j) {
      const float a = 0.2f * float(i), b = 0.2f * float(j);
      cloud.position.insert(cloud.position.end(), {{a, b, 0}, {a, 0, b}, {0, a, b}});
    }
  }
  fovea::RigidMotion guess = fovea::RigidMotion::Identity();
  guess.translation() = Eigen::Vector3d(0.05, -0.03, 0.02);
  const fovea::RegistrationResult result = fovea::register_scans(cloud, cloud, guess);
  const double error = result.T_target_source.translation().norm();
  std::printf("registration off by %g m\n", error);
  return result.converged && error < 0.02 && result.pairs > 0 && result.information(5, 5) > 0;
}

/// The library takes over poses that this program allocated, and frees them.
bool interpolates() {
  std::vector<fovea::StampedPose> poses(100);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    poses[i].time = static_cast<fovea::TimeNs>(i) * fovea::kNsPerSecond / 10;
    poses[i].T_local_body.translation() = Eigen::Vector3d(double(i), 2 * double(i), 3);
  }
  fovea::Trajectory trajectory(std::move(poses));
  const auto pose = trajectory.at(fovea::kNsPerSecond / 20);
  if (!pose || trajectory.poses().size() != 100) return false;
  std::vector<fovea::StampedPose> copy = trajectory.poses();
  copy.push_back(copy.front());
  const Eigen::Vector3d last = copy[99].T_local_body.translation();
  std::printf("interpolated at %g, %g, %g\n", pose->translation().x(), pose->translation().y(),
              pose->translation().z());
  return (pose->translation() - Eigen::Vector3d(0.5, 1, 3)).norm() < 1e-9 &&
         last == Eigen::Vector3d(99, 198, 3);
}

/// Errors cross the library's border with their types.
bool throws() {
  try {
    const fovea::Drive drive("there is no such folder");
  } catch (const fovea::InputError& error) {
    std::printf("%s\n", error.what());
    return !error.remedy().empty();
  }
  return false;
}

/// A matrix of dynamic size is freed by whichever copy of Eigen's function the linker kept.
bool solves() {
  Eigen::MatrixXd equations = Eigen::MatrixXd::Identity(200, 200) * 2;
  const Eigen::VectorXd solution = equations.ldlt().solve(Eigen::VectorXd::Ones(200));
  return (solution - Eigen::VectorXd::Constant(200, 0.5)).norm() < 1e-9;
}

}  // namespace

int main() {
  std::printf("fovea %s\n", fovea::version());
  const bool passed = registers() && interpolates() && throws() && solves();
  std::puts(passed ? "passed" : "failed");
  return passed ? 0 : 1;
}
