# SPDX-License-Identifier: MIT
"""Runs `cairn solve` for docs/paper.md, and keeps what it measured."""
import json
import os
import subprocess
import sys


class Tool:
    def __init__(self, program, out, keep):
        self.program, self.out, self.keep = program, out, keep
        os.makedirs(out, exist_ok=True)

    def solve(self, name, *words):
        """The JSON of one run of `cairn solve`; a solver that fails is a result, not an error."""
        path = os.path.join(self.out, name + ".json")
        writes_more = "--solution" in words or "--plot" in words
        if self.keep and os.path.exists(path) and not writes_more:
            with open(path, encoding="ascii") as file:
                return json.load(file)
        command = [self.program, "solve", *map(str, words), "--quiet", "--progress", "never", "--json", path]
        print("==", " ".join(command[1:-5]), flush=True)
        done = subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        if done.returncode not in (0, 1):
            sys.exit(f"{' '.join(command)}\n{done.stderr}")
        with open(path, encoding="ascii") as file:
            return json.load(file)


def solver_of(problem, name):
    return next(solver for solver in problem["solvers"] if solver["solver"] == name)


def reached(solver, error):
    """Where a solver first had that error: sweeps, factorisations, time_ms; None if never."""
    level = next(level for level in solver["reached"] if level["error"] == error)
    return None if level["time_ms"] is None else level


def read_vector(path):
    """A Matrix Market array."""
    with open(path, encoding="ascii") as file:
        lines = [line for line in file if not line.startswith("%")]
    return [float(line) for line in lines[1:]]
