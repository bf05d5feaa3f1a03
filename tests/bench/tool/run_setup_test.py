# SPDX-License-Identifier: MIT
"""How `cairn run` is told to use the machine, and that its JSON says so: python3 run_setup_test.py PATH_OF_CAIRN"""
import json
import os
import subprocess
import sys
import time
import unittest

import cli_test
from cli_test import FINE, SMALL, USAGE, CairnTest

SCHEMA = os.path.join(os.path.dirname(__file__), "..", "..", "..", "docs", "run.schema.json")


class SetupTest(CairnTest):
    def test_the_context_and_the_tables_say_how_the_run_was_made(self):
        out = self.fine(*SMALL, "--solver", "cairn", "--threads", "1", "--simd", "scalar", "--pin", "0",
                        "--warmup", "3", "--repeat", "2", "--json", self.path("r.json"))
        with open(self.path("r.json"), encoding="utf-8") as file:
            context = json.load(file)["context"]
        self.assertEqual(context["run"], {"threads": 1, "simd_asked_for": "scalar", "pinned_to_core": 0,
                                          "warmup_frames": 3, "repetitions": 2, "noise_shown": False})
        self.assertEqual(context["host"]["simd_target"], "scalar")
        for words in ("first 3 of which do not count", "2 times", "1 thread", "core 0", "scalar"):
            self.assertIn(words, out)

    def test_threads_and_simd_targets_change_no_result(self):
        def results(*more):
            solver = self.run_json(*SMALL, "--solver", "cairn", *more)["scenes"][0]["solvers"][0]
            return solver["facts"], solver["frames"]["residual_m_s"]

        first = results()
        self.assertEqual(first, results("--threads", "2"))
        self.assertEqual(first, results("--simd", "scalar"))

    def test_threads_that_may_be_used_are(self):
        def most_threads(count):
            tool = subprocess.Popen([cli_test.TOOL, "run", "pyramid", "--size", "60", "--frames", "5", "--samples",
                                     "0", "--solver", "cairn", "--threads", count], stdout=subprocess.DEVNULL)
            most = 0
            while tool.poll() is None:
                try:
                    most = max(most, len(os.listdir(f"/proc/{tool.pid}/task")))
                except FileNotFoundError:
                    pass
                time.sleep(0.002)
            self.assertEqual(tool.returncode, FINE)
            return most

        self.assertEqual(most_threads("2"), most_threads("1") + 1)

    def test_what_the_machine_does_not_have_is_refused_with_what_it_has(self):
        self.assertIn("scalar", self.refused(USAGE, *SMALL, "--simd", "mmx"))
        self.assertRegex(self.refused(USAGE, *SMALL, "--pin", "4000"), r"no such core.*cores 0")
        self.assertIn("would share", self.refused(USAGE, *SMALL, "--pin", "0", "--threads", "2"))
        for option in ("--threads=0", "--repeat=0", "--warmup=12", "--pin=x"):
            self.assertIn(option.split("=")[0], self.refused(USAGE, *SMALL, option))

    def test_each_repetition_is_kept_and_makes_the_same_frames(self):
        scene = self.run_json(*SMALL, "--repeat", "3", "--warmup", "2")["scenes"][0]
        self.assertEqual(len(scene["metronome"]), 3)
        for beats in scene["metronome"]:
            self.assertTrue(all(beat > 0 for part in beats.values() for beat in part))
        sampled = {frame for s in scene["samples"] for frame in (s["frame"], s["frame"] - 1)}
        uncounted = sampled | {0, 1}
        for solver in scene["solvers"]:
            repetitions = solver["repetitions"]
            self.assertEqual(len(repetitions), 3)
            for repetition in repetitions:
                self.assertEqual(repetition["residual_m_s"], repetitions[0]["residual_m_s"])
                nulls = {i for i, value in enumerate(repetition["time_ms"]) if value is None}
                self.assertEqual(nulls, uncounted)
            self.assertEqual(solver["summary"]["timed_frames"], 3 * (12 - len(uncounted)))

    def test_frames_that_warm_up_do_not_count(self):
        all_frames, rest = (self.run_json(*SMALL, "--solver", "cairn", "--samples", "0", *more)["scenes"][0]
                            ["solvers"][0] for more in ([], ["--warmup", "8"]))
        self.assertEqual(all_frames["frames"]["residual_m_s"], rest["frames"]["residual_m_s"])
        counted = rest["frames"]["residual_m_s"][8:]
        self.assertAlmostEqual(rest["summary"]["residual_mean_m_s"], sum(counted) / len(counted))
        self.assertEqual(rest["summary"]["timed_frames"], 4)

    def test_noise_is_shown_for_the_metronome_and_each_solver(self):
        out = self.fine(*SMALL, "--solver", "bullet-si,cairn", "--repeat", "3", "--noise")
        noise = out[out.index("Noise:"):]
        for words in ("metronome, arithmetic", "metronome, memory"):
            self.assertRegex(noise, rf"tower +{words} +\d")
        for solver in ("bullet-si", "cairn"):
            self.assertRegex(noise, rf"tower +{solver} +([\d.]+ +){{3}}\d+\.\d\n")
        self.assertNotIn("Noise:", self.fine(*SMALL, "--solver", "cairn"))


class SchemaTest(CairnTest):
    def setUp(self):
        super().setUp()
        try:
            import jsonschema
        except ImportError:
            self.skipTest("no python3-jsonschema")
        with open(SCHEMA, encoding="utf-8") as file:
            schema = json.load(file)
        jsonschema.Draft7Validator.check_schema(schema)
        self.validator = jsonschema.Draft7Validator(schema)

    def complaints(self, result):
        return [f"{list(e.absolute_path)}: {e.message}" for e in self.validator.iter_errors(result)]

    def test_results_obey_the_published_schema(self):
        for words in ([*SMALL, "--noise"], [*SMALL, "--budget", "1ms", "--pin", "0", "--repeat", "2"],
                      ["run", "wall", "--frames", "3", "--samples", "0"],
                      ["run", "ragdolls", "--frames", "60", "--samples", "0", "--solver", "bullet-nncg"]):
            self.assertEqual(self.complaints(self.run_json(*words)), [], words)

    def test_the_schema_notices_what_is_wrong(self):
        def broken(change):
            result = self.run_json(*SMALL, "--solver", "cairn")
            change(result)
            return self.complaints(result)

        solver = lambda result: result["scenes"][0]["solvers"][0]
        for change in (lambda r: r.update(schema_version="1"),
                       lambda r: r.update(schema_version=2),
                       lambda r: r.pop("context"),
                       lambda r: r.update(unheard_of=1),
                       lambda r: r["context"].pop("num_cpus"),
                       lambda r: r["context"]["run"].update(threads=0),
                       lambda r: solver(r).pop("repetitions"),
                       lambda r: solver(r)["repetitions"][0]["time_ms"].append("quick"),
                       lambda r: solver(r)["repetitions"].clear(),
                       lambda r: solver(r)["summary"].update(p50_ms=-1)):
            self.assertNotEqual(broken(change), [])


if __name__ == "__main__":
    cli_test.TOOL = os.path.abspath(sys.argv.pop(1))
    unittest.main()
