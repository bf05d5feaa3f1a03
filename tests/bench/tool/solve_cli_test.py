# SPDX-License-Identifier: MIT
"""cairn solve as its users meet it: python3 solve_cli_test.py PATH_OF_CAIRN"""
import csv
import json
import math
import os
import sys
import unittest
import xml.etree.ElementTree

import cli_test
from cli_test import BAD_INPUT, FINE, USAGE, cairn

CHECK_FAILED = 1
HEADER = "%%MatrixMarket matrix "
INFINITE = 1e300
TOLERANCE = 1e-9  # the default of --tolerance
ALL_SOLVERS = ["pgs", "psor", "pgs-sm", "pgs-sm-literal", "ipm"]
# x = (2, 1), w = 0: two unit masses on one another.
STACK = [[1, -1], [-1, 2]]


def write_vector(path, values):
    with open(path, "w", encoding="ascii") as file:
        file.write(f"{HEADER}array real general\n{len(values)} 1\n")
        file.writelines(f"{value!r}\n" for value in values)


def read_vector(path):
    with open(path, encoding="ascii") as file:
        header, size, *values = file.read().splitlines()
    assert header == HEADER + "array real general", header
    assert size == f"{len(values)} 1", size
    return [float(value) for value in values]


def write_problem(folder, name, matrix, q, kind="lcp", **others):
    """A folder of a problem; others: solution, w, lower, upper, and keys of meta.json."""
    path = os.path.join(folder, name)
    os.makedirs(path)
    entries = [(i + 1, j + 1, a) for i, row in enumerate(matrix)
               for j, a in enumerate(row[:i + 1]) if a != 0]
    with open(os.path.join(path, "matrix.mtx"), "w", encoding="ascii") as file:
        file.write(f"{HEADER}coordinate real symmetric\n{len(q)} {len(q)} {len(entries)}\n")
        file.writelines(f"{i} {j} {a!r}\n" for i, j, a in entries)
    write_vector(os.path.join(path, "q.mtx"), q)
    for key in ("solution", "w", "lower", "upper"):
        if key in others:
            write_vector(os.path.join(path, key + ".mtx"), others.pop(key))
    with open(os.path.join(path, "meta.json"), "w", encoding="utf-8") as file:
        json.dump({"name": name, "kind": kind, "n": len(q), **others}, file)
    return path


def string_problem(n, load=0.05):
    """A string over flat ground, pulled up on one side and down on the other."""
    matrix = [[2.0 if i == j else -1.0 if abs(i - j) == 1 else 0.0 for j in range(n)]
              for i in range(n)]
    return matrix, [load * math.sin(6 * (i + 1) / (n + 1)) for i in range(n)]


def relative_residual(matrix, q, x, lower=None, upper=None):
    """LcpResidual::relative, from its definition."""
    n = len(q)
    lower, upper = lower or [0.0] * n, upper or [math.inf] * n
    left = right = 0.0
    for i in range(n):
        d = matrix[i][i]
        w = sum(a * b for a, b in zip(matrix[i], x)) + q[i]
        e = d * abs(x[i] - min(max(x[i] - w / d, lower[i]), upper[i]))
        left, right = left + e * e / d, right + q[i] * q[i] / d
    return math.sqrt(left / right)


class SolveTestCase(cli_test.CairnTest):
    def stack(self, name="stack", **others):
        return write_problem(self.folder, name, STACK, [-1.0, 0.0], solution=[2.0, 1.0],
                             reference={"unique_solution": True}, **others)

    def string(self, name="string", n=40, **others):
        return write_problem(self.folder, name, *string_problem(n), **others)

    def solve_json(self, *arguments, code=FINE):
        result = cairn("solve", *arguments, "--json", self.path("r.json"))
        if code is not None:
            self.assertEqual(result.returncode, code, result.stdout + result.stderr)
        with open(self.path("r.json"), encoding="utf-8") as file:
            return json.load(file)

    def read_csv(self, name):
        with open(self.path(name), encoding="utf-8", newline="") as file:
            return list(csv.DictReader(file))


class ListTest(SolveTestCase):
    def test_list_problems_gives_sizes_and_parameters_as_text_and_json(self):
        lines = self.fine("list", "problems").splitlines()
        generators = json.loads(self.fine("list", "problems", "--json"))
        names = [line.split()[0] for line in lines if not line.startswith(" ")]
        self.assertEqual(names, [generator["name"] for generator in generators])
        parameters = [line.split()[0] for line in lines if line.startswith(" ")]
        self.assertEqual(parameters, [parameter["name"] for generator in generators
                                      for parameter in generator["parameters"]])
        self.assertIn("american-put", names)
        for generator in generators:
            self.assertLessEqual(generator["min_size"], generator["default_size"])
            self.assertLessEqual(generator["default_size"], generator["max_size"])
            for parameter in generator["parameters"]:
                self.assertLessEqual(parameter["min"], parameter["default"])
                self.assertLessEqual(parameter["default"], parameter["max"])

    def test_list_solvers_says_which_command_each_is_for(self):
        solvers = json.loads(self.fine("list", "solvers", "--json"))
        names = [solver["name"] for solver in solvers if solver["command"] == "solve"]
        self.assertEqual(names[:5], ALL_SOLVERS)
        self.assertIn("cairn", [s["name"] for s in solvers if s["command"] == "run"])
        worlds = {s["name"]: s["aliases"] for s in solvers if s["command"] == "worlds"}
        self.assertEqual(worlds["cairn-sweeps"], ["cairn-pgs", "pgs-nncg"])
        self.assertIn("cairn-always", worlds)
        known = {s["name"] for s in solvers}
        for solver in solvers:
            self.assertLessEqual(set(solver["aliases"]), known)
        self.assertRegex(self.fine("list", "solvers"), r"(?m)^cairn-pgs .*; also cairn-sweeps, pgs-nncg$")

    def test_help_explains_time_errors_and_exit_codes(self):
        text = self.fine("solve", "--help")
        for words in ("--solver", "--errors", "--history", "--start", "CPU time", "Exit codes",
                      "watched", "best one found"):
            self.assertIn(words, text)
        self.assertIn("solve", self.fine("--help"))


class RefusalTest(SolveTestCase):
    def test_an_unknown_problem_is_answered_with_the_nearest(self):
        message = self.refused(USAGE, "solve", "americain-put")
        self.assertIn("unknown problem 'americain-put': did you mean 'american-put'?", message)
        self.assertIn("cairn list problems", message)

    def test_a_path_that_is_not_there_is_bad_input(self):
        message = self.refused(BAD_INPUT, "solve", self.path("none/there"))
        self.assertIn("none/there': there is no such file or folder", message)

    def test_a_folder_without_problems_is_bad_input(self):
        os.mkdir(self.path("empty"))
        self.assertIn("holds neither meta.json nor folders that do",
                      self.refused(BAD_INPUT, "solve", self.path("empty")))

    def test_an_unknown_parameter_is_answered_with_the_nearest_and_the_list(self):
        message = self.refused(USAGE, "solve", "journal-bearing", "--set", "excentricity=0.5")
        self.assertEqual(message, "cairn: unknown parameter 'excentricity': did you mean "
                                  "'eccentricity'? There are eccentricity\n")

    def test_parameters_and_sizes_out_of_range_are_explained(self):
        for words, expected in ((["--set", "eccentricity=2"], "write a number from"),
                                (["--set", "eccentricity=x"], "write a number from"),
                                (["--set", "eccentricity"], "write name=value"),
                                (["--size", "0"], "grid points per side"),
                                (["--size", "ten"], "write a whole number from")):
            self.assertIn(expected, self.refused(USAGE, "solve", "journal-bearing", *words))

    def test_size_and_parameters_are_refused_for_folders(self):
        folder = self.stack()
        self.assertIn("--size is for generators", self.refused(USAGE, "solve", folder, "--size", "3"))
        self.assertIn("--set is for generators",
                      self.refused(USAGE, "solve", folder, "--set", "a=1"))

    def test_numbers_out_of_range_are_explained(self):
        folder = self.stack()
        for option, text, allowed in (("--tolerance", "0", "from 1e-16 to 1"),
                                      ("--tolerance", "nan", "from 1e-16 to 1"),
                                      ("--omega", "2", "from 0.01 to 1.99"),
                                      ("--tol", "-1", "from 0"), ("--k-gs", "0", "from 1"),
                                      ("--k-sm", "-1", "from 0"), ("--repeat", "0", "from 1"),
                                      ("--threads", "0", "from 1 to 1024"),
                                      ("--max-sweeps", "1.5", "whole number"),
                                      ("--errors", "x", "or none"), ("--errors", ",", "no error"),
                                      ("--budget", "5", "no unit"),
                                      ("--order", "random", "automatic, forward, reverse"),
                                      ("--start", "hot", "zero, warm, nested"),
                                      ("--solver", "pgs,pgs", "twice"),
                                      ("--solver", "pgss", "did you mean 'pgs'"),
                                      ("--progress", "maybe", "auto, always or never")):
            self.assertIn(allowed, self.refused(USAGE, "solve", folder, f"{option}={text}"), option)

    def test_an_unknown_option_is_answered_with_the_nearest(self):
        self.assertIn("did you mean '--tolerance'",
                      self.refused(USAGE, "solve", self.stack(), "--tolerence", "1"))

    def test_nested_needs_a_coarser_grid(self):
        self.assertIn("--start nested: stack has no coarser grid",
                      self.refused(USAGE, "solve", self.stack(), "--start", "nested"))

    def test_history_and_plot_need_errors(self):
        folder = self.stack()
        for option in ("--history", "--plot"):
            self.assertIn(option + " needs errors",
                          self.refused(USAGE, "solve", folder, "--errors", "none", option,
                                       self.path("f")))

    def test_a_picture_has_the_name_of_what_it_is(self):
        message = self.refused(USAGE, "solve", self.stack(), "--plot", self.path("p.png"))
        self.assertIn("p.png': the picture is SVG; write a name that ends in .svg", message)
        self.assertFalse(os.path.exists(self.path("p.png")))

    def test_a_budget_of_work_is_answered_with_what_repeats_here(self):
        message = self.refused(USAGE, "solve", self.stack(), "--budget", "100000units")
        self.assertIn("takes a time, such as 2ms", message)
        self.assertIn("--max-sweeps", message)

    def test_a_file_that_is_no_problem_is_named_as_it_was_typed(self):
        path = self.path("a.json")
        with open(path, "w", encoding="utf-8") as file:
            file.write("{}")
        message = self.refused(BAD_INPUT, "solve", path)
        self.assertTrue(message.startswith(f"cairn: '{path}' is no problem: "), message)
        for kind in ("recordings (*.cairn)", "folders with meta.json", "cairn list problems"):
            self.assertIn(kind, message)
        # nor is a stranger among the files of a problem
        stranger = os.path.join(self.stack(), "notes.txt")
        with open(stranger, "w", encoding="utf-8") as file:
            file.write("x")
        self.assertIn("notes.txt' is no problem", self.refused(BAD_INPUT, "solve", stranger))
        self.assertIn("b.json': there is no such file", self.refused(BAD_INPUT, "solve", "b.json"))

    def test_a_broken_folder_is_named_with_file_and_line(self):
        folder = self.stack()
        write_vector(os.path.join(folder, "q.mtx"), [1.0])
        self.assertEqual(self.refused(BAD_INPUT, "solve", folder),
                         f"cairn: {folder}/q.mtx: 1 numbers; expected 2, as matrix.mtx has rows\n")
        with open(os.path.join(folder, "q.mtx"), "a", encoding="ascii") as file:
            file.write("2\n")
        self.assertEqual(self.refused(BAD_INPUT, "solve", folder),
                         f"cairn: {folder}/q.mtx:4: '2' is too much; the size line says 1 entries\n")

    def test_a_matrix_without_a_positive_diagonal_is_refused_with_its_row(self):
        folder = write_problem(self.folder, "bad", [[1, 0.5], [0.5, -1]], [1.0, 1.0])
        message = self.refused(BAD_INPUT, "solve", folder)
        self.assertIn("bad, row 2: ", message)
        self.assertIn("diagonal", message)

    def test_a_friction_problem_is_refused(self):
        folder = write_problem(self.folder, "f", STACK, [1.0, 1.0], kind="friction")
        self.assertIn("kind 'friction' cannot be solved here",
                      self.refused(BAD_INPUT, "solve", folder))

    def test_a_broken_problem_that_was_named_is_found_before_any_is_solved(self):
        folders = [self.stack("a"), self.stack("b")]
        os.remove(os.path.join(folders[1], "q.mtx"))
        self.assertIn("b/q.mtx: cannot be read", self.refused(BAD_INPUT, "solve", *folders))

    def test_broken_problems_of_a_folder_are_left_out_and_the_others_solved(self):
        self.stack("a")
        folder = self.stack("b")
        os.remove(os.path.join(folder, "q.mtx"))
        write_problem(self.folder, "c", [[1, 0.5], [0.5, -1]], [1.0, 1.0])
        result = cairn("solve", self.folder, "--solver", "pgs", "--json", self.path("r.json"))
        self.assertEqual(result.returncode, BAD_INPUT)
        self.assertIn("pgs: 1 of 1 solved", result.stdout)
        self.assertIn("2 left out, not usable", result.stdout)
        left_out = result.stderr.splitlines()
        self.assertEqual(len(left_out), 2, result.stderr)
        self.assertIn("b/q.mtx: cannot be read", left_out[0])
        self.assertIn("c, row 2: ", left_out[1])
        with open(self.path("r.json"), encoding="utf-8") as file:
            told = json.load(file)
        self.assertEqual([problem["problem"] for problem in told["problems"]], ["a"])
        self.assertEqual([file["path"] for file in told["unread"]], [folder, self.path("c")])

    def test_a_folder_of_which_nothing_can_be_read_says_why(self):
        os.remove(os.path.join(self.stack("a"), "q.mtx"))
        self.assertIn("a/q.mtx: cannot be read", self.refused(BAD_INPUT, "solve", self.folder))

    def test_files_that_cannot_be_written_are_refused_before_solving(self):
        folder = self.stack()
        for option in ("--json", "--csv", "--markdown", "--history", "--plot"):
            path = self.path("missing/file.svg")
            self.assertIn(path, self.refused(BAD_INPUT, "solve", folder, option, path))
        self.assertIn("cannot make folder",
                      self.refused(BAD_INPUT, "solve", folder, "--solution",
                                   os.path.join(folder, "q.mtx", "x")))


class SolveTest(SolveTestCase):
    def test_every_solver_finds_the_known_solution(self):
        result = self.solve_json(self.stack(), "--solver", ",".join(ALL_SOLVERS))
        problem = result["problems"][0]
        self.assertEqual((problem["problem"], problem["n"], problem["nonzeros"],
                          problem["error_against"]), ("stack", 2, 4, "solution"))
        self.assertEqual([solver["solver"] for solver in problem["solvers"]], ALL_SOLVERS)
        for solver in problem["solvers"]:
            self.assertTrue(solver["solved"], solver)
            self.assertIsNone(solver["failure"])
            self.assertLessEqual(solver["residual"]["relative"], TOLERANCE)
            # |error| <= |M^-1| |residual|; the norm of M^-1 is 2.62, of q 1, of x 2.24.
            self.assertLessEqual(solver["error"], 3 * TOLERANCE)
            self.assertLessEqual(solver["error_energy"], 3 * TOLERANCE)
            self.assertGreater(solver["time_ms"], 0)
            self.assertEqual([level["error"] for level in solver["reached"]], [0.1, 0.01, 1e-6])

    def test_json_holds_settings_and_machine(self):
        result = self.solve_json(
            self.stack(), "--solver", "psor", "--omega", "1.2", "--tol", "1e-9", "--k-gs", "7",
            "--k-sm", "1", "--tolerance", "1e-8", "--max-sweeps", "400", "--order", "symmetric",
            "--threads", "1", "--budget", "30s", "--repeat", "3", "--start", "zero",
            "--errors", "1e-3,1e-1,1e-3")
        self.assertEqual(result["schema_version"], 1)
        self.assertEqual(result["settings"], {
            "solvers": ["psor"], "start": "zero", "tolerance": 1e-8, "max_sweeps": 400,
            "budget_ms": 30000, "order": "symmetric", "threads": 1, "k_gs": 7, "k_sm": 1,
            "active_tolerance": 1e-9, "omega": 1.2, "repeat": 3, "clock": "thread cpu",
            "errors": [0.1, 0.001]})
        for key in ("date", "command", "host", "build", "noise"):
            self.assertIn(key, result["context"])
        self.assertNotIn(self.folder, json.dumps(result), "no paths of this machine")
        times = result["problems"][0]["solvers"][0]["times_ms"]
        self.assertEqual(len(times), 3)
        self.assertEqual(result["problems"][0]["solvers"][0]["time_ms"], sorted(times)[1])

    def test_threads_are_timed_by_the_wall(self):
        result = self.solve_json(self.string(), "--solver", "pgs", "--threads", "2")
        self.assertEqual(result["settings"]["clock"], "wall")

    def test_solutions_are_written_and_hold_what_the_table_says(self):
        matrix, q = string_problem(40)
        problem = self.solve_json(self.string(), "--solver", "pgs,pgs-sm,ipm", "--solution",
                                  self.path("out"))["problems"][0]
        for solver in problem["solvers"]:
            place = self.path(f"out/string/{solver['solver']}")
            x, w = read_vector(place + "/x.mtx"), read_vector(place + "/w.mtx")
            residual = relative_residual(matrix, q, x)
            self.assertLessEqual(residual, 1.0001 * TOLERANCE)
            # Digits are written such that they read back as the same bits; only sums differ.
            self.assertAlmostEqual(residual, solver["residual"]["relative"], delta=1e-14)
            for i, row in enumerate(matrix):
                self.assertAlmostEqual(w[i], sum(a * b for a, b in zip(row, x)) + q[i], delta=1e-13)

    def test_bounds_on_both_sides_and_free_rows_are_kept(self):
        matrix, q = string_problem(20, load=1.0)
        lower, upper = [-1.0] * 19 + [-INFINITE], [1.0] * 10 + [INFINITE] * 10
        box = write_problem(self.folder, "box", matrix, q, kind="boxqp", lower=lower, upper=upper)
        free = write_problem(self.folder, "free", matrix, q, kind="mlcp", n_a=5, n_b=15)
        result = self.solve_json(box, free, "--solver", "pgs", "--solution", self.path("out"))
        self.assertEqual([p["free_rows"] for p in result["problems"]], [1, 5])
        for name, lo, hi in (("box", lower, upper),
                             ("free", [-INFINITE] * 5 + [0.0] * 15, [INFINITE] * 20)):
            x = read_vector(self.path(f"out/{name}/pgs/x.mtx"))
            self.assertLessEqual(relative_residual(matrix, q, x, lo, hi), 1.0001 * TOLERANCE)
            self.assertTrue(all(lo[i] <= x[i] <= hi[i] for i in range(20)))

    def test_export_writes_over_a_problem_only_when_told_to(self):
        command = ("slider", "--solver", "pgs-sm", "--errors", "none", "--export", self.path("p"))
        self.fine("solve", *command, "--size", "20")
        place, = os.listdir(self.path("p"))
        matrix = self.path(f"p/{place}/matrix.mtx")
        with open(matrix, "w", encoding="ascii") as file:
            file.write("mine")
        # a bound of another problem is not left to this one
        write_vector(self.path(f"p/{place}/w.mtx"), [0.0])
        for more in ([], ["torsion"]):
            message = self.refused(BAD_INPUT, "solve", *more, *command, "--size", "20")
            self.assertIn(f"p/{place}' holds a problem already: --force writes over it", message)
        self.assertEqual(os.listdir(self.path("p")), [place])
        with open(matrix, encoding="ascii") as file:
            self.assertEqual(file.read(), "mine")
        self.fine("solve", *command, "--size", "20", "--force")
        self.assertNotIn("w.mtx", os.listdir(os.path.dirname(matrix)))
        self.assertEqual(os.listdir(self.path("p")), [place])
        self.fine("solve", os.path.dirname(matrix), "--solver", "pgs-sm")

    def test_problems_of_one_name_are_not_exported_into_one_folder(self):
        first = self.stack("a")
        os.mkdir(self.path("other"))
        second = write_problem(self.path("other"), "a", STACK, [-2.0, 0.0])
        message = self.refused(USAGE, "solve", first, second, "--export", self.path("p"))
        self.assertIn("two problems have the name 'a'", message)

    def test_names_that_other_commands_have_for_a_solver_are_taken(self):
        problem = self.solve_json(self.stack(), "--solver", "cairn")["problems"][0]
        self.assertEqual([solver["solver"] for solver in problem["solvers"]], ["pgs-sm"])
        self.assertIn("names pgs-sm twice",
                      self.refused(USAGE, "solve", self.stack("b"), "--solver", "cairn,pgs-sm"))
        message = self.refused(USAGE, "solve", self.stack("c"), "--solver", "cairn-work")
        self.assertIn("'cairn-work' is a solver of cairn worlds", message)
        self.assertIn("pgs-sm comes nearest", message)

    def test_w_is_compared_where_x_is_not_unique(self):
        folder = write_problem(self.folder, "flat", [[1.0, 1.0], [1.0, 1.0]], [-1.0, -1.0],
                               solution=[1.0, 0.0], w=[0.0, 0.0],
                               reference={"unique_solution": False})
        result = self.solve_json(folder, "--solver", "pgs")
        self.assertEqual(result["problems"][0]["error_against"], "w")
        self.assertLessEqual(result["problems"][0]["solvers"][0]["error"], TOLERANCE)
        self.assertIsNone(result["problems"][0]["solvers"][0]["error_energy"])
        self.assertRegex(self.fine("solve", folder, "--solver", "pgs", "--quiet"),
                         "errors: against the known w = M x")

    def test_the_best_found_is_compared_where_nothing_is_known(self):
        folder = self.string()
        problem = self.solve_json(folder, "--solver", "pgs")["problems"][0]
        self.assertEqual(problem["error_against"], "best found")
        self.assertLessEqual(problem["reference_residual"], TOLERANCE)
        # The smallest eigenvalue is 2 - 2 cos(pi / 41) = 5.9e-3: the residual may grow by
        # its inverse, 170.
        self.assertLessEqual(problem["solvers"][0]["error"], 170 * 4 * TOLERANCE)
        self.assertIn("best x found here", self.fine("solve", folder, "--solver", "pgs"))

    def test_errors_none_measures_none(self):
        problem = self.solve_json(self.string(), "--errors", "none")["problems"][0]
        self.assertEqual(problem["error_against"], "none")
        for solver in problem["solvers"]:
            self.assertIsNone(solver["error"])
            self.assertEqual(solver["reached"], [])

    def test_a_tolerance_that_is_not_reached_is_exit_code_1_and_said(self):
        folder = self.string()
        result = cairn("solve", folder, "--solver", "pgs", "--max-sweeps", "3")
        self.assertEqual(result.returncode, CHECK_FAILED)
        self.assertIn("pgs: 0 of 1 solved; sweep limit at residual", result.stdout)
        self.assertIn("NOT: sweep limit", result.stdout)
        solver = self.solve_json(folder, "--solver", "pgs", "--max-sweeps", "3",
                                 code=CHECK_FAILED)["problems"][0]["solvers"][0]
        self.assertEqual((solver["solved"], solver["sweeps"]), (False, 3))
        self.assertTrue(solver["failure"].startswith("sweep limit at residual "))

    def test_a_budget_ends_the_solver(self):
        # Sweeps alone need far more than a thousand times this on 400 unknowns.
        folder = self.string(n=400)
        result = self.solve_json(folder, "--solver", "pgs", "--budget", "50us",
                                 "--max-sweeps", "1000000000", code=CHECK_FAILED)
        self.assertEqual(result["problems"][0]["solvers"][0]["end"], "budget spent")

    def test_work_counts_are_those_of_the_method(self):
        solvers = self.solve_json(self.string(), "--solver", "pgs,pgs-sm,ipm")["problems"][0]["solvers"]
        pgs, steps, points = solvers
        self.assertGreater(pgs["sweeps"], 0)
        self.assertEqual(pgs["factorisations"], 0)
        self.assertGreater(steps["factorisations"], 0)
        self.assertLess(steps["sweeps"], pgs["sweeps"])
        self.assertGreater(points["factorisations"], 0)
        self.assertGreater(points["factor_nonzeros"], 0)


class ManyTest(SolveTestCase):
    def test_a_folder_of_folders_means_all_of_them_and_skips_friction(self):
        self.stack("a")
        self.string("b")
        write_problem(self.folder, "c", STACK, [1.0, 1.0], kind="friction")
        os.mkdir(self.path("d"))
        result = self.solve_json(self.folder, "--solver", "pgs,pgs-sm")
        self.assertEqual([problem["problem"] for problem in result["problems"]], ["a", "b"])
        self.assertEqual([folder["name"] for folder in result["skipped"]], ["c"])
        out = self.fine("solve", self.folder, "--solver", "pgs,pgs-sm")
        for row in ("a        pgs ", "a        pgs-sm ", "b        pgs ", "b        pgs-sm "):
            self.assertIn("\n" + row, out)
        self.assertIn("pgs: 2 of 2 solved\npgs-sm: 2 of 2 solved\n1 skipped, kind friction", out)

    def test_csv_has_a_line_for_each_problem_and_solver(self):
        self.stack("a")
        self.string("b")
        self.fine("solve", self.folder, "--solver", "pgs,ipm", "--csv", self.path("t.csv"))
        rows = self.read_csv("t.csv")
        self.assertEqual([(row["problem"], row["solver"]) for row in rows],
                         [("a", "pgs"), ("a", "ipm"), ("b", "pgs"), ("b", "ipm")])
        for row in rows:
            self.assertEqual(row["solved"], "1")
            self.assertLessEqual(float(row["residual"]), TOLERANCE)
            self.assertGreater(float(row["time_ms"]), 0)
            self.assertEqual(row["failure"], "")
            self.assertIn("to_1e-06_ms", row)

    def test_failures_are_counted_with_their_reason(self):
        self.stack("a")
        self.string("b")
        out = cairn("solve", self.folder, "--solver", "pgs", "--max-sweeps", "200").stdout
        self.assertIn("pgs: 1 of 2 solved; 1 sweep limit (b)", out)

    def test_the_same_folder_counts_once_and_equal_names_are_told_apart(self):
        first = self.stack("a")
        os.mkdir(self.path("other"))
        second = write_problem(self.path("other"), "a", STACK, [-2.0, 0.0])
        result = self.solve_json(first, first, second, "--solver", "pgs")
        self.assertEqual([problem["problem"] for problem in result["problems"]], ["a", "a-2"])

    def test_a_file_of_a_problem_means_its_folder(self):
        path = os.path.join(self.stack(), "matrix.mtx")
        self.assertEqual(self.solve_json(path, "--solver", "pgs")["problems"][0]["problem"], "stack")


class HistoryTest(SolveTestCase):
    def test_history_is_error_over_rising_time_from_start_to_end(self):
        self.fine("solve", self.string(), "--solver", "pgs,pgs-sm", "--history", self.path("h.csv"))
        rows = self.read_csv("h.csv")
        for name in ("pgs", "pgs-sm"):
            points = [row for row in rows if row["solver"] == name]
            times = [float(row["time_ms"]) for row in points]
            self.assertEqual(times, sorted(times))
            self.assertEqual(times[0], 0)
            sweeps = [int(row["sweeps"]) for row in points]
            self.assertEqual(sweeps, sorted(sweeps))
            self.assertEqual(sweeps[0], 0)
            self.assertAlmostEqual(float(points[0]["error"]), 1, delta=1e-12)  # from zeros
            self.assertLess(float(points[-1]["error"]), 170 * 4 * TOLERANCE)
            self.assertLessEqual(float(points[-1]["residual"]), TOLERANCE)
        # Every sweep of the first hundred, then thinned.
        sweeps = [int(row["sweeps"]) for row in rows if row["solver"] == "pgs"]
        self.assertEqual(sweeps[:100], list(range(100)))
        self.assertGreater(sweeps[-1], 1000)
        self.assertLess(len(sweeps), 1000)

    def test_times_to_an_error_are_those_of_the_history(self):
        problem = self.solve_json(self.string(), "--solver", "pgs", "--errors", "1e-2,1e-4",
                                  "--history", self.path("h.csv"))["problems"][0]
        rows = self.read_csv("h.csv")
        for level in problem["solvers"][0]["reached"]:
            first = next(row for row in rows if float(row["error"]) <= level["error"])
            self.assertEqual(int(first["sweeps"]), level["sweeps"])
            self.assertAlmostEqual(float(first["time_ms"]) / level["time_ms"], 1, delta=1e-5)

    def test_the_plot_is_a_picture_that_stands_alone(self):
        self.stack("a")
        self.string("b")
        self.fine("solve", self.folder, "--solver", "pgs,pgs-sm", "--plot", self.path("p.svg"))
        with open(self.path("p.svg"), encoding="utf-8") as file:
            text = file.read()
        picture = xml.etree.ElementTree.fromstring(text)
        self.assertEqual(picture.tag, "{http://www.w3.org/2000/svg}svg")
        for words in ("pgs-sm", "time [ms]", ">a, error of x<", ">b, error of best<", ">error<"):
            self.assertIn(words, text)
        for words in ("nan", "inf", "href", "<script"):
            self.assertNotIn(words, text)

    def test_markdown_has_the_tables_and_the_command(self):
        self.fine("solve", self.stack(), "--solver", "pgs", "--markdown", self.path("t.md"))
        with open(self.path("t.md"), encoding="utf-8") as file:
            text = file.read()
        self.assertIn("| solver | time [ms] |", text)
        self.assertIn("Command: `cairn solve stack --solver pgs --markdown t.md`", text)


class GeneratorTest(SolveTestCase):
    def test_size_and_parameters_reach_the_generator(self):
        problem = self.solve_json("--size", "20", "--set", "eccentricity=0.5", "journal-bearing",
                                  "--solver", "pgs-sm")["problems"][0]
        self.assertEqual((problem["n"], problem["size"], problem["parameters"]["eccentricity"]),
                         (400, 20, 0.5))

    def test_an_exported_problem_is_solved_as_the_generated_one(self):
        arguments = ("--solver", "pgs-sm", "--solution", self.path("x"))
        self.fine("solve", "torsion", "--size", "12", *arguments, "--export", self.path("p"))
        name, = os.listdir(self.path("p"))
        result = self.solve_json(self.path("p"), "--solver", "pgs-sm", "--solution", self.path("y"))
        self.assertEqual(result["problems"][0]["problem"], name)
        for file in ("x.mtx", "w.mtx"):
            self.assertEqual(read_vector(self.path(f"x/{name}/pgs-sm/{file}")),
                             read_vector(self.path(f"y/{name}/pgs-sm/{file}")))

    def test_answers_of_a_problem_are_shown_and_checked(self):
        arguments = ("journal-bearing", "--size", "21", "--solver", "pgs-sm")
        answers = self.solve_json(*arguments)["problems"][0]["solvers"][0]["answers"]
        self.assertTrue(answers)
        for answer in answers:
            self.assertTrue(answer["ok"], answer)
            self.assertLessEqual(abs(answer["difference"]), answer["tolerance"])
            self.assertAlmostEqual(answer["difference"], answer["value"] - answer["expected"],
                                   delta=1e-15)
        self.assertRegex(self.fine("solve", *arguments), r"answer +value +expected")

    def test_nested_grids_come_first_and_their_time_counts(self):
        arguments = ("journal-bearing", "--size", "63", "--solver", "pgs-sm,ipm")
        nested = self.solve_json(*arguments, "--start", "nested")["problems"][0]
        for solver in nested["solvers"]:
            sizes = [grid["size"] for grid in solver["nested"]]
            self.assertEqual(sizes, sorted(sizes))
            self.assertGreaterEqual(len(sizes), 2)
            self.assertLess(sizes[-1], 63 * 63)
            self.assertAlmostEqual(sum(grid["time_ms"] for grid in solver["nested"]),
                                   solver["nested_ms"], delta=1e-6)
            self.assertGreater(solver["time_ms"], solver["nested_ms"])
        self.assertIn("of it coarse", self.fine("solve", *arguments, "--start", "nested"))

    def test_a_march_is_solved_to_its_end_and_its_answer_checked(self):
        arguments = ("american-put", "--size", "400", "--set", "steps=200", "--solver", "pgs-sm")
        result = self.solve_json(*arguments, code=None)
        problem = result["problems"][0]
        self.assertGreater(problem["steps"], 100)
        solver = problem["solvers"][0]
        self.assertEqual(solver["steps_solved"], problem["steps"])
        self.assertTrue(solver["answers"])
        self.assertEqual([answer["name"] for answer in solver["answers"]], ["price"])
        self.assertEqual(solver["solved"], all(answer["ok"] for answer in solver["answers"]))

    def test_history_of_a_march_has_a_point_for_each_problem(self):
        cairn("solve", "american-put", "--size", "100", "--set", "steps=50", "--solver", "pgs-sm",
              "--history", self.path("h.csv"))
        rows = self.read_csv("h.csv")
        times = [float(row["time_ms"]) for row in rows]
        self.assertEqual(times, sorted(times))
        self.assertGreater(len(rows), 50 - 1)
        self.assertTrue(all(row["error"] == "" for row in rows))


class StreamTest(SolveTestCase):
    def test_progress_goes_to_stderr_and_is_wiped(self):
        folder = self.string(n=600)
        arguments = ("solve", folder, "--solver", "pgs", "--max-sweeps", "300000")
        result = cairn(*arguments, "--progress", "always")
        self.assertIn("string (1 of 1): pgs", result.stderr)
        self.assertTrue(result.stderr.endswith("\x1b[K"))
        self.assertNotIn("1 of 1):", result.stdout)
        self.assertEqual(cairn(*arguments, "--progress", "always", "--quiet").stderr, "")

    def test_quiet_leaves_the_tables(self):
        folder = self.stack()
        loud, quiet = self.fine("solve", folder), self.fine("solve", folder, "--quiet")
        self.assertIn("pgs: 1 of 1 solved", quiet)
        self.assertNotIn("Machine:", quiet)
        self.assertIn("Machine:", loud)

    def test_lines_fit_120_columns(self):
        self.stack("a-name-that-is-rather-long")
        self.string("b")
        for line in self.fine("solve", self.folder, "--solver", ",".join(ALL_SOLVERS)).splitlines():
            self.assertLessEqual(len(line), 120, line)


class CollectedTest(SolveTestCase):
    def test_small_collected_problems_are_solved(self):
        tests = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
        repository = os.path.dirname(tests)
        folder = os.environ.get("CAIRN_PROBLEMS") or os.path.join(
            os.path.dirname(repository), "shared", "problems")
        if not os.path.isdir(os.path.join(folder, "open")):
            self.skipTest(f"{folder}/open is not there; set CAIRN_PROBLEMS")
        names = ("siconos-lcp_mmc", "siconos-PDSym_mlcp", "num4lcp-blocked-6x40", "sif-BQPGASIM")
        result = self.solve_json(*(os.path.join(folder, "open", name) for name in names),
                                 "--solver", "pgs-sm,ipm")
        for problem in result["problems"]:
            self.assertEqual(problem["error_against"], "solution")
            for solver in problem["solvers"]:
                # Condition numbers are below 2e3.
                self.assertLessEqual(solver["error"], 1e4 * TOLERANCE, (problem["problem"], solver["solver"]))


if __name__ == "__main__":
    cli_test.TOOL = os.path.abspath(sys.argv.pop(1))
    unittest.main()
