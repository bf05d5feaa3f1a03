# SPDX-License-Identifier: MIT
"""cairn solve on recorded frames: python3 solve_frames_test.py PATH_OF_CAIRN"""
import csv
import json
import os
import re
import sys
import unittest
import xml.etree.ElementTree

import cli_test
from cli_test import BAD_INPUT, USAGE, cairn

CHECK_FAILED = 1
FRAME_SOLVERS = ["pgs", "psor", "pgs-nncg", "pgs-sm", "ipm", "bullet-si", "bullet-nncg",
                 "bullet-pgs-mlcp", "bullet-dantzig"]


class FramesTest(cli_test.CairnTest):
    def record(self, scene, frame=20, *more):
        self.fine("record", scene, "--frames", str(frame), "-o", self.path("frames"), *more)
        return os.path.join(self.path("frames"), f"{scene}-{frame:06}.cairn")

    def solve_json(self, *arguments):
        return self.run_json("solve", *arguments)

    def solvers_of(self, result, problem=0):
        return {solver["solver"]: solver for solver in result["problems"][problem]["solvers"]}

    def test_a_recording_is_not_written_over_unless_asked_for(self):
        path = self.record("tower")
        command = ("record", "tower", "--frames", "19,20", "-o", self.path("frames"))
        message = self.refused(BAD_INPUT, *command)
        self.assertIn(path, message)
        self.assertIn("--force", message)
        # nothing was begun
        self.assertEqual(os.listdir(self.path("frames")), [os.path.basename(path)])
        self.assertIn(path, self.fine(*command, "--force"))

    def test_record_counts_the_rows_that_solve_counts(self):
        recorded = self.fine("record", "chain", "--frames", "20", "-o", self.path("frames"))
        solved = self.fine("solve", self.path("frames"), "--max-sweeps", "1", "--errors", "none")
        rows = re.search(r"\((\d+) of joints and others", solved).group(1)
        self.assertGreater(int(rows), 0)
        self.assertIn(f", {rows} rows of joints and others, ", recorded)

    def test_list_says_what_each_solver_takes(self):
        solvers = json.loads(self.fine("list", "solvers", "--json"))
        takes = [solver["name"] for solver in solvers if solver["takes"] == "frames"]
        self.assertEqual(takes, FRAME_SOLVERS)

    def test_with_time_enough_steps_are_taken_beyond_the_iterations_of_the_game(self):
        for scene in ("tower", "wall"):
            path = self.record(scene, 40)
            solver = self.solvers_of(self.solve_json(path, "--solver", "pgs-sm", "--budget", "400ms",
                                                     "--errors", "none"))["pgs-sm"]
            self.assertGreater(solver["steps_accepted"], 0, scene)
            self.assertGreater(solver["sweeps"], 30, scene)

    def test_curves_fall_from_the_same_start_for_every_solver(self):
        path = self.record("chain")
        # twenty times what it takes: machines are busy at times
        result = self.solve_json(path, "--errors", "1e-1,1e-2,1e-4", "--solver",
                                 ",".join(FRAME_SOLVERS), "--budget", "100ms")
        problem = result["problems"][0]
        self.assertEqual(problem["unit"], "m/s")
        self.assertEqual(problem["error_against"], "converged reference")
        self.assertLess(problem["reference_residual"], 1e-8)
        starts = set()
        for solver in problem["solvers"]:
            curve = solver["curve"]
            starts.add((curve[0]["time_ms"], curve[0]["error"], curve[0]["residual"]))
            times = [point["time_ms"] for point in curve]
            self.assertEqual(times[0], 0)
            self.assertGreater(times[1], 0)
            if solver["solver"] == "bullet-dantzig":  # has a compliance of its own
                continue
            self.assertLess(solver["error"], 1e-2 * curve[0]["error"], solver["solver"])
            for level in solver["reached"]:
                first = next((p for p in curve if p["error"] <= level["error"]), None)
                self.assertEqual(level["time_ms"], first and first["time_ms"])
            self.assertEqual([level["error"] for level in solver["residual_reached"]],
                             [0.1, 0.01, 1e-4])
        self.assertEqual(len(starts), 1)

    def test_a_reference_that_does_not_converge_is_called_none(self):
        path = self.record("tower", 40)
        text = self.fine("solve", path, "--solver", "pgs", "--max-sweeps", "20")
        result = self.solve_json(path, "--solver", "pgs", "--max-sweeps", "20")
        problem = result["problems"][0]
        converged = problem["reference_residual"] <= 1e-8
        self.assertEqual(converged, problem["error_against"] == "converged reference")
        close = problem["reference_residual"] <= 1e-5
        self.assertEqual(not close, "errors: no reference converged, so they are against" in text)
        self.assertEqual(close and not converged, "a reference that almost converged" in text)

    def test_counted_sweeps_give_the_same_numbers_on_every_instruction_set(self):
        path = self.record("ragdolls")
        first = None
        for target in ("scalar", "sse4", "avx2"):
            folder = self.path(target)
            result = cairn("solve", path, "--max-sweeps", "25", "--errors", "none", "--solution",
                           folder, environment={"CAIRN_SIMD": target})
            self.assertEqual(result.returncode, 0, result.stderr)
            texts = []
            for root, _, files in sorted(os.walk(folder)):
                for name in sorted(files):
                    with open(os.path.join(root, name), encoding="ascii") as file:
                        texts.append((os.path.relpath(os.path.join(root, name), folder),
                                      file.read()))
            self.assertEqual(len(texts), 2 * 4)  # x and w of the usual solvers
            first = first or texts
            self.assertEqual(texts, first, target)

    def test_more_sweeps_bring_the_residual_down(self):
        path = self.record("wall", 20)
        residuals = []
        for sweeps in ("2", "20", "200"):
            result = self.solve_json(path, "--max-sweeps", sweeps, "--errors", "none", "--solver",
                                     "pgs,bullet-si")
            residuals.append([s["residual"]["max"] for s in result["problems"][0]["solvers"]])
            self.assertEqual([s["sweeps"] for s in result["problems"][0]["solvers"]],
                             2 * [int(sweeps)])
        (few, bullet_few), (some, bullet_some), (many, bullet_many) = residuals
        self.assertLess(some, few)
        self.assertLess(many, some)
        # Bullet's iteration may come to a halt where friction follows what it bounds
        self.assertLess(bullet_some, bullet_few)
        self.assertLessEqual(bullet_many, bullet_some)

    def test_from_zero_it_is_another_start(self):
        path = self.record("tower", 40)
        starts = [self.solve_json(path, "--solver", "pgs", "--max-sweeps", "3", "--start", start)
                  ["problems"][0]["solvers"][0]["curve"][0]["residual"]
                  for start in ("warm", "zero")]
        self.assertNotEqual(starts[0], starts[1])

    def test_all_files_are_written_and_hold_both_kinds_of_problems(self):
        self.record("chain")
        files = [self.path(name) for name in ("r.csv", "r.md", "h.csv", "r.svg")]
        text = self.fine("solve", self.path("frames"), "journal-bearing", "--size", "20",
                         "--budget", "200ms", "--solver", "pgs,ipm,bullet-si", "--csv",
                         files[0], "--markdown", files[1],
                         "--history", files[2], "--plot", files[3])
        self.assertIn("2 problems, 3 solvers", text)
        with open(files[0], encoding="utf-8", newline="") as file:
            lines = list(csv.DictReader(file))
        self.assertEqual([(line["unit"], line["solver"]) for line in lines],
                         [("relative", "pgs"), ("relative", "ipm"), ("m/s", "pgs"), ("m/s", "ipm"),
                          ("m/s", "bullet-si")])
        with open(files[1], encoding="utf-8") as file:
            self.assertIn("| bullet-si", file.read())
        with open(files[2], encoding="utf-8", newline="") as file:
            solvers = {(line["problem"], line["solver"]) for line in csv.DictReader(file)}
        self.assertEqual(len(solvers), 5)
        with open(files[3], encoding="utf-8") as file:
            picture = file.read()
        xml.etree.ElementTree.fromstring(picture)
        self.assertIn("chain-000020, velocity error", picture)

    def test_a_solver_that_refuses_says_why_and_the_others_go_on(self):
        path = self.record("tower")
        result = cairn("solve", path, "--solver", "ipm,pgs", "--max-sweeps", "5", "--errors", "none")
        self.assertEqual(result.returncode, CHECK_FAILED, result.stderr)
        self.assertIn("refused: friction, whose bounds follow other impulses", result.stdout)
        self.assertIn("pgs: 0 of 1 converged, 1 sweep limit", result.stdout)

    def test_a_tolerance_that_is_missed_fails(self):
        path = self.record("tower")
        missed = cairn("solve", path, "--solver", "bullet-si", "--max-sweeps", "1", "--tolerance",
                       "1e-6", "--errors", "none")
        self.assertEqual(missed.returncode, CHECK_FAILED, missed.stderr)
        self.assertIn("effort spent at residual", missed.stdout)
        self.fine("solve", path, "--solver", "pgs", "--tolerance", "0.5", "--errors", "none")

    def test_a_frame_is_converged_or_it_is_said_what_ended_it(self):
        self.record("tower")
        path = self.record("wall")
        text = self.fine("solve", self.path("frames"), "--solver", "pgs,bullet-si", "--budget", "50us",
                         "--errors", "none")
        self.assertIn("\npgs: 0 of 2 converged, 2 budget spent\n"
                      "bullet-si: 0 of 2 converged, 2 effort spent\n", text)
        # a tolerance that was asked for and reached is what converged means
        self.assertIn("\npgs: 1 of 1 converged\n",
                      self.fine("solve", path, "--solver", "pgs", "--tolerance", "0.5", "--errors",
                                "none"))
        self.assertIn("\npgs: 1 of 1 solved; of frames 0 of 1 converged, 1 sweep limit\n",
                      self.fine("solve", path, "slider", "--size", "5", "--max-sweeps", "400",
                                "--errors", "none", "--solver", "pgs"))

    def test_names_of_solvers_in_run_and_worlds_are_taken(self):
        path = self.record("chain")
        for typed in ("cairn-pgs,cairn", "cairn-sweeps,pgs-sm"):
            result = self.solve_json(path, "--solver", typed, "--max-sweeps", "5", "--errors", "none")
            self.assertEqual(list(self.solvers_of(result)), ["pgs-nncg", "pgs-sm"])

    def test_solvers_that_do_not_fit_the_problems_are_refused(self):
        path = self.record("chain")
        self.assertIn("solves problems in matrix form only",
                      self.refused(USAGE, "solve", path, "--solver", "pgs-sm-literal"))
        self.assertIn("solves recorded frames only",
                      self.refused(USAGE, "solve", "obstacle", "--solver", "bullet-si"))
        self.assertIn("none of these solves problems in matrix form",
                      self.refused(USAGE, "solve", path, "obstacle", "--solver", "bullet-si"))
        self.assertIn("did you mean 'bullet-si'",
                      self.refused(USAGE, "solve", path, "--solver", "bulet-si"))
        self.assertIn("names pgs twice", self.refused(USAGE, "solve", path, "--solver", "pgs,pgs"))

    def test_options_of_matrices_alone_are_refused(self):
        path = self.record("chain")
        self.assertIn("no coarser grid", self.refused(USAGE, "solve", path, "--start", "nested"))
        self.assertIn("one sweep at least", self.refused(USAGE, "solve", path, "--max-sweeps", "0"))
        self.assertIn("recordings are files already",
                      self.refused(USAGE, "solve", path, "--export", self.path("x")))
        self.assertIn("have the size they have",
                      self.refused(USAGE, "solve", path, "--size", "4"))

    def test_broken_files_are_named_with_what_is_wrong(self):
        path = self.record("chain")
        with open(path, "rb") as file:
            data = file.read()
        for name, changed, words in (("cut.cairn", data[:-7], "7 too few"),
                                     ("text.cairn", b"hello", "no recording"),
                                     ("bits", data[:-1] + bytes([data[-1] ^ 1]), "altered")):
            with open(self.path(name), "wb") as file:
                file.write(changed)
            message = self.refused(BAD_INPUT, "solve", self.path(name))
            self.assertIn(words, message)
            self.assertIn(name, message)

    def test_a_cut_file_of_a_folder_is_left_out_and_the_others_solved(self):
        path = self.record("chain")
        with open(path, "rb") as file:
            data = file.read()
        with open(os.path.join(os.path.dirname(path), "cut.cairn"), "wb") as file:
            file.write(data[:-7])
        result = cairn("solve", os.path.dirname(path), "--solver", "pgs", "--max-sweeps", "3",
                       "--errors", "none")
        self.assertEqual(result.returncode, BAD_INPUT)
        self.assertIn("cut.cairn': ", result.stderr)
        self.assertIn("7 too few", result.stderr)
        self.assertIn("chain-000020: ", result.stdout)
        self.assertIn("sweep limit", result.stdout)


if __name__ == "__main__":
    cli_test.TOOL = os.path.abspath(sys.argv.pop(1))
    unittest.main()
