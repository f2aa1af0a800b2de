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

    const fovea::RegistrationResult result = fovea::register_scans(first.scan(), second.scan());
    const Eigen::Vector3d moved = result.T_target_source.translation();
    const double angle = fovea::rotation_angle(result.T_target_source.linear());
    std::printf("moved %.3f %.3f %.3f m, turned %.2f degrees\n", moved.x(), moved.y(), moved.z(),
                angle * 57.29578);

    const fovea::ScanFit fit = fovea::scan_fit(first.scan(), second.scan(), result.T_target_source);
    if (fit.shows_one_place()) return 0;
    std::fprintf(
        stderr,
        "the scans do not fit: %.0f %% of their walls meet, %.0f %% of these lie on each other\n",
        100 * fit.overlap, 100 * fit.on_plane);
    return 1;
  } catch (const fovea::Error& error) {
    return std::fprintf(stderr, "%s\n", error.what()), 1;
  }
}
