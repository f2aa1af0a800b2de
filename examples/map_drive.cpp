// Maps a drive, every fourth frame held out, and scores the map: map_drive DRIVE MAP.fovea
#include <fovea/fovea.h>

#include <cstdio>

int main(int count, char** arguments) {
  if (count != 3) return std::fputs("map_drive DRIVE MAP.fovea\n", stderr), 2;
  try {
    const fovea::Drive drive(arguments[1]);
    fovea::MapOptions options;
    options.settings.values["surface.spacing_m"] = "0.1";
    options.hold_out = "4:3";
    options.force = true;
    const fovea::MapFigures figures =
        fovea::map_drive(drive, arguments[2], options, [](const fovea::MapProgress& now) {
          std::printf("%d/%d: frame %d %s, %zu points\n", now.done, now.total, now.frame.index,
                      to_string(now.frame.status), now.points);
        });
    for (const std::string& warning : figures.warnings) std::printf("%s\n", warning.c_str());

    const fovea::Evaluation score = fovea::evaluate_map(arguments[2], arguments[1]);
    std::printf(
        "%zu points; held-out frames: colors differ by %.1f gray values, points by %.3f m\n",
        figures.points, score.texture_error.value(), score.mapping_error.value());
    return 0;
  } catch (const fovea::Error& error) {
    return std::fprintf(stderr, "%s\n", error.what()), 1;
  }
}
