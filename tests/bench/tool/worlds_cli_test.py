# SPDX-License-Identifier: MIT
"""cairn worlds as its users meet it: python3 worlds_cli_test.py PATH_OF_CAIRN"""
import json
import math
import os
import re
import statistics
import sys
import unittest

import cli_test
from cli_test import USAGE, CairnTest, cairn

FAILED = 1
BRIDGE = "6"  # a seed of the kind two-pin-bridge
QUICK = ["worlds", "--seeds", "0:8", "--seconds", "0.2"]


class WorldsTest(CairnTest):
    def worlds(self, *arguments):
        """What it wrote, whether or not an oracle failed."""
        result = cairn("worlds", *arguments)
        self.assertIn(result.returncode, (0, FAILED), result.stderr)
        return result.stdout

    def test_list_names_the_kinds(self):
        names = [line.split()[0] for line in self.fine("worlds", "--list").splitlines()]
        self.assertIn("bridge-two-pins", names)
        self.assertGreaterEqual(len(names), 30)
        self.assertEqual(len(set(names)), len(names))

    def test_the_table_has_a_line_for_each_solver_and_kind(self):
        text = self.worlds("--seeds", "0:8", "--seconds", "0.2", "--solver", "cairn,cairn-work")
        for name in ("bullet-10", "bullet-100", "cairn", "cairn-work", "chain", "net"):
            self.assertRegex(text, rf"(?m)^{name} ")
        self.assertNotIn("cairn-always", text)
        self.assertIn("restless", text)

    def test_results_do_not_depend_on_jobs(self):
        results = []
        for jobs in ("1", "3"):
            self.worlds("--seeds", "0:8", "--seconds", "0.2", "--jobs", jobs, "--json",
                        self.path("w.json"))
            with open(self.path("w.json"), encoding="utf-8") as file:
                worlds = json.load(file)["worlds"]
            for world in worlds:
                for solver in world["solvers"]:
                    del solver["cpu_s"]
            results.append(worlds)
        self.assertEqual(results[0], results[1])
        self.assertEqual([world["seed"] for world in results[0]], list(range(8)))
        self.assertEqual(len(results[0][0]["solvers"]), 7)

    def test_runs_of_bullet_are_taken_from_a_file_of_the_same_worlds(self):
        def worlds(seeds, *arguments):
            text = self.worlds("--seeds", seeds, "--seconds", "0.2", "--solver", "cairn", "--json",
                               self.path("new.json"), *arguments)
            with open(self.path("new.json"), encoding="utf-8") as file:
                result = json.load(file)
            for world in result["worlds"]:
                world["solvers"] = [(s["solver"], s["hash"], s["failures"], s["asleep_s"])
                                    for s in world["solvers"]]
            # Ends of lines are times, and how many of these are smaller or larger.
            return re.sub(r" +[0-9.]+( +\d+/\d+)?$", "", text, flags=re.MULTILINE), result["worlds"]
        plain = worlds("0:12")
        self.worlds("--seeds", "0:8", "--seconds", "0.2", "--solver", "cairn-sweeps", "--json",
                    self.path("old.json"))
        self.assertEqual(worlds("0:12", "--beside", self.path("old.json")), plain)
        with open(self.path("old.json"), encoding="utf-8") as file:
            old = json.load(file)
        old["worlds"][3]["solvers"][0]["hash"] = "000000000000002a"
        with open(self.path("old.json"), "w", encoding="utf-8") as file:
            json.dump(old, file)
        self.assertIn("000000000000002a", str(worlds("0:12", "--beside", self.path("old.json"))))

        def refusal(*arguments):
            return self.refused(USAGE, "worlds", "--beside", self.path("old.json"), *arguments)
        self.assertIn("0.2 s long", refusal("--seeds", "0:2", "--seconds", "0.3"))
        self.assertIn("float64", refusal("--seeds", "0:2", "--seconds", "0.2", "--float64"))
        with open(self.path("old.json"), "w", encoding="utf-8") as file:
            file.write('{"worlds": []}')
        self.assertIn("no result of cairn worlds", refusal("--seeds", "0:2"))
        os.remove(self.path("old.json"))
        self.assertIn("cannot be read", refusal("--seeds", "0:2"))

    def test_gaps_are_compared_with_those_of_bullet(self):
        text = self.worlds("--seeds", "0:40", "--kind", "chain,net,truss", "--seconds", "0.3", "--solver", "cairn",
                           "--json", self.path("w.json"))
        with open(self.path("w.json"), encoding="utf-8") as file:
            worlds = [{solver["solver"]: solver["gap_m"] for solver in world["solvers"]}
                      for world in json.load(file)["worlds"]]
        # What is below 1 mm with Bullet is left out; with others, what is below 0.01 mm counts as that.
        ratios = {name: [max(world[name], 1e-5) / world["bullet"] for world in worlds if world["bullet"] > 1e-3]
                  for name in ("bullet-10", "bullet-100", "cairn")}
        self.assertEqual(len(ratios["cairn"]), 3)
        for name, of in ratios.items():
            said = re.search(rf"(?m)^{name} +([0-9.]+) +(\d)/(\d) ", text[text.index("of bullet's"):])
            self.assertAlmostEqual(float(said[1]), statistics.geometric_mean(of), delta=6e-4)
            self.assertEqual(int(said[2]), sum(math.log(ratio) < -0.1 for ratio in of))
            self.assertEqual(int(said[3]), sum(math.log(ratio) > 0.1 for ratio in of))

    def test_runs_are_compared_with_earlier_ones(self):
        short = ("--seconds", "0.3", "--solver", "cairn")
        self.worlds("--seeds", "0:20", *short, "--json", self.path("old.json"))
        same = self.worlds("--seeds", "0:20", *short, "--against", self.path("old.json"))
        self.assertRegex(same, r"(?m)^cairn +20 +0 +- +-")
        other = self.worlds("--seeds", "0:40", *short, "--heavy", "--against",
                            self.path("old.json"))
        changed = re.search(r"(?m)^cairn +20 +(\d+) +([0-9.]+) +(\d+)/(\d+)", other)
        self.assertLess(int(changed[1]), 20)
        self.assertLessEqual(int(changed[3]) + int(changed[4]), int(changed[1]))
        self.assertGreater(float(changed[2]), 0)
        said = self.refused(USAGE, "worlds", "--seeds", "0:2", "--against", self.path("old.json"))
        self.assertIn("0.3 s long", said)

    def test_conditions_are_said_and_those_in_metres_have_no_units(self):
        for name, words in (("played", "somebody plays"), ("dragged", "somebody drags"),
                            ("moving", "moving ground"), ("pressed", "plates press")):
            text = self.worlds("--seed", BRIDGE, "--report", "--seconds", "0.2", "--" + name)
            self.assertIn(", " + words, text)
            said = self.refused(USAGE, "worlds", "--seed", "1", "--unit", "100", "--" + name)
            self.assertIn("--" + name, said)

    def test_doubts_are_a_number(self):
        said = self.refused(USAGE, "worlds", "--seeds", "0:2", "--doubts", "few")
        self.assertIn("--doubts", said)

    def test_a_kind_leaves_only_its_worlds(self):
        self.worlds("--seeds", "0:90", "--kind", "tower,gears", "--seconds", "0.1", "--solver",
                    "cairn-sweeps", "--json", self.path("w.json"))
        with open(self.path("w.json"), encoding="utf-8") as file:
            kinds = [world["kind"] for world in json.load(file)["worlds"]]
        self.assertEqual(set(kinds), {"tower", "gears"})

    def test_a_report_says_what_the_world_is(self):
        text = self.worlds("--seed", BRIDGE, "--report", "--seconds", "0.2", "--solver", "cairn")
        self.assertRegex(text, r"^seed 6, two-pin-bridge: .*; 53 bodies of .* kg, 98 joints; 60 Hz, 10 iterations")
        self.assertRegex(text, r"(?m)^bullet-100 .*\ncairn ")

    def test_a_smaller_scale_has_fewer_bodies(self):
        text = self.worlds("--seed", BRIDGE, "--report", "--seconds", "0.2", "--scale", "0.1")
        self.assertLess(int(re.search(r"; (\d+) bodies", text).group(1)), 53)

    def test_the_same_bits_on_every_target(self):
        self.assertRegex(self.worlds(*QUICK[1:], "--bits", "--solver", "cairn"),
                         r"(?m)^cairn +\d+ +\d+ +\d+ +\d+ +\d+ +\d+ +0 ")

    def test_names_of_solvers_in_run_and_solve_are_taken(self):
        for typed in ("cairn-pgs,pgs-sm", "pgs-nncg,cairn"):
            text = self.worlds(*QUICK[1:], "--solver", typed)
            self.assertRegex(text, r"(?m)^bullet-100 .*\ncairn-sweeps .*\ncairn ")
        for bullet in ("bullet", "bullet-si"):
            self.assertIn(f"'{bullet}': cairn worlds runs Bullet beside all others anyway",
                          self.refused(USAGE, "worlds", "--seed", "1", "--solver", f"cairn,{bullet}"))
        self.assertIn("cairn-sweeps comes nearest",
                      self.refused(USAGE, "worlds", "--seed", "1", "--solver", "pgs"))

    def test_what_cannot_be_is_refused(self):
        for words, expected in ((["worlds"], "--seeds"),
                                (["worlds", "--seeds", "5"], "FROM:TO"),
                                (["worlds", "--seeds", "9:3"], "none"),
                                (["worlds", "--seeds", "a:3"], "--seeds"),
                                (["worlds", "--seeds", "0:9", "--kind", "castles"], "kind"),
                                (["worlds", "--seed", "1", "--kind", "tower"], "none of the seeds"),
                                (["worlds", "--seed", "1", "--solver", "bulet"], "solver"),
                                (["worlds", "--seed", "1", "--solver", ","], "no solver"),
                                (["worlds", "--seed", "1", "--seconds", "0"], "--seconds"),
                                (["worlds", "--seed", "1", "--scale", "2"], "--scale"),
                                (["worlds", "--seed", "1", "--jobs", "0"], "--jobs"),
                                (["worlds", "--seed", "-1"], "--seed"),
                                (["worlds", "--sed", "1"], "--seed")):
            self.assertIn(expected, self.refused(USAGE, *words))

    def test_files_that_cannot_be_written_are_refused_before_the_run(self):
        self.refused(cli_test.BAD_INPUT, "worlds", "--seeds", "0:100000", "--json", "/no/such/place")
        self.refused(cli_test.BAD_INPUT, "worlds", "--seeds", "0:100000", "--shrink",
                     "/dev/null/place")


if __name__ == "__main__":
    cli_test.TOOL = os.path.abspath(sys.argv.pop(1))
    unittest.main()
