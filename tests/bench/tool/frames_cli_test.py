# SPDX-License-Identifier: MIT
"""cairn_frames as its users meet it: python3 frames_cli_test.py PATH_OF_CAIRN_FRAMES"""
import os
import subprocess
import sys
import unittest

TOOL = ""
PARTS = ["build: bodies", "build: joints", "build: contacts", "plan", "pack", "sweeps", "measuring",
         "guards", "steps", "tension", "results", "write", "other"]


def frames(*arguments):
    return subprocess.run([TOOL, *arguments], capture_output=True, text=True, timeout=300)


class UsageTest(unittest.TestCase):
    def test_alone_it_shows_what_there_is(self):
        alone, asked = frames(), frames("--help")
        self.assertEqual((alone.returncode, alone.stderr), (0, ""))
        self.assertIn("deadlines", alone.stdout)
        self.assertEqual(alone.stdout, asked.stdout)
        self.assertEqual(frames("help", "parts").stdout, frames("parts", "--help").stdout)

    def test_what_cannot_be_is_exit_code_2_and_a_sentence(self):
        for words, why in (
                (["--bogus"], "unknown option '--bogus': 'cairn_frames' shows what there is"),
                (["pasts"], "unknown command 'pasts': did you mean 'parts'? 'cairn_frames --help' shows all"),
                (["parts", "--quiet"], "unknown option '--quiet': 'cairn_frames parts --help' shows all"),
                (["parts", "--frames"], "--frames needs a value, such as '--frames 10' (How many); "
                                        "'cairn_frames help parts' says more"),
                (["parts", "--frames", "0"], "--frames '0': write a number from 1 to 100000 (How many); "
                                             "'cairn_frames help parts' says more"),
                (["deadlines", "--seconds", "0"], "--seconds '0': write a number greater than 0 (Of a random "
                                                  "world); 'cairn_frames help deadlines' says more"),
                (["deadlines", "--budget", "-1"], "--budget '-1': write a number of 0 or more ([ms]; may be "
                                                  "repeated); 'cairn_frames help deadlines' says more"),
                (["deadlines", "--clock", "sun"], "--clock 'sun': write cpu or wall; 'cairn_frames help "
                                                  "deadlines' says more"),
                (["parts", "--scene", "tower:1000000"], None)):
            result = frames(*words)
            self.assertEqual((result.returncode, result.stdout), (2, ""), words)
            if why:
                self.assertEqual(result.stderr, f"cairn_frames: {why}\n")


class PartsTest(unittest.TestCase):
    def table(self, *arguments):
        """Cells by the name of their line, and the names of the columns."""
        result = frames("parts", "--frame", "4", "--frames", "3", *arguments)
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        self.assertEqual(result.stderr, "")
        lines = [[cell.strip() for cell in line.strip("|").split("|")]
                 for line in result.stdout.splitlines() if line.startswith("|")]
        return {line[0]: line[1:] for line in lines[2:]}, lines[0]

    def test_says_where_a_substep_goes_hot_and_cold(self):
        cells, columns = self.table("--scene", "ragdolls", "--size", "2")
        self.assertEqual(columns, ["part", "ragdolls 2 hot us", "share", "ragdolls 2 cold us", "share"])
        self.assertEqual(list(cells), PARTS + ["together", "without clocks"])
        for share in (1, 3):
            # Each is rounded by half a percent.
            self.assertAlmostEqual(sum(int(cells[part][share].rstrip(" %")) for part in PARTS), 100, delta=6)
        for part in ("build: bodies", "pack", "sweeps", "write", "together", "without clocks"):
            self.assertGreater(float(cells[part][0]), 0, part)

    def test_what_a_world_does_not_have_takes_nothing(self):
        cells, _ = self.table("--scene", "tower:3", "--no-steps")
        self.assertEqual(cells["steps"][:2], ["0.0", "0 %"])
        self.assertGreater(float(cells["build: contacts"][0]), 0)

    def test_scenes_stand_side_by_side(self):
        _, columns = self.table("--scene", "incline", "--scene", "tower:3")
        self.assertEqual(columns[1::2], ["incline hot us", "incline cold us", "tower 3 hot us", "tower 3 cold us"])

    def test_what_cannot_be_is_refused(self):
        for words in (["--scene", "sandcastle"], ["--scene", "tower:1000000"], ["--scene", "tower", "--size", "1000"],
                      ["--size", "0"], ["--frames", "0"], ["--no-such-option"]):
            result = frames("parts", *words)
            self.assertNotEqual(result.returncode, 0, words)
            self.assertNotEqual(result.stderr, "", words)


class WorkTest(unittest.TestCase):
    def test_what_is_timed_is_plain_sweeps_or_what_users_get(self):
        for command in ("threads", "scaling", "step"):
            for words, work in (([], "ten plain sweeps"), (["--default"], "ten iterations with default settings")):
                result = frames(command, "--scene", "tower:3", "--frame", "2", "--frames", "2", *words)
                self.assertEqual((result.returncode, result.stderr), (0, ""), command)
                self.assertIn(work, result.stdout.splitlines()[0])
                self.assertIn("| tower 3 ", result.stdout, command)


class FootprintTest(unittest.TestCase):
    def table(self, *arguments):
        """Rows by solver, and all lines of the output."""
        result = frames("footprint", "--frame", "3", "--scene", "incline", *arguments)
        if "does not let a process step another" in result.stderr or "only on Linux" in result.stderr:
            self.skipTest(result.stderr.strip())
        self.assertEqual((result.returncode, result.stderr), (0, ""), result.stdout)
        lines = result.stdout.splitlines()
        rows = [[cell.strip() for cell in line.strip("|").split("|")] for line in lines if line.startswith("|")]
        self.assertEqual(rows[0], ["world", "solver", "instructions", "distinct", "lines", "KiB", "pages", "KiB held"])
        self.assertEqual([row[0] for row in rows[2:]], ["incline"] * 3)
        return {row[1]: [float(cell) for cell in row[2:] if cell != "-"] for row in rows[2:]}, lines

    def test_counts_what_each_solver_runs_through(self):
        rows, _ = self.table()
        self.assertEqual(list(rows), ["bullet", "cairn-pgs", "cairn"])
        for solver, (ran, distinct, lines, kib, pages, *held) in rows.items():
            self.assertGreater(ran, distinct, solver)
            self.assertTrue(lines < distinct < lines * 64, solver)
            self.assertAlmostEqual(kib, lines / 16, delta=.5, msg=solver)
            self.assertTrue(lines / 64 <= pages < lines, solver)
            self.assertGreater(distinct, 1000, solver)
            self.assertTrue(all(1 <= kib < 64 for kib in held), (solver, held))  # of one box on a slope

    def test_the_functions_of_all_are_the_whole(self):
        rows, lines = self.table("--functions", "10000")
        begin = next(i for i, line in enumerate(lines) if line.startswith("incline, bullet: ")) + 3
        functions = [line.split(None, 2) for line in lines[begin:lines.index("", begin)]]
        self.assertEqual(sum(int(ran) for _, ran, _ in functions), rows["bullet"][0])
        self.assertIn("btSequentialImpulseConstraintSolver::convertContact", [name for _, _, name in functions])


class DeadlinesTest(unittest.TestCase):
    def rows(self, *arguments):
        result = frames("deadlines", "--warm-up", "2", "--frames", "5", "--seconds", "0.2", *arguments)
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        lines = [[cell.strip() for cell in line.strip("|").split("|")]
                 for line in result.stdout.splitlines() if line.startswith("|")]
        return [dict(zip(lines[0], line)) for line in lines[2:]], result.stdout

    def test_has_a_row_for_each_world_and_budget(self):
        rows, said = self.rows("--scene", "tower:3", "--worlds", "3", "--budget", "1", "--budget", "50")
        self.assertEqual([(row["world"], row["budget ms"]) for row in rows],
                         [(world, budget) for world in ("the clock alone", "tower 3", "random worlds")
                          for budget in ("1", "50")])
        self.assertIn("min_sweeps 4", said)
        self.assertIn("the clock of the budgets: wall", said)
        # a loop of 0.2 s that waits for 1 ms
        self.assertEqual(rows[0]["substeps"], "200")
        self.assertGreaterEqual(float(rows[0]["wall over us"].split(" / ")[0]), 0)
        self.assertEqual(rows[3]["substeps"], "5")
        # p50 of three boxes in 50 ms
        self.assertLess(float(rows[3]["CPU over us"].split(" / ")[0]), -10000)
        self.assertNotIn("The latest substeps", said)

    def test_shows_the_latest_substeps_one_by_one(self):
        rows, said = self.rows("--scene", "tower:3", "--worlds", "0", "--budget", "50", "--worst", "2")
        table = said.split("The latest substeps:")[1]
        lines = [[cell.strip() for cell in line.strip("|").split("|")]
                 for line in table.splitlines() if line.startswith("|")]
        late = [dict(zip(lines[0], line)) for line in lines[2:]]
        self.assertEqual([(row["world"], row["bodies"], row["islands"]) for row in late],
                         2 * [("tower 3", "3", "1")])
        self.assertGreaterEqual(float(late[0]["CPU over us"]), float(late[1]["CPU over us"]))

    def test_counts_substeps_that_cannot_fit(self):
        rows, said = self.rows("--scene", "tower:3", "--worlds", "0", "--budget", "0", "--clock", "cpu",
                               "--min-sweeps", "2")
        self.assertIn("CPU time of the thread", said)
        self.assertEqual(rows[1]["too late %"], "100.0")
        self.assertEqual(rows[1]["sweeps p50"], "2")
        self.assertEqual(rows[1]["CPU over us"], "-")
        self.assertGreater(float(rows[1]["by us"]), 0)

    def test_what_cannot_be_is_refused(self):
        for words in (["--scene", "sandcastle"], ["--clock", "sun"], ["--seconds", "0"], ["--budget", "-1"],
                      ["--frames", "0"]):
            result = frames("deadlines", *words)
            self.assertNotEqual(result.returncode, 0, words)
            self.assertNotEqual(result.stderr, "", words)


class ThreadsTest(unittest.TestCase):
    def rows(self, *arguments):
        result = frames(*arguments)
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        self.assertEqual(result.stderr, "")
        lines = [[cell.strip() for cell in line.strip("|").split("|")]
                 for line in result.stdout.splitlines() if line.startswith("|")]
        return [dict(zip(lines[0], line)) for line in lines[2:]]

    def test_times_the_parts_of_a_substep_for_each_number_of_threads(self):
        rows = self.rows("threads", "--scene", "pyramid3d:8", "--frame", "4", "--frames", "3", "--threads", "1,2,1024")
        self.assertEqual([row["threads"] for row in rows], ["1", "1", "2", "1024"])
        for row in rows:
            self.assertEqual(row["rows"], rows[0]["rows"])
            for part in ("build", "solve", "write", "solver", "step"):
                self.assertGreater(float(row[part]), 0, part)
            self.assertGreater(float(row["step"]), float(row["solve"]))

    def test_predicts_less_time_for_more_threads(self):
        rows = self.rows("scaling", "--scene", "pyramid3d:14", "--frame", "4", "--frames", "25", "--threads", "1,2,16")
        self.assertEqual([row["threads"] for row in rows], ["1", "2", "16"])
        shared = [float(row["shared"]) for row in rows]
        # what all share divides by their number, so far as a busy machine lets the medians tell
        self.assertLess(shared[2], 0.5 * shared[0])
        self.assertEqual(rows[0]["imbalance"], "0.000")
        self.assertEqual(rows[0]["barriers"], "0.000")

    def test_names_where_one_thread_is_alone(self):
        words = ["scaling", "--scene", "pyramid3d:14", "--frame", "2", "--frames", "3", "--threads", "1,4"]
        text = frames(*words, "--gaps", "3").stdout
        table = text[text.index("alone after") :].split("\n\n")[0].splitlines()
        self.assertEqual(len(table), 2 + 3)
        us = [float(line.split("|")[4]) for line in table[2:]]
        self.assertEqual(us, sorted(us, reverse=True))
        self.assertGreater(us[0], 0)
        self.assertNotIn("alone after", frames(*words).stdout)

    def test_a_number_of_threads_that_cannot_be_is_refused(self):
        for words in (["--threads", "0"], ["--threads", "1,1025"], ["--threads", "many"]):
            for command in ("threads", "scaling", "mt"):
                result = frames(command, *words)
                self.assertNotEqual(result.returncode, 0, words)
                self.assertNotEqual(result.stderr, "", words)


if __name__ == "__main__":
    TOOL = os.path.abspath(sys.argv.pop(1))
    unittest.main()
