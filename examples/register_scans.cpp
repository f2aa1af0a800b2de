// How the LiDAR moved between two frames of a drive: register_scans DRIVE FIRST SECOND
#include <fovea/fovea.h>

#include <cstdio>
#include <cstdlib>

int main(int count, char** arguments) {
  if (count != 4) return std::fputs("register_scans DRIVE FIRST SECOND\n", stderr), 2;
  try {
    const fovea::Drive drive(arguments[1]);
    const fovea::DriveFrame first = drive.load(std::atoi(arguments[2]));
    const fovea::DriveFrame second = drive.load(std::atoi(arguments[3]));

    fovea::RegistrationOptions options;
    options.max_distance = 2;    // m: the motion that is not known
    options.robust_width = 0.1;  // m
    options.max_points = 20000;
    const fovea::RegistrationResult result =
        fovea::register_scans(first.scan(), second.scan(), fovea::RigidMotion::Identity(), options);

    const Eigen::Vector3d moved = result.T_target_source.translation();
    const double angle = fovea::rotation_angle(result.T_target_source.linear());
    std::printf("moved %.3f %.3f %.3f m, turned %.2f degrees; %zu pairs, %.3f m apart%s\n",
                moved.x(), moved.y(), moved.z(), angle * 57.29578, result.pairs,
                result.rms_distance, result.converged ? "" : " (not converged)");
    return result.converged ? 0 : 1;
  } catch (const fovea::Error& error) {
    return std::fprintf(stderr, "%s\n", error.what()), 1;
  }
}
