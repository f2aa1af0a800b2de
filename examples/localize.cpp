// Where the scans of a drive were taken in a map: localize DRIVE MAP.fovea
#include <fovea/fovea.h>

#include <cmath>
#include <cstdio>

int main(int count, char** arguments) {
  if (count != 3) return std::fputs("localize DRIVE MAP.fovea\n", stderr), 2;
  try {
    fovea::DriveOptions scans_only;
    scans_only.use_images = false;
    const fovea::Drive drive(arguments[1], scans_only);
    fovea::DriveLocalizer localizer(arguments[2], drive);
    int localized = 0;
    for (const int index : drive.frames()) {
      const auto frame = drive.try_load(index);
      if (!frame) continue;
      const fovea::Localization place = localizer.localize(*frame);
      if (place.state != fovea::LocalizationState::kLocalized) {
        std::printf("frame %d: %s\n", index, to_string(place.state));
        continue;
      }
      ++localized;
      const Eigen::Vector3d p = place.T_local_lidar.translation();
      const double sigma = std::sqrt(place.covariance.bottomRightCorner<3, 3>().trace());
      std::printf("frame %d: %.2f %.2f %.2f m, +-%.3f m, health %.2f\n", index, p.x(), p.y(), p.z(),
                  sigma, place.health);
    }
    return localized > 0 ? 0 : 1;
  } catch (const fovea::Error& error) {
    return std::fprintf(stderr, "%s\n", error.what()), 1;
  }
}
