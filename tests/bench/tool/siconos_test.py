# SPDX-License-Identifier: MIT
"""Siconos as a peer in cairn solve: python3 siconos_test.py PATH_OF_CAIRN"""
import json
import os
import sys
import unittest

import cli_test
from cli_test import USAGE, cairn
from solve_cli_test import CHECK_FAILED, INFINITE, write_problem

PACKAGE = "libsiconos-numerics-dev"
TOLERANCE = 1e-9  # the default of --tolerance
UNIQUE = {"reference": {"unique_solution": True}}


def names_and_descriptions():
    result = cairn("list", "solvers", "--json")
    return {solver["name"]: solver["description"] for solver in json.loads(result.stdout)
            if solver["name"].startswith("siconos-")}


def is_present():
    return not any(PACKAGE in text for text in names_and_descriptions().values())


def chain(n, scales=(1.0,)):
    """S tridiag(-1, 2.5, -1) S with a diagonal S: symmetric positive definite."""
    s = [scales[i % len(scales)] for i in range(n)]
    return [[s[i] * s[j] * (2.5 if i == j else -1.0 if abs(i - j) == 1 else 0.0)
             for j in range(n)] for i in range(n)]


def q_for(matrix, x, w):
    """The q with which x and w belong together: w = M x + q."""
    return [w_i - sum(a * b for a, b in zip(row, x)) for row, w_i in zip(matrix, w)]


class SiconosTestCase(cli_test.CairnTest):
    def setUp(self):
        super().setUp()
        if not is_present():
            self.skipTest(f"this cairn was built without Siconos: install {PACKAGE}")
        self.all = ",".join(names_and_descriptions())

    def outcomes(self, *arguments):
        """The exit code, and what each solver did."""
        file = self.path("r.json")
        result = cairn("solve", *arguments, "--tolerance", str(TOLERANCE), "--json", file)
        self.assertEqual(result.stderr, "")
        with open(file, encoding="utf-8") as text:
            return result.returncode, json.load(text)["problems"][0]["solvers"]

    def check_all_solve(self, *arguments):
        code, solvers = self.outcomes(*arguments, "--solver", self.all)
        self.assertEqual(len(solvers), self.all.count(",") + 1)
        for solver in solvers:
            with self.subTest(solver["solver"]):
                self.assertTrue(solver["solved"], solver["failure"])
                self.assertLessEqual(solver["residual"]["relative"], TOLERANCE)
                # Scaled to a diagonal of 1, M has eigenvalues from 0.2 to 1.8, so that the error is
                # below (1 + 1.8) / 0.2 residuals, and in the norms x' M x below 3 times as much;
                # |q| is below 2.3 |x| in all problems here: 2.3 * 42e-10.
                self.assertLessEqual(solver["error_energy"], 1e-8)
        self.assertEqual(code, 0)


class ListTest(cli_test.CairnTest):
    def test_the_solvers_are_listed_whether_they_can_be_used_or_not(self):
        names = names_and_descriptions()
        self.assertLessEqual({"siconos-pgs", "siconos-psor", "siconos-rpgs", "siconos-lemke",
                              "siconos-latin", "siconos-newton-min", "siconos-cpg"}, set(names))
        about_package = [PACKAGE in text for text in names.values()]
        self.assertIn(sum(about_package), (0, len(names)))

    def test_without_siconos_one_sentence_says_what_to_install(self):
        if is_present():
            self.skipTest("this cairn was built with Siconos")
        message = self.refused(USAGE, "solve", "obstacle", "--size", "10",
                               "--solver", "siconos-pgs")
        self.assertIn("siconos-pgs", message)
        self.assertIn(PACKAGE, message)


class SolveTest(SiconosTestCase):
    def test_every_solver_finds_the_known_solution(self):
        matrix = chain(9)
        x, w = [1, 2, 0, 0, 3, 0, 1, 0, 2], [0, 0, 1, 4, 0, 2, 0, 1, 0]
        self.check_all_solve(write_problem(self.folder, "chain", matrix, q_for(matrix, x, w),
                                           solution=[float(v) for v in x], **UNIQUE))

    def test_rows_of_very_different_scale_end_at_the_residual_asked_for(self):
        matrix = chain(9, scales=(1.0, 1e3, 1e-2))
        x, w = [1, 2, 0, 0, 3, 0, 1, 0, 2], [0, 0, 1, 4, 0, 2, 0, 1, 0]
        self.check_all_solve(write_problem(self.folder, "scaled", matrix, q_for(matrix, x, w),
                                           solution=[float(v) for v in x], **UNIQUE))

    def test_free_rows_are_eliminated_and_found_again(self):
        matrix = chain(7)
        x, w = [-1, 2, -3, 0, 2, 0, 1], [0, 0, 0, 1, 0, 2, 0]
        self.check_all_solve(write_problem(self.folder, "mixed", matrix, q_for(matrix, x, w),
                                           kind="mlcp", n_a=3, n_b=4,
                                           solution=[float(v) for v in x], **UNIQUE))

    def test_lower_bounds_other_than_zero_are_moved_there(self):
        matrix, lower = chain(5), [1.0, -2.0, 0.5, -INFINITE, 0.0]
        x, w = [1.0, -2.0, 2.0, -4.0, 3.0], [1, 2, 0, 0, 0]
        self.check_all_solve(write_problem(self.folder, "moved", matrix, q_for(matrix, x, w),
                                           kind="boxqp", lower=lower, upper=[INFINITE] * 5,
                                           solution=x, **UNIQUE))

    def test_the_smallest_problems_are_no_special_case(self):
        problems = {
            "one-row": ([[2.0]], [-3.0], [1.5], "lcp", {}),
            "nothing-to-do": ([[2.0, 0.0], [0.0, 1.0]], [3.0, 1.0], [0.0, 0.0], "lcp", {}),
            "all-free": ([[2.0, 1.0], [1.0, 2.0]], [-3.0, 0.0], [2.0, -1.0], "mlcp",
                         {"n_a": 2, "n_b": 0})}
        for name, (matrix, q, x, kind, others) in problems.items():
            with self.subTest(name):
                self.check_all_solve(write_problem(self.folder, name, matrix, q, kind=kind,
                                                   solution=x, **UNIQUE, **others))


class LimitTest(SiconosTestCase):
    def test_an_upper_bound_is_refused_by_its_row(self):
        folder = write_problem(self.folder, "box", chain(3), [-9.0, 1.0, 1.0], kind="boxqp",
                               lower=[0.0] * 3, upper=[INFINITE, 1.0, INFINITE])
        code, (solver,) = self.outcomes(folder, "--solver", "siconos-pgs")
        self.assertEqual(code, CHECK_FAILED)
        self.assertRegex(solver["failure"], "no solver for upper bounds.* row 1$")

    def test_a_matrix_that_needs_too_much_memory_is_refused_before_it_is_made(self):
        # 80^2 rows: 9 dense matrices of 328 MB for Newton's method, 1 for PSOR.
        code, (solver,) = self.outcomes("obstacle", "--size", "80", "--errors", "none",
                                        "--solver", "siconos-newton-min")
        self.assertEqual(code, CHECK_FAILED)
        self.assertRegex(solver["failure"], r"too large: .* 2\.7 GiB .* 6400 rows, 2\.0 allowed")

    def test_a_limit_of_sweeps_is_kept_and_reported(self):
        folder = write_problem(self.folder, "chain", chain(9), [-1.0] * 9)
        for name in ("siconos-pgs", "siconos-psor", "siconos-rpgs", "siconos-latin"):
            code, (solver,) = self.outcomes(folder, "--solver", name, "--max-sweeps", "3")
            self.assertEqual((code, solver["end"]), (CHECK_FAILED, "sweep limit"), name)
            self.assertRegex(solver["failure"], "^sweep limit at residual")
            self.assertGreater(solver["residual"]["relative"], TOLERANCE)

    def test_siconos_does_not_write_on_the_terminal(self):
        # PSOR warns of its factor, and Newton's method of its failure, whatever the verbosity.
        folder = write_problem(self.folder, "chain", chain(9), [-1.0] * 9)
        result = cairn("solve", folder, "--solver", "siconos-psor,siconos-newton-min",
                       "--max-sweeps", "1", "--quiet")
        self.assertEqual(result.stderr, "")
        for word in ("Warning", "omega", "Numerics"):
            self.assertNotIn(word, result.stdout)


if __name__ == "__main__":
    cli_test.TOOL = os.path.abspath(sys.argv.pop(1))
    unittest.main()
