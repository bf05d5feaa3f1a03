# SPDX-License-Identifier: MIT
"""cairn compare on files that were run and changed: python3 compare_cli_test.py PATH_OF_CAIRN"""
import copy
import json
import os
import sys
import tempfile
import unittest

import cli_test
from cli_test import FINE, USAGE, CairnTest, cairn

REGRESSION = 1
RUN = ["run", "tower", "wall", "--frames", "40", "--warmup", "4", "--samples", "0", "--repeat", "5",
       "--solver", "bullet-si,bullet-si@15,cairn"]


class CompareTest(CairnTest):
    @classmethod
    def setUpClass(cls):
        """One run that is the old one of all tests; new ones are made of it."""
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        path = os.path.join(folder.name, "old.json")
        result = cairn(*RUN, "--json", path)
        assert result.returncode == FINE, result.stderr
        with open(path, encoding="utf-8") as file:
            cls.old = json.load(file)
        # What is true of a comparison must not depend on how noisy this machine is now.
        for scene in cls.old["scenes"]:
            for series in [scene["metronome"], *(s["repetitions"] for s in scene["solvers"])]:
                calm_down(series)

    def write(self, name, result):
        with open(self.path(name), "w", encoding="utf-8") as file:
            file.write(result if isinstance(result, str) else json.dumps(result))
        return self.path(name)

    def compare(self, new, *more, old=None):
        return cairn("compare", self.write("old.json", old or self.old), self.write("new.json", new),
                     *more)

    def changed(self, change):
        new = copy.deepcopy(self.old)
        change(new)
        return new

    def refusal(self, new, old=None):
        result = self.compare(new, old=old)
        self.assertEqual(result.returncode, USAGE, result.stdout + result.stderr)
        self.assertEqual(result.stdout, "")
        self.assertEqual(result.stderr.count("\n"), 1, result.stderr)
        return result.stderr


def calm_down(repetitions):
    """Makes repetitions as quick as the quickest in each frame, but for 0.2 %."""
    for key in repetitions[0]:
        if not key.endswith("_ms"):
            continue
        frames = list(zip(*(repetition[key] for repetition in repetitions)))
        for i, repetition in enumerate(repetitions):
            repetition[key] = [None if None in times else min(times) * (1 + 0.002 * (i % 2))
                               for times in frames]


def solver_of(result, scene=0, solver=0):
    return result["scenes"][scene]["solvers"][solver]


def scale(result, key, factor, scene=0, solver=0):
    for repetition in solver_of(result, scene, solver)["repetitions"]:
        repetition[key] = [None if value is None else factor * value for value in repetition[key]]


class VerdictTest(CompareTest):
    def test_a_run_and_itself_are_the_same(self):
        result = self.compare(self.old)
        self.assertEqual(result.returncode, FINE, result.stdout)
        self.assertIn("0 regressions", result.stdout)
        self.assertNotIn("REGRESSION:", result.stdout)
        for solver in ("bullet-si", "bullet-si@15", "cairn"):
            self.assertRegex(result.stdout, rf"(?m)^wall +{solver} .* \+0\.0 ")

    def test_ten_percent_in_one_solver_are_one_regression_in_a_sentence(self):
        result = self.compare(self.changed(lambda r: scale(r, "time_ms", 1.1, 1, 0)))
        self.assertEqual(result.returncode, REGRESSION, result.stdout)
        sentences = [line for line in result.stdout.splitlines() if line.startswith("REGRESSION: ")]
        self.assertEqual(len(sentences), 1, result.stdout)
        self.assertRegex(sentences[0], r"wall, bullet-si \(10 iterations\): 10\.0 % slower \(between "
                                       r"\+\d.* and \+1\d\.\d %\); from repetition to repetition")
        self.assertIn("1 regression;", result.stdout)

    def test_the_threshold_decides(self):
        new = self.changed(lambda r: scale(r, "time_ms", 1.1, 1, 0))
        self.assertEqual(self.compare(new, "--threshold", "20%").returncode, FINE)
        self.assertEqual(self.compare(new, "--threshold", "8").returncode, REGRESSION)

    def test_faster_is_no_regression(self):
        result = self.compare(self.changed(lambda r: scale(r, "time_ms", 0.8)))
        self.assertEqual(result.returncode, FINE)
        self.assertIn("improved", result.stdout)

    def test_a_solver_that_truly_does_more_work_is_found(self):
        # 15 iterations in place of 10 in the same run: both had the same machine.
        def replace(result):
            for scene in result["scenes"]:
                scene["solvers"][0] = {**copy.deepcopy(scene["solvers"][1]), "solver": "bullet-si",
                                       "effort": "10 iterations"}
        result = self.compare(self.changed(replace))
        self.assertEqual(result.returncode, REGRESSION, result.stdout)
        self.assertRegex(result.stdout, r"REGRESSION: wall, bullet-si .* % slower")

    def test_errors_count_too(self):
        result = self.compare(self.changed(lambda r: scale(r, "residual_m_s", 1.5, 0, 1)))
        self.assertEqual(result.returncode, REGRESSION)
        self.assertRegex(result.stdout, r"REGRESSION: tower, bullet-si@15 .* 50\.0 % less accurate")
        self.assertEqual(self.compare(self.changed(lambda r: scale(r, "residual_m_s", 1.5, 0, 1)),
                                      "--error-threshold", "60%").returncode, FINE)

    def test_a_solver_that_fails_now_is_a_regression(self):
        failure = {"frame": 7, "reason": "exploded: a body moves at 2.0e+03 m/s"}
        new = self.changed(lambda r: solver_of(r).update(failure=failure))
        result = self.compare(new)
        self.assertEqual(result.returncode, REGRESSION)
        self.assertIn("failed at frame 7, exploded", result.stdout)
        self.assertEqual(self.compare(new, old=new).returncode, FINE)

    def test_a_slower_machine_is_no_regression(self):
        def slow_down(result):
            for scene in range(2):
                for solver in range(3):
                    scale(result, "time_ms", 1.2, scene, solver)
            for scene in result["scenes"]:
                for beats in scene["metronome"]:
                    for part in beats:
                        beats[part] = [1.2 * time for time in beats[part]]
        result = self.compare(self.changed(slow_down))
        self.assertEqual(result.returncode, FINE, result.stdout)

    def test_what_noise_hides_is_said(self):
        def disturb(result):
            for repetition, factor in zip(solver_of(result, 1)["repetitions"], (1.0, 1.5, 1.5, 1.5, 1.5)):
                repetition["time_ms"] = [None if t is None else factor * t for t in repetition["time_ms"]]
        result = self.compare(self.changed(disturb))
        self.assertEqual(result.returncode, FINE, result.stdout)
        self.assertRegex(result.stdout, r"wall, bullet-si \(10 iterations\): cannot tell whether")

    def test_what_goes_by_the_clock_is_not_judged(self):
        def slower(result):
            scale(result, "time_ms", 1.5)
        timed = self.changed(lambda r: solver_of(r).update(effort="2 ms"))
        new = copy.deepcopy(timed)
        slower(new)
        result = self.compare(new, old=timed)
        self.assertEqual(result.returncode, FINE, result.stdout)
        self.assertIn("tower, bullet-si (2 ms): goes by the clock", result.stdout)

    def test_one_repetition_is_judged_with_more_care(self):
        def cut(result):
            for scene in result["scenes"]:
                scene["metronome"] = scene["metronome"][:1]
                for solver in scene["solvers"]:
                    solver["repetitions"] = solver["repetitions"][:1]
        old = self.changed(cut)
        same = self.compare(old, old=old)
        self.assertEqual(same.returncode, FINE, same.stdout)
        self.assertIn("has 1 repetition: 'cairn run --repeat 20' sees smaller changes", same.stdout)
        slower = copy.deepcopy(old)
        scale(slower, "time_ms", 1.1, 1, 0)
        found = self.compare(slower, old=old)
        self.assertEqual(found.returncode, REGRESSION, found.stdout)
        self.assertIn("REGRESSION: wall, bullet-si", found.stdout)
        self.assertNotIn("tower, bullet-si (10 iterations): 10", found.stdout)
        slightly = copy.deepcopy(old)
        scale(slightly, "time_ms", 1.055, 1, 0)
        self.assertEqual(self.compare(slightly, old=old).returncode, FINE)

    def test_the_same_is_written_as_json(self):
        new = self.changed(lambda r: scale(r, "time_ms", 1.1, 1, 0))
        self.compare(new, "--json", self.path("c.json"))
        with open(self.path("c.json"), encoding="utf-8") as file:
            comparison = json.load(file)
        self.assertEqual(comparison["schema_version"], 1)
        self.assertEqual(len(comparison["regressions"]), 1)
        slow = [entry for entry in comparison["lanes"] if entry["time_ms"]["verdict"] == "REGRESSION"]
        self.assertEqual([(entry["scene"], entry["solver"]) for entry in slow], [("wall", "bullet-si")])
        self.assertAlmostEqual(slow[0]["time_ms"]["ratio"], 1.1, places=6)
        self.assertEqual(slow[0]["residual_m_s"]["ratio"], 1)


class FileTest(CompareTest):
    def test_what_cannot_be_read_is_refused_with_its_name(self):
        text = json.dumps(self.old)
        self.assertIn("not JSON, or was cut", self.refusal(text[:len(text) // 2]))
        self.assertIn("not JSON", self.refusal("frames: 300"))
        self.assertIn("no result of cairn run SCENE", self.refusal({"schema_version": 1}))
        self.assertIn("no result of cairn run SCENE", self.refusal("[1, 2]"))
        result = cairn("compare", self.path("missing.json"), self.write("new.json", self.old))
        self.assertEqual(result.returncode, USAGE)
        self.assertRegex(result.stderr, "cannot read .*missing.json")
        os.mkdir(self.path("folder.json"))
        result = cairn("compare", self.path("new.json"), self.path("folder.json"))
        self.assertEqual(result.returncode, USAGE)
        self.assertRegex(result.stderr, "cannot read .*folder.json': Is a directory")

    def test_other_versions_are_refused(self):
        message = self.refusal(self.changed(lambda r: r.update(schema_version=99)))
        self.assertIn("schema_version 99, and this cairn reads 1", message)
        self.assertIn("schema_version", self.refusal(self.changed(lambda r: r.pop("schema_version"))))

    def test_members_that_are_missing_or_do_not_fit_are_refused(self):
        for change in (lambda r: solver_of(r).pop("repetitions"),
                       lambda r: solver_of(r).update(repetitions=[]),
                       lambda r: solver_of(r)["repetitions"][1]["time_ms"].pop(),
                       lambda r: solver_of(r)["repetitions"][1]["time_ms"].__setitem__(20, "fast"),
                       lambda r: solver_of(r)["repetitions"][1]["time_ms"].__setitem__(20, -1),
                       lambda r: r["scenes"][0]["metronome"].pop(),
                       lambda r: r["context"].pop("host")):
            self.assertIn("no whole result", self.refusal(self.changed(change)))

    def test_a_result_without_scenes_is_no_whole_one(self):
        message = self.refusal(self.changed(lambda new: new["scenes"].clear()))
        self.assertIn("it has no scene", message)
        self.assertIn("it has no scene", self.refusal(
            self.old, old=self.changed(lambda new: new["scenes"].clear())))

    def test_a_scene_or_solver_that_is_missing_is_refused(self):
        self.assertIn("lacks the scene wall", self.refusal(self.changed(lambda r: r["scenes"].pop())))
        self.assertIn("lacks cairn on tower", self.refusal(
            self.changed(lambda r: r["scenes"][0]["solvers"].pop())))

    def test_a_scene_or_solver_that_is_new_is_noted(self):
        for change, words in ((lambda r: r["scenes"].pop(), "has scenes that"),
                              (lambda r: r["scenes"][0]["solvers"].pop(), "has solvers that")):
            result = self.compare(self.old, old=self.changed(change))
            self.assertEqual(result.returncode, FINE)
            self.assertIn(words, result.stdout)

    def test_different_machines_builds_and_experiments_are_refused(self):
        for change, words in ((lambda r: r["context"]["host"].update(cpu="another"), "CPU"),
                              (lambda r: r["context"]["build"].update(build_type="Debug"), "build type"),
                              (lambda r: r.update(frames=41), "frames"),
                              (lambda r: r.update(budget_ms=2), "budget"),
                              (lambda r: r["context"]["run"].update(warmup_frames=0), "warm-up"),
                              (lambda r: r["scenes"][0].update(size=5), "size 5"),
                              (lambda r: r["scenes"][0].update(seed=5), "seed 5"),
                              (lambda r: solver_of(r).update(effort="12 iterations"), "told differently")):
            self.assertIn(words, self.refusal(self.changed(change)))

    def test_differences_that_may_be_meant_are_noted(self):
        result = self.compare(self.changed(lambda r: r["context"]["host"].update(simd_target="scalar")))
        self.assertEqual(result.returncode, FINE)
        self.assertRegex(result.stdout, "Note: SIMD target: .*scalar")

    def test_usage_is_explained(self):
        self.refused(USAGE, "compare", self.path("one.json"))
        old = self.write("old.json", self.old)
        for text in ("x", "-5%", "0"):
            self.assertIn("--threshold", self.refused(USAGE, "compare", old, old, "--threshold=" + text))
        self.assertIn("Exit codes", self.fine("compare", "--help"))


if __name__ == "__main__":
    cli_test.TOOL = os.path.abspath(sys.argv.pop(1))
    unittest.main()
