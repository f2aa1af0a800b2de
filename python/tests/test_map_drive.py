"""fovea.map_drive: the mapper with a callback."""
import os
import signal
import unittest

import fovea

import sample


class MapDriveTest(unittest.TestCase):
    def map(self, name, **keywords):
        return fovea.map_drive(sample.drive(), sample.folder() / name,
                               **{"settings": sample.SETTINGS, "hold_out": sample.HOLD_OUT,
                                  "force": True, **keywords})

    def test_makes_the_map_that_the_program_makes(self):
        calls = []
        summary = self.map("python.fovea", callback=calls.append)
        self.assertEqual([call.done for call in calls], list(range(1, sample.FRAMES + 1)))
        self.assertEqual([call.frame.index for call in calls], list(range(sample.FRAMES)))
        self.assertEqual({call.total for call in calls}, {sample.FRAMES})
        made = fovea.Map(sample.folder() / "python.fovea")
        self.assertEqual(calls[-1].points, made.size)
        self.assertEqual(summary["points"], made.size)
        self.assertEqual(summary["frames_held_out"], 1)
        self.assertEqual(sum(summary["frames_skipped"].values()), 1)
        self.assertFalse(summary["interrupted"])
        self.assertEqual(made.digest(), fovea.Map(sample.map_file()).digest())

    def test_what_the_callback_raises_stops_the_run_and_keeps_what_was_mapped(self):
        calls = []

        def stop(progress):
            calls.append(progress.done)
            if progress.done == 2:
                raise LookupError("enough")

        with self.assertRaisesRegex(LookupError, "enough"):
            self.map("stopped.fovea", callback=stop)
        self.assertEqual(calls, [1, 2])
        stopped = fovea.Map(sample.folder() / "stopped.fovea")
        self.assertEqual(stopped.meta["complete"], "0")
        self.assertGreaterEqual(len(stopped.frames), 2)
        self.assertLess(len(stopped.frames), sample.FRAMES)
        del stopped
        self.map("stopped.fovea", resume=True, force=False)
        self.assertEqual(fovea.Map(sample.folder() / "stopped.fovea").digest(),
                         fovea.Map(sample.map_file()).digest())

    def test_ctrl_c_is_a_keyboard_interrupt(self):
        with self.assertRaises(KeyboardInterrupt):
            self.map("interrupted.fovea", callback=lambda _: signal.raise_signal(signal.SIGINT))
        self.assertGreater(fovea.Map(sample.folder() / "interrupted.fovea").size, 0)

    def test_a_range_of_frames(self):
        summary = self.map("range.fovea", frames=(1, 3), hold_out="", cameras=[3], threads=1,
                           settings={"surface.spacing_m": 0.2, "texture.footprint_m": 0.0})
        self.assertEqual(summary["frames"], 2)
        made = fovea.Map(sample.folder() / "range.fovea")
        self.assertEqual(made.meta["cameras"], "3")
        self.assertIn("spacing_m = 0.2", made.meta["config"])
        self.assertIn('footprint_m = 0.0', made.meta["config"])

    def test_errors(self):
        with self.assertRaises(fovea.ConfigError):
            self.map("wrong.fovea", settings={"surface.spaces_m": 0.2})
        with self.assertRaises(fovea.ConfigError):
            self.map("wrong.fovea", preset="perfect")
        with self.assertRaises(fovea.InputError):
            fovea.map_drive(sample.folder() / "none", sample.folder() / "wrong.fovea")
        with self.assertRaises(fovea.OutputError):
            fovea.map_drive(sample.drive(), sample.map_file())
        self.assertFalse((sample.folder() / "wrong.fovea").exists())

    def test_no_output_replaces_an_input_or_another_kind_of_file(self):
        notes = sample.folder() / "notes.fovea"
        notes.write_text("notes")
        pipe = sample.folder() / "pipe.fovea"
        os.mkfifo(pipe)
        link = sample.folder() / "link.fovea"
        link.symlink_to(sample.drive())
        for output, problem in [(notes, "is a file of another kind"), (pipe, "ordinary file"),
                                (link, "file that the command reads"),
                                (sample.folder() / "map.ply", "ends in '.ply'")]:
            with self.assertRaisesRegex(fovea.OutputError, problem):
                fovea.map_drive(sample.drive(), output, force=True)
        self.assertEqual(notes.read_text(), "notes")
        self.assertFalse((sample.folder() / "map.ply").exists())


if __name__ == "__main__":
    unittest.main()
