"""fovea.city: from catalogs to jobs."""
import itertools
import math
import random
import unittest

from fovea.city import ground
from fovea.city.catalog import sections_of
from fovea.city.pairs import MOST_PARTNERS
from fovea.city.settings import Settings

from city_sample import drive, jobs_of, pairs_of, plan


def street(name, north=0.0, length=300.0, **other):
    """A drive to the east."""
    return drive(name, [(0, north), (length, north)], **other)


class GroundTest(unittest.TestCase):
    def test_projects_as_geographiclib(self):
        for latitude, longitude, meridian, east, north in [
                (49.01, 8.43, 8.43, 0.0, 5430739.730601), (49.01, 9.8, 8.43, 100223.965169, 5431644.262612),
                (-33.9, 151.2, 150, 110994.574849, -3753217.635978), (60, 5.9, 6.1, -11159.988992, 6654089.687834),
                (0.5, -0.5, 0.5, -111320.969551, 55295.630128), (49, 178.9, -179.8, -95122.204996, 5430442.125203),
                (40, -74, 8.4, -6346476.093580, 9006071.622175), (35, 139, 8.4, 4650204.255059, 14779307.908458)]:
            x, y = ground.transverse_mercator(latitude, longitude, meridian)
            self.assertAlmostEqual(x, east, places=5)
            self.assertAlmostEqual(y, north, places=5)

    def test_cells_within_a_radius(self):
        self.assertEqual(ground.cells_within(5, 5, 4, 10), [(0, 0)])
        self.assertEqual(sorted(ground.cells_within(9, 5, 2, 10)), [(0, 0), (1, 0)])
        self.assertEqual(len(ground.cells_within(9, 9, 2, 10)), 4)
        self.assertEqual(len(ground.cells_within(8.5, 8.5, 2, 10)), 3)  # not the one across the corner
        self.assertEqual(ground.cells_within(-0.1, -0.1, 0.05, 10), [(-1, -1)])


class SectionsTest(unittest.TestCase):
    def test_a_short_drive_is_one_section(self):
        catalog = street("a", length=999).catalog
        sections = sections_of(catalog, 1000)
        self.assertEqual([(section.begin, section.end) for section in sections], [(catalog.begin, catalog.end)])

    def test_a_long_drive_is_cut_at_equal_ways_with_overlap(self):
        catalog = street("a", length=2500, first_frame=7).catalog
        sections = sections_of(catalog, 1000)
        self.assertEqual(len(sections), 3)
        self.assertEqual((sections[0].begin, sections[-1].end), (catalog.begin, catalog.end))
        for first, second in itertools.pairwise(sections):
            self.assertTrue(20 <= first.end - second.begin <= 32, first.end - second.begin)  # a frame each meter
        for section in sections:
            self.assertLess(section.end - section.begin, 880)
            self.assertEqual(section.samples[0].frame, section.begin)

    def test_frames_without_way_stay_in_one_section(self):
        stop = drive("a", [(0, 0), (600, 0), (1200, 0)], frame_m=10.0).catalog
        sections = sections_of(stop, 1000)
        self.assertEqual(len(sections), 2)
        self.assertGreater(sections[0].end, sections[1].begin)


class NamesTest(unittest.TestCase):
    def setUp(self):
        self.drives = [street(f"east {k}", north=100.0 * k) for k in range(3)]
        self.drives += [drive(f"north {k}", [(100 * k, -50), (100 * k, 250)]) for k in range(3)]
        self.plan = plan(self.drives)

    def test_the_order_of_drives_does_not_matter(self):
        for seed in range(3):
            drives = random.Random(seed).sample(self.drives, len(self.drives))
            self.assertEqual(plan(drives).jobs, self.plan.jobs)

    def test_jobs_are_in_an_order_in_which_they_can_run(self):
        done = set()
        for job in self.plan.jobs:
            self.assertLessEqual(set(job.after), done, job.id)
            self.assertTrue(all(self.stage_of(before) < job.stage for before in job.after), job.id)
            done.add(job.id)
        self.assertEqual(job.kind, "root")
        self.assertEqual(len(done), len(self.plan.jobs))

    def stage_of(self, id):
        return next(job.stage for job in self.plan.jobs if job.id == id)

    def test_settings_are_part_of_the_names(self):
        other = plan(self.drives, Settings(map_arguments=("--set", "surface.spacing_m=0.1")))
        for kind in ("map", "pair", "poses", "tile"):
            self.assertTrue(jobs_of(self.plan, kind).keys().isdisjoint(jobs_of(other, kind)), kind)
        other = plan(self.drives, Settings(session="latest"))
        for kind in ("map", "pair", "poses"):
            self.assertEqual(jobs_of(self.plan, kind), jobs_of(other, kind))
        self.assertTrue(jobs_of(self.plan, "tile").keys().isdisjoint(jobs_of(other, "tile")))

    def test_the_size_of_tiles_keeps_all_digits(self):
        for size, text in ((64, "64.0"), (100.0000001, "100.0000001")):
            for job in jobs_of(plan(self.drives[:1], Settings(tile_size_m=size)), "tile").values():
                self.assertEqual(job.command[job.command.index("--tile-size") + 1], text)

    def test_a_session_that_is_not_around_a_tile_is_best_there(self):
        tiles = jobs_of(plan([*self.drives, street("far", north=3000.0)], Settings(session="far")), "tile").values()
        sessions = {job.command[job.command.index("--session") + 1] for job in tiles}
        self.assertEqual(sessions, {"best", "far"})

    def test_a_failed_map_or_pair_is_left_out(self):
        failed_map = next(iter(jobs_of(self.plan, "map")))
        failed_pair = next(id for id, job in jobs_of(self.plan, "pair").items() if failed_map not in job.after)
        other = plan(self.drives, failed=[failed_map, failed_pair])
        self.assertEqual(jobs_of(other, "map").keys(), jobs_of(self.plan, "map").keys() - {failed_map})
        expected = {id for id, job in jobs_of(self.plan, "pair").items() if failed_map not in job.after}
        self.assertEqual(jobs_of(other, "pair").keys(), expected - {failed_pair})
        self.assertNotEqual(other.poses, self.plan.poses)

    def test_all_points_have_a_tile(self):
        reach = 60.0  # foveal.periphery_range_m
        plane = ground.Plane(self.plan.origin)
        generator = random.Random(1)
        for segment in self.plan.segments:
            for sample in segment.samples[::7]:
                x, y = plane.project(sample.place)
                angle = generator.uniform(0, 2 * math.pi)
                point = x + reach * math.cos(angle), y + reach * math.sin(angle)
                tile = tuple(math.floor(value / 64) for value in point)
                job = next(job for job in self.plan.jobs if job.output == self.plan.tiles[tile])
                self.assertIn(f"map-{segment.name}", job.after)

    def test_the_range_of_the_map_widens_the_reach(self):
        wide = plan(self.drives, Settings(map_arguments=("--set", "foveal.periphery_range_m=120")))
        self.assertGreater(len(wide.tiles), 1.3 * len(self.plan.tiles))


class AddAndRemoveTest(unittest.TestCase):
    def setUp(self):
        self.drives = [street(f"east {k}", north=400.0 * k, length=1500) for k in range(4)]
        self.city = plan(self.drives)
        self.new = drive("new", [(300, -20), (300, 20)])
        self.added = plan([self.new], before=self.city)

    def new_jobs(self, kind):
        return jobs_of(self.added, kind).keys() - jobs_of(self.city, kind).keys()

    def test_only_the_new_drive_is_mapped_and_aligned(self):
        self.assertEqual(len(self.new_jobs("map")), 1)
        self.assertEqual(pairs_of(self.added), [("east 0", "new")])

    def test_the_poses_of_the_city_are_fixed(self):
        [job] = jobs_of(self.added, "poses").values()
        self.assertIn(f"/city/poses/{self.city.poses}.json", job.command)
        self.assertIn("--fixed", job.command)
        for segment in self.added.segments:
            is_new = segment.drive.catalog.name == "new"
            self.assertEqual(segment.placed_by, self.added.poses if is_new else self.city.poses)

    def test_only_near_tiles_are_new(self):
        self.assertEqual(self.added.origin, self.city.origin)
        changed = [tile for tile, file in self.added.tiles.items() if self.city.tiles.get(tile) != file]
        plane = ground.Plane(self.city.origin)
        x, y = plane.project(self.new.catalog.samples[0].place)
        for tile in changed:
            self.assertLess(abs(64 * (tile[0] + 0.5) - x), 130)
            self.assertLess(abs(64 * (tile[1] + 0.5) - y), 170)
        self.assertTrue(6 <= len(changed) <= 25, len(changed))
        self.assertGreater(len(self.city.tiles), 10 * len(changed))

    def test_adding_in_two_steps_keeps_the_first(self):
        second = plan([drive("later", [(200, 380), (200, 420)])], before=self.added)
        changed = [tile for tile, file in second.tiles.items() if self.added.tiles.get(tile) != file]
        self.assertTrue(6 <= len(changed) <= 25, len(changed))

    def test_adding_nothing_changes_nothing(self):
        again = plan([], before=self.added)
        self.assertEqual(again.poses, self.added.poses)
        self.assertEqual(again.tiles, self.added.tiles)

    def test_removing_gives_the_tiles_from_before(self):
        removed = plan([], before=self.added, kept={each.catalog.name for each in self.drives})
        self.assertEqual(removed.tiles, self.city.tiles)
        [job] = jobs_of(removed, "poses").values()
        self.assertIn("keep-poses", job.command)
        kept = [self.added.segments[int(number)].name for number in job.command[-1].split(",")]
        self.assertEqual(kept, [segment.name for segment in removed.segments])

    def test_removing_the_drive_of_the_origin_keeps_the_grid(self):
        first = self.city.segments[0].drive.catalog.name
        removed = plan([], before=self.city, kept={each.catalog.name for each in self.drives} - {first})
        self.assertEqual(removed.origin, self.city.origin)
        self.assertLess(removed.tiles.items(), self.city.tiles.items())


class PairsTest(unittest.TestCase):
    def test_near_drives_are_pairs(self):
        drives = [street("a"), street("near", north=25.0), street("far", north=160.0), street("farther", north=190.0)]
        self.assertEqual(pairs_of(plan(drives)), [("a", "near"), ("far", "farther")])

    def test_navigation_off_by_15_m_is_survived(self):
        drives = [street("a"), street("b"), street("off", north=42.0)]
        self.assertIn(("a", "off"), pairs_of(plan(drives)))

    def test_worse_navigation_widens_the_reach(self):
        others = [street("a"), street("b", north=30), street("c", north=130)]
        self.assertEqual(pairs_of(plan([*others, street("d", north=160)])), [("a", "b"), ("c", "d")])
        self.assertIn(("b", "d"), pairs_of(plan([*others, street("d", north=160, sigma=30.0)])))

    def test_a_lonely_drive_gets_a_wider_reach(self):
        drives = [street("a"), street("b"), street("lonely", north=58.0)]
        self.assertIn(("a", "lonely"), pairs_of(plan(drives)))
        crowded = [*drives, street("c", north=80.0)]
        self.assertNotIn(("a", "lonely"), pairs_of(plan(crowded)))

    def test_a_drive_in_another_place_is_a_warning(self):
        made = plan([street("a"), street("b"), street("abroad", origin=(40.0, -74.0))])
        self.assertEqual(pairs_of(made), [("a", "b")])
        self.assertEqual(made.warnings, ("abroad is near no other drive: navigation alone places it",))
        self.assertGreater(min(abs(x) for x, _ in made.tiles if abs(x) > 1000), 10_000)

    def test_segments_that_follow_and_loops_are_pairs(self):
        loop = drive("loop", [(0, 0), (900, 0), (900, 900), (0, 900), (0, 0)])  # 3.6 km: 4 segments
        self.assertEqual(len(pairs_of(plan([loop]))), 4)  # the last one meets the first

    def test_100_km_and_zones(self):
        for longitude in (6.0, 180.0, -0.0):  # borders of zones
            west = drive("west", [(-300, 0), (300, 0)], origin=(50.0, longitude))
            east = drive("east", [(0, -300), (0, 300)], origin=(50.0, longitude - 360))
            away = [drive(f"away {k}", [(100_000, 50 * k), (100_300, 50 * k)], origin=(50.0, longitude))
                    for k in range(2)]
            made = plan([west, east, *away])
            self.assertEqual(pairs_of(made), [("away 0", "away 1"), ("east", "west")])
            xs = sorted(x for x, _ in made.tiles)
            self.assertTrue(1500 < xs[-1] - xs[0] < 1600)

    def test_time_and_pairs_grow_with_the_drives(self):
        counts = []
        for count in (8, 16, 32):
            streets = [street(f"{k}", north=60.0 * k) for k in range(count)]
            counts.append(len(pairs_of(plan(streets))))
        self.assertLessEqual(counts[2], 2.3 * counts[1])
        self.assertLessEqual(counts[1], 2.3 * counts[0])

    def test_repeated_passes_do_not_multiply(self):
        for count in (2, 4, 8, 9, 16, 40):
            made = plan([street(f"pass {k}", north=0.1 * k) for k in range(count)])
            pairs = pairs_of(made)
            self.assertLessEqual(len(pairs), count * MOST_PARTNERS / 2)
            self.assertGreaterEqual(len(pairs), min(count * (count - 1) / 2, count * 2.5))
            self.assert_connected(pairs, count)
            for segment in made.segments:
                partners = sum(segment.drive.catalog.name in pair for pair in pairs)
                self.assertLessEqual(partners, MOST_PARTNERS)

    def assert_connected(self, pairs, count):
        reached = {pairs[0][0]}
        for _ in range(count):
            reached |= {name for pair in pairs if not reached.isdisjoint(pair) for name in pair}
        self.assertEqual(len(reached), count)

    def test_partners_along_a_path_may_be_many(self):
        crossing = [drive(f"cross {k}", [(100 * k, -50), (100 * k, 50)]) for k in range(30)]
        pairs = pairs_of(plan([street("main", length=2950), *crossing], Settings(segment_length_m=5000)))
        self.assertEqual(len(pairs), 30)


if __name__ == "__main__":
    unittest.main()
