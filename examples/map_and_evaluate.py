"""Maps a drive, every fourth frame held out, and scores it: map_and_evaluate.py DRIVE MAP.fovea"""
import sys

import fovea


def show(progress: fovea.Progress) -> None:
    frame = progress.frame
    print(f"{progress.done}/{progress.total}: frame {frame.index} {frame.status}, "
          f"{progress.points} points")


drive, output = sys.argv[1:]
summary = fovea.map_drive(drive, output, settings={"surface.spacing_m": 0.1}, hold_out="4:3",
                          force=True, callback=show)
for note in summary["notes"]:
    print("note:", note)

report = fovea.evaluate(output, drive, protocol="held-out")
print(f"{len(report['frames'])} frames scored: TE {report['te_mean']:.1f}, ME {1000 * report['me_mean']:.1f} mm")
