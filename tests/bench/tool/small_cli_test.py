# SPDX-License-Identifier: MIT
"""cairn run small as its users meet it: python3 small_cli_test.py PATH_OF_CAIRN"""
import json
import os
import re
import sys
import unittest

import cli_test
from cli_test import BAD_INPUT, USAGE, CairnTest

# A second of work at most, on a slow machine.
QUICK = ["run", "small", "incline", "pendulum", "door", "--frames", "12"]
FAMILY = {"incline", "seesaw", "door", "pendulum", "car", "growing-tower", "tower", "stairs", "arch", "slab",
          "dominoes", "wrecking-ball", "pyramid3d"}


class SmallTest(CairnTest):
    def test_progress_says_which_world_of_how_many(self):
        result = cli_test.cairn("run", "small", "dominoes", "door", "--frames", "150", "--progress", "always")
        self.assertRegex(result.stderr, r"(dominoes|door) \([12] of 2\), (hot|cold|errors): frame \d+ of 150")

    def test_help_names_every_world_and_the_exit_codes(self):
        text = self.fine("run", "small", "--help")
        for world in FAMILY:
            self.assertRegex(text, rf"(?m)^ *{world} +\d+ ")
        self.assertIn("Exit codes", text)
        self.assertIn("small", self.fine("run", "--help"))

    def test_the_family_is_of_scenes(self):
        scenes = {scene["name"] for scene in json.loads(self.fine("list", "scenes", "--json"))}
        self.assertLessEqual(FAMILY, scenes)

    def test_all_worlds_are_run_unless_some_are_named(self):
        worlds = self.run_json("run", "small", "--frames", "2", "--samples", "0")["worlds"]
        self.assertEqual({world["scene"] for world in worlds}, FAMILY)
        self.assertEqual(len(worlds), len(FAMILY))
        for world in worlds:
            self.assertGreater(world["bodies"], 0)
            self.assertLess(world["bodies"], 400)
            for solver in world["solvers"]:
                self.assertIsNone(solver["failure"])

    def test_the_table_has_a_line_for_each_world_and_their_mean(self):
        text = self.fine(*QUICK)
        lines = text.splitlines()
        for world in ("incline", "pendulum", "door", "geometric mean"):
            self.assertEqual(sum(line.startswith(world) for line in lines), 1, text)
        self.assertNotIn("seesaw", text)
        for words in ("cold", "shares of it", "Compared with", "the first 3 of which do not count"):
            self.assertIn(words, text)
        for line in lines:
            self.assertLessEqual(len(line), 120, line)

    def test_quiet_leaves_the_table(self):
        self.assertNotIn("Compared with", self.fine(*QUICK, "--quiet"))

    def test_json_has_what_the_table_is_made_of(self):
        result = self.run_json(*QUICK, "--samples", "2", "--warmup", "2", "--simd", "sse4")
        self.assertEqual(result["frames"], 12)
        self.assertEqual(result["context"]["run"]["warmup_frames"], 2)
        self.assertEqual(result["context"]["run"]["simd_asked_for"], "sse4")
        self.assertEqual(result["context"]["command"].split()[:3], ["cairn", "run", "small"])
        facts = {world["scene"]: world for world in result["worlds"]}
        # One box on four corners; a chain of links without contacts; a leaf on a hinge, and a crate.
        self.assertEqual((facts["incline"]["bodies"], facts["incline"]["contact_points"]), (1, 4))
        self.assertEqual((facts["pendulum"]["joints"], facts["pendulum"]["contact_points"]), (5, 0))
        self.assertEqual((facts["door"]["bodies"], facts["door"]["joints"]), (2, 1))
        for world in result["worlds"]:
            self.assertEqual([solver["solver"] for solver in world["solvers"]],
                             ["bullet-si", "cairn-pgs", "cairn"])
            bullet = world["solvers"][0]
            self.assertEqual(bullet["hot_of_bullet"], 1)
            self.assertEqual(bullet["cold_of_bullet"], 1)
            for solver in world["solvers"]:
                self.assertGreater(solver["hot_us"], 0)
                self.assertAlmostEqual(solver["cold_of_bullet"], solver["cold_us"] / bullet["cold_us"])
                self.assertEqual(len(solver["velocity_errors_m_s"]), 2)
            self.assertEqual(len(world["reference_residuals_m_s"]), 2)

    def test_errors_are_on_the_same_states(self):
        """Of a pendulum, whose joints Bullet starts from nothing, ten iterations leave more than steps do."""
        world, = self.run_json("run", "small", "pendulum", "--frames", "40", "--samples", "4")["worlds"]
        bullet, _, cairn = world["solvers"]
        self.assertGreater(bullet["velocity_error_median_m_s"], 1e-3)
        self.assertLess(cairn["velocity_error_of_bullet"], 0.5)
        errors = [[solver["velocity_errors_m_s"] for solver in self.run_json(
            "run", "small", "pendulum", "--frames", "40", "--samples", "4")["worlds"][0]["solvers"]]
                  for _ in range(2)]
        self.assertEqual(errors[0], errors[1])

    def test_other_scenes_and_sizes_are_worlds_too(self):
        text = self.fine("run", "small", "tower:3", "bridge:10", "incline", "--hot", "--frames", "4", "--samples", "0")
        self.assertEqual([line.split()[0] for line in text.splitlines()[2:5]], ["tower:3", "bridge:10", "incline"])
        self.assertEqual([line.split()[1] for line in text.splitlines()[2:5]][::2], ["3", "1"])

    def test_markdown_is_the_table(self):
        self.fine(*QUICK, "--markdown", self.path("t.md"))
        with open(self.path("t.md"), encoding="utf-8") as file:
            lines = file.read().splitlines()
        self.assertTrue(all(line.startswith("|") for line in lines), lines)
        self.assertTrue(any(re.match(r"\| door ", line) for line in lines))

    def test_what_cannot_be_is_refused(self):
        for words, expected in ((["twoer"], "tower"),
                                (["tower:101"], "size of tower"),
                                (["tower@30"], "--warmup"),
                                (["--frames", "0"], "--frames"),
                                (["--frames", "x"], "--frames"),
                                (["--frames", "10", "--warmup", "10"], "--warmup"),
                                (["--samples", "-1"], "--samples"),
                                (["--simd", "mmx"], "simd"),
                                (["--json", ""], "--json"),
                                (["--json", self.path("x"), "--markdown", self.path("./x")], "written to twice"),
                                (["--frmes", "3"], "--frames"),
                                (["--seeds", "5"], "FROM:TO"),
                                (["--seeds", "5:5"], "there are none"),
                                (["--seeds", "0:3000000000"], "--seeds"),
                                (["--seeds", "0:2000000000"], "at most 10000000"),
                                (["--seeds", "0:3", "tower"], "leave out 'tower'"),
                                (["--seeds", "0:3", "--kind", "chian"], "chain"),
                                (["--kind", "chain"], "add --seeds"),
                                (["--budget", "2ms"], "cairn run small --help")):
            self.assertIn(expected, self.refused(USAGE, "run", "small", *words))

    def test_random_worlds_are_shown_by_kind_by_size_and_the_slowest(self):
        random = ["run", "small", "--seeds", "0:90", "--kind", "chain,tree", "--frames", "8", "--samples", "2"]
        text = self.fine(*random, "--slowest", "3", "--json", self.path("r.json"), "--markdown", self.path("r.md"))
        kinds, shares, slowest = text.split("\n\n")[:3]
        self.assertEqual([line.split()[0] for line in kinds.splitlines()[2:]], ["chain", "tree", "all"])
        self.assertIn("time cold", shares)
        self.assertIn("with their seeds", text)
        self.assertNotIn("time cold", self.fine(*random, "--hot"))
        with open(self.path("r.json"), encoding="utf-8") as file:
            worlds = json.load(file)["worlds"]
        ratios = {}
        for world in worlds:
            ratios[f"{world['scene']} {world['size']}"] = world["solvers"][2]["hot_of_bullet"]
        # Kinds come again after each has had its turn.
        self.assertEqual(len(worlds), 5, ratios)
        self.assertEqual([" ".join(line.split()[:2]) for line in slowest.splitlines()[2:]],
                         sorted(ratios, key=ratios.get, reverse=True)[:3])
        hot = [line.split() for line in shares.splitlines() if line.startswith("time hot")]
        self.assertEqual(sum(int(line[4]) for line in hot), len(worlds), shares)
        with open(self.path("r.md"), encoding="utf-8") as file:
            self.assertRegex(file.read(), r"(?m)^\| tree ")

    def test_it_is_not_run_beside_other_scenes(self):
        for words in (["run", "castle", "small"], ["run", "--frames", "10", "small"]):
            self.assertIn("cairn run small", self.refused(USAGE, *words))

    def test_a_file_that_cannot_be_written_is_refused_before_the_run(self):
        self.refused(BAD_INPUT, "run", "small", "--frames", "1000000", "--json", "/no/such/place")


if __name__ == "__main__":
    cli_test.TOOL = os.path.abspath(sys.argv.pop(1))
    unittest.main()
