# SPDX-License-Identifier: MIT
"""Statistics of closed loops: python3 loop_tables_test.py PATH_OF_CAIRN_ACCURACY

Exit code 77, skipped, where there is no SciPy."""
import json
import math
import os
import subprocess
import sys
import tempfile
import unittest

SKIPPED = 77
SCRIPTS = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "..", "bench", "accuracy")
sys.path.insert(0, SCRIPTS)
try:
    import numpy
    import loop_tables
except ImportError as error:
    print(f"skipped: {error} (Debian: python3-scipy)")
    sys.exit(SKIPPED)

TOOL = ""
INFINITE, NAN = math.inf, math.nan


def compare(first, second):
    return loop_tables.compare_paired(numpy.array(first, dtype=float), numpy.array(second, dtype=float))


class IntervalTest(unittest.TestCase):
    # P(Binomial(20, 1/2) <= 5) = 2.07 %, <= 6: 5.8 %.
    def test_the_median_of_20_values_reaches_from_the_6th_to_the_15th(self):
        interval = loop_tables.median_interval(numpy.arange(20.0, 0, -1))
        self.assertEqual(interval, {"value": 10, "low": 6, "high": 15})

    # P(Binomial(6, 1/2) = 0) = 1.6 % and P(Binomial(8, 1/2) <= 1) = 3.5 %, which is too much.
    def test_few_values_reach_from_the_smallest_to_the_largest(self):
        for count in (2, 5, 6, 8):
            interval = loop_tables.median_interval(numpy.arange(1.0, count + 1))
            self.assertEqual((interval["low"], interval["high"]), (1, count))
        self.assertTrue(math.isnan(loop_tables.median_interval(numpy.array([NAN]))["value"]))

    # Wilson's interval of 0 of 20: [0, z^2 / (n + z^2)]; of 10 of 20 it is 1/2 -+ 0.2007.
    def test_shares_are_those_of_wilson(self):
        none, half, all_of_them = (loop_tables.share_interval(hits, 20) for hits in (0, 10, 20))
        self.assertAlmostEqual(none["low"], 0)
        self.assertAlmostEqual(none["high"], 3.8415 / 23.8415, 4)
        self.assertAlmostEqual(half["low"], 0.5 - 0.2007, 4)
        self.assertAlmostEqual(all_of_them["low"], 1 - 3.8415 / 23.8415, 4)


class PairedTest(unittest.TestCase):
    # All 2^n signs are as likely: five of one sign, 2 of 32; the smallest of six of the other sign, 4 of 64.
    def test_it_is_exact_for_few_pairs(self):
        self.assertAlmostEqual(compare([1, 2, 3, 4, 5], [0] * 5)["p"], 2 / 32)
        self.assertAlmostEqual(compare([-1, 2, 3, 4, 5, 6], [0] * 6)["p"], 4 / 64)
        self.assertEqual(compare([], [])["p"], 1)
        self.assertGreater(compare([1, -1, 1], [0] * 3)["p"], 0.5)

    # Table of Wilcoxon's T: for 20 pairs 52 is the largest that is significant at 5 %.
    def test_it_has_the_critical_value_of_the_tables(self):
        def p_of(rank_sum):
            values = list(range(1, 21))
            for rank in range(20, 0, -1):
                if rank <= rank_sum:
                    values[rank - 1] *= -1
                    rank_sum -= rank
            return compare(values, [0] * 20)["p"]
        self.assertLessEqual(p_of(52), 0.05)
        self.assertGreater(p_of(53), 0.05)

    def test_few_pairs_that_differ_equally_are_counted_sign_by_sign(self):
        self.assertEqual(compare([1, 1, 1], [0, 0, 0])["p"], 2 / 2 ** 3)
        self.assertEqual(compare([1] * 12, [0] * 12)["p"], 2 / 2 ** 12)

    def test_failed_runs_are_worst_and_nan_is_left_out(self):
        test = compare([1, INFINITE, 3, NAN, INFINITE], [2, INFINITE, INFINITE, 1, 5])
        self.assertEqual((test["less"], test["more"], test["equal"]), (2, 1, 1))
        self.assertGreater(test["p"], 0.7)  # ranks 1 and 2.5 against 2.5

    def test_holm_multiplies_by_what_is_left_and_never_falls(self):
        for p, expected in zip(loop_tables.holm([0.01, 0.04, 0.03]), (0.03, 0.06, 0.06)):
            self.assertAlmostEqual(p, expected)
        self.assertEqual(loop_tables.holm([0.9, 0.8])[0], 1)


class TablesTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.run_file, self.out_file = (os.path.join(folder.name, name) for name in ("run.json", "out.json"))

    def tables(self):
        result = subprocess.run([sys.executable, os.path.join(SCRIPTS, "loop_tables.py"), self.run_file,
                                 "--json", self.out_file], capture_output=True, text=True, check=True)
        with open(self.out_file, encoding="utf-8") as file:
            return result.stdout, json.load(file)

    def test_every_budget_has_its_comparisons_and_every_scene_its_medians(self):
        subprocess.run([TOOL, "loop", "--scenes", "heavy-top,ragdolls", "--frames", "8", "--seeds", "3", "--budgets",
                        "1ms,200us", "--json", self.run_file], check=True, capture_output=True, timeout=300)
        text, written = self.tables()
        self.assertIn("## Compared, 1 ms", text)
        self.assertIn("0/3 [0, 56] %", text)  # Wilson's interval of none of three
        self.assertIn("## ragdolls (judged by joint gap), 3 seeds", text)
        self.assertEqual(len(written["comparisons"]), 2 * 5)
        for comparison in written["comparisons"]:
            for test in comparison["scenes"].values():
                self.assertEqual(test["less"] + test["more"] + test["equal"], 3)
                self.assertTrue(0.25 <= test["p"] <= 1)  # of three pairs
        figure = written["scenes"][0]["solvers"][-1]["figures"]["height_lost_m"]
        self.assertEqual([figure["median"][name] for name in ("low", "value", "high")], sorted(figure["runs"]))

    def test_what_is_lost_is_named(self):
        figures = {key: {"runs": [1.0] * 8} for key in loop_tables.FIGURES}
        def solver(name, height, failed):
            return {"solver": name, "effort": "", "can_fall": True, "collapsed": len(failed), "failures": [],
                    "failed_seeds": failed, "figures": {**figures, "height_lost_m": {"runs": height}}}
        low, high = [0.001 * i for i in range(1, 9)], [None] + [0.01 + 0.002 * i for i in range(2, 9)]
        with open(self.run_file, "w", encoding="utf-8") as file:
            json.dump({"subcommand": "loop", "context": {"command": "x"}, "budgets_ms": [2],
                       "scenes": [{"scene": "tower", "judged_by": "height_lost_m",
                                   "solvers": [solver("sweeps", low, []), solver("accelerated", low, []),
                                               solver("steps", high, [1]), solver("bullet-si", low, [])]}]}, file)
        text, written = self.tables()
        for other in ("Bullet", "sweeps", "accelerated"):
            self.assertIn(f"- lost: tower, steps with {other}\n", text)
        self.assertNotIn("lost: tower, sweeps", text)
        self.assertIn("WORSE 0:8 p 0.00781", text)  # 2 of 2^8
        self.assertIn("1/8 [", text)
        steps = written["scenes"][0]["solvers"][2]["figures"]["height_lost_m"]["median"]
        self.assertIsNone(steps["high"])  # infinite


if __name__ == "__main__":
    TOOL = os.path.abspath(sys.argv.pop(1))
    unittest.main()
