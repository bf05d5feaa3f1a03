# SPDX-License-Identifier: MIT
"""cairn_accuracy as its users meet it: python3 accuracy_cli_test.py PATH_OF_CAIRN_ACCURACY"""
import json
import math
import os
import subprocess
import sys
import tempfile
import unittest

TOOL = ""
FINE, USAGE, BAD_INPUT = 0, 2, 3


def accuracy(*arguments):
    return subprocess.run([TOOL, *arguments], capture_output=True, text=True, timeout=300)


class AccuracyTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.file = os.path.join(folder.name, "r.json")

    def run_json(self, *arguments):
        """What it printed, and wrote."""
        result = accuracy(*arguments, "--json", self.file)
        self.assertEqual(result.returncode, FINE, result.stdout + result.stderr)
        self.assertEqual(result.stderr, "")
        with open(self.file, encoding="utf-8") as file:
            written = json.load(file)
        self.assertEqual(written["subcommand"], arguments[0])
        context = written["context"]
        for known in (context["host"]["simd_target"], context["build"]["bullet"]["version"],
                      context["build"]["compiler"]):
            self.assertTrue(known)
            self.assertIn(known, result.stdout)
        self.assertNotIn(os.path.dirname(self.file), result.stdout + json.dumps(written))
        return result.stdout, written

    def refused(self, code, *arguments):
        result = accuracy(*arguments)
        self.assertEqual(result.returncode, code, result.stdout + result.stderr)
        self.assertEqual(result.stdout, "")
        return result.stderr

    def assert_positive(self, value):
        self.assertTrue(math.isfinite(value) and value > 0, value)


class UsageTest(AccuracyTest):
    def test_alone_it_shows_what_there_is(self):
        alone, asked = accuracy(), accuracy("--help")
        self.assertEqual((alone.returncode, alone.stderr), (FINE, ""))
        self.assertIn("tension", alone.stdout)
        self.assertEqual(alone.stdout, asked.stdout)
        self.assertEqual(accuracy("help", "grid").stdout, accuracy("grid", "--help").stdout)

    def test_what_cannot_be_is_a_sentence_that_says_where_help_is(self):
        for words, why in ((["states", "--quiet"], "unknown option '--quiet'"),
                           (["states", "--seed"], "--seed needs a value, such as '--seed 10'"),
                           (["states", "--seed", "x"], "--seed 'x': not understood, write '--seed 10'"),
                           (["states", "--frames", "0"],
                            "--frames '0': write a number from 4 to 1000000 (Frames of each scene)"),
                           (["grid", "--policy", "never"], "--policy 'never': write always or"),
                           (["--bogus"], "unknown option '--bogus'"),
                           (["--seed", "3", "states"], "--seed comes after the command"),
                           (["sates"], "unknown command 'sates': did you mean 'states'?")):
            message = self.refused(USAGE, *words)
            self.assertTrue(message.startswith("cairn_accuracy: " + why), message)
            self.assertRegex(message, r"'cairn_accuracy( help \w+' says more| \w+ --help' shows all|"
                                      r"' shows what there is| --help' shows all)\n$")


class StatesTest(AccuracyTest):
    def test_a_chain_has_a_converged_reference_and_finite_errors(self):
        text, written = self.run_json("states", "--scenes", "chain", "--frames", "24", "--samples",
                                      "2", "--rounds", "3")
        scene, = written["scenes"]
        self.assertEqual((scene["scene"], scene["goal"]), ("chain", 0.01))
        self.assertIn("| chain", text)
        self.assertNotIn("did not converge", text)
        first, second = (state["frame"] for state in scene["states"])  # moves if interrupted
        self.assertIn(first, range(6, 14))
        self.assertIn(second, range(18, 24))
        frames = scene["frames_with_steps"]
        self.assertEqual(frames["frames"], 14)
        self.assertTrue(0 <= frames["share_with_a_step"] <= 1)
        self.assertGreaterEqual(frames["wall_over_budget_us"]["max"],
                                frames["wall_over_budget_us"]["p50"])
        for state in scene["states"]:
            self.check_state(state)

    def check_state(self, state):
        self.assertEqual((state["bodies"], state["rows"]), (22, 63))
        reference, bullet = state["reference"], state["bullet"]
        self.assertTrue(reference["converged"])
        self.assertLessEqual(reference["residual_max_m_s"], 1e-8)
        self.assertLess(reference["spread"]["rms_m_s"], 1e-6)
        self.assert_positive(bullet["error"]["rms_m_s"])
        self.assertLessEqual(bullet["error_after_them"]["rms_m_s"], bullet["error"]["rms_m_s"])
        self.assertLess(bullet["error"]["rms_m_s"], bullet["error_of_warm_start"]["rms_m_s"])
        self.assert_positive(state["budget_ms"])
        for kind in ("sweeps", "accelerated", "steps"):
            cairn = state[kind]
            self.assert_positive(cairn["error"]["rms_m_s"])
            self.assert_positive(cairn["error"]["max_m_s"])
            for time in ("cpu_ms", "wall_ms", "build_ms", "solve_ms", "write_ms"):
                self.assert_positive(cairn[time])
            self.assertGreaterEqual(cairn["sweeps"], 1)
            self.assertLessEqual(cairn["worth_bullet_iterations"] or 0,
                                 bullet["followed_iterations"])
        for kind in ("sweeps", "accelerated"):
            self.assertEqual(state[kind]["steps_accepted"], 0)

    def test_a_reference_that_did_not_converge_is_named(self):
        text, written = self.run_json("states", "--scenes", "heavy-top", "--frames", "16",
                                      "--samples", "1", "--rounds", "1", "--most", "20")
        state, = written["scenes"][0]["states"]
        self.assertEqual("did not converge" in text, not state["reference"]["converged"])
        self.assertGreater(state["reference"]["sweeps"], 0)
        self.assertLessEqual(state["bullet"]["followed_iterations"], 20)

    def test_bad_input_is_refused_with_a_reason(self):
        self.assertIn("did you mean 'chain'", self.refused(USAGE, "states", "--scenes", "chian"))
        self.assertIn("--most", self.refused(USAGE, "states", "--most", "5"))
        self.assertIn("--frames", self.refused(USAGE, "states", "--frames", "none"))
        self.assertIn("cannot write",
                      self.refused(BAD_INPUT, "states", "--json", "/no/such/folder/r.json"))


class LoopTest(AccuracyTest):
    def test_every_budget_and_seed_has_its_figures(self):
        text, written = self.run_json("loop", "--scenes", "heavy-top,ragdolls", "--frames", "8",
                                      "--seeds", "3", "--budgets", "1ms,200us")
        self.assertEqual(written["budgets_ms"], [1, 0.2])
        heavy_top, ragdolls = written["scenes"]
        self.assertEqual(heavy_top["judged_by"], "height_lost_m")
        self.assertEqual(ragdolls["judged_by"], "joint_gap_m")
        for scene in written["scenes"]:
            self.assertEqual([(solver["solver"], solver["effort"]) for solver in scene["solvers"]],
                             [(kind, budget) for budget in ("1 ms", "200 us")
                              for kind in ("sweeps", "accelerated", "steps")] +
                             [("bullet-si", "10 iterations")])
            for solver in scene["solvers"]:
                self.check_solver(solver, scene["judged_by"])
        self.assertIn("| 0/3 |", " ".join(text.split()))
        lost = heavy_top["solvers"][-1]["figures"]["height_lost_m"]["runs"]
        self.assertEqual(len(set(lost)), 3, "seeds make no difference")
        self.assertIn("## ragdolls (judged by joint gap), 3 seeds", text)

    def test_a_run_that_is_out_of_time_prints_what_it_has(self):
        text, written = self.run_json("loop", "--scenes", "heavy-top,tower", "--frames", "8",
                                      "--seeds", "9", "--budgets", "1ms", "--minutes", "0.00001")
        scene, = written["scenes"]
        self.assertEqual(len(scene["solvers"][0]["figures"]["residual_m_s"]["runs"]), 1)
        self.assertIn("stopped early: heavy-top has 1 seeds", text)

    def check_solver(self, solver, judged_by):
        self.assertEqual((solver["collapsed"], solver["failures"], solver["failed_seeds"]), (0, [], []))
        for name, figure in solver["figures"].items():
            self.assertEqual(len(figure["runs"]), 3)
            if name in (judged_by, "residual_m_s", "time_ms"):
                for value in figure["runs"]:
                    self.assertTrue(math.isfinite(value))
        if solver["solver"] != "steps":
            self.assertEqual(solver["figures"]["steps_accepted"]["runs"], [0, 0, 0])

    def test_bad_input_is_refused_with_a_reason(self):
        self.assertIn("no unit", self.refused(USAGE, "loop", "--budgets", "2"))
        self.assertIn("names no time", self.refused(USAGE, "loop", "--budgets", ","))
        self.assertIn("--seeds", self.refused(USAGE, "loop", "--seeds", "0"))


class GridTest(AccuracyTest):
    def test_the_quick_grid_holds_no_nan(self):
        text, written = self.run_json("grid", "--quick", "--frames", "40")
        self.assertEqual(len(written["cells"]), 3 * 2 * 2 + 2 * 3 * 2)
        names = [cell["name"] for cell in written["cells"]]
        self.assertEqual(len(set(names)), len(names))
        for cell in written["cells"]:
            for solver in ("steps", "sweeps", "bullet"):
                run = cell[solver]
                self.assertFalse(run["not_a_number"], cell["name"])
                if not run["failure"]:
                    self.assertGreaterEqual(run["defect_m"], 0)
                    self.assertGreaterEqual(run["energy_gain"], 0)
            self.assertEqual(cell["sweeps"]["steps_accepted"], 0)
        self.assertIn("pile, 1:10000", text)
        self.assertIn("chain of 30", text)

    def test_a_run_is_repeatable(self):
        arguments = ("grid", "--quick", "--frames", "10", "--scenes", "chain")
        first, second = (self.run_json(*arguments)[1]["cells"] for _ in range(2))
        self.assertEqual(first, second)

    def test_steps_that_are_always_taken_are_taken(self):
        _, written = self.run_json("grid", "--quick", "--frames", "10", "--policy", "always")
        for cell in written["cells"]:
            self.assertGreater(cell["steps"]["steps_accepted"] + cell["steps"]["steps_restored"], 0)

    def test_bad_input_is_refused_with_a_reason(self):
        self.assertIn("--policy", self.refused(USAGE, "grid", "--policy", "never"))
        self.assertIn("'pile'", self.refused(USAGE, "grid", "--scenes", "pule"))


class TensionTest(AccuracyTest):
    def test_every_cell_has_its_figures(self):
        text, written = self.run_json("tension", "--stages", "plane,free", "--joints", "pin,hinge",
                                      "--limits", "both", "--links", "1,2", "--loads", "10,100",
                                      "--rates", "30,60", "--seconds", "0.5",
                                      "--reference-links", "1")
        # pins have no limits
        self.assertEqual(len(written["cells"]), 2 * 3 * 2 * 2 * 2)
        names = [cell["name"] for cell in written["cells"]]
        self.assertEqual(len(set(names)), len(names))
        for cell in written["cells"]:
            self.assertIn("cairn", cell["solvers"])
            self.assertIn("bullet-200", cell["solvers"])
            for run in cell["solvers"].values():
                if not run["failure"]:
                    self.assertGreaterEqual(run["gap_m"], 0)
                self.assertEqual("load_off" in run, cell["links"] == 1)
            self.assertEqual(cell["solvers"]["cairn-sweeps"]["subspace_steps_per_step"], 0)
        self.assertIn("## plane, hinge with limits, 30 Hz: largest gap [mm]", text)

    def test_a_run_is_repeatable(self):
        def cells():
            found = self.run_json("tension", "--links", "3", "--loads", "100", "--seconds", "1",
                                  "--solvers", "cairn,bullet-10")[1]["cells"]
            for cell in found:
                for run in cell["solvers"].values():
                    del run["cpu_us_per_step"]
            return found
        self.assertEqual(cells(), cells())

    def test_bad_input_is_refused_with_a_reason(self):
        self.assertIn("did you mean 'hinge'", self.refused(USAGE, "tension", "--joints", "hing3"))
        self.assertIn("--links", self.refused(USAGE, "tension", "--links", "0"))
        self.assertIn("--seconds", self.refused(USAGE, "tension", "--seconds", "0"))
        self.assertIn("cannot write",
                      self.refused(BAD_INPUT, "tension", "--json", "/no/such/folder/r.json"))


class StandTest(AccuracyTest):
    def test_every_seed_has_its_figures(self):
        text, written = self.run_json("stand", "--scene", "tower:5", "--seeds", "3", "--seconds",
                                      "1", "--solvers", "cairn,bullet-10", "--jobs", "2")
        self.assertEqual([solver["name"] for solver in written["solvers"]], ["cairn", "bullet-10"])
        for solver in written["solvers"]:
            self.assertEqual([run["seed"] for run in solver["runs"]], [0, 1, 2])
            for run in solver["runs"]:
                self.assertNotIn("fell_s", run)
                self.assertLess(abs(run["height_lost_m"]), 0.1)
            self.assertEqual(solver["iterations"], 10)
        self.assertIn("0 of 3", text)

    def test_iterations_are_those_of_all_solvers(self):
        _, written = self.run_json("stand", "--scene", "tower:3", "--seeds", "1", "--seconds", "1",
                                   "--solvers", "cairn,bullet-10", "--iterations", "4")
        self.assertEqual([solver["iterations"] for solver in written["solvers"]], [4, 4])

    def test_bad_input_is_refused_with_a_reason(self):
        self.assertIn("'tower'", self.refused(USAGE, "stand", "--scene", "towr"))
        self.assertIn("--seeds", self.refused(USAGE, "stand", "--seeds", "0"))
        self.assertIn("did you mean", self.refused(USAGE, "stand", "--solvers", "cairm"))


if __name__ == "__main__":
    TOOL = sys.argv.pop(1)
    unittest.main()
