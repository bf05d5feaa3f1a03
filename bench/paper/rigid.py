# SPDX-License-Identifier: MIT
"""The three tables and two figures of the talk, on the castle."""
import os
import shutil

import talk
from run import reached, read_vector, solver_of
from text import count, percent, small, table, time

SOLVERS = "psor,pgs-sm,pgs-sm-literal,ipm"
SWEEPS = 50000
# The literal algorithm cycles from number 4 on: enough sweeps to see that, not to wait for it.
LITERAL_SWEEPS = 500


def castle(tool, number, *words):
    return tool.solve(f"castle-{number}-{words[1]}", "castle", "--size", number, *words)["problems"][0]


def solve_all(tool):
    problems = []
    for number in range(1, 11):
        problem = castle(tool, number, "--solver", "psor,pgs-sm,ipm", "--omega", "1", "--max-sweeps", SWEEPS)
        literal = castle(tool, number, "--solver", "pgs-sm-literal", "--max-sweeps", LITERAL_SWEEPS)
        problem["solvers"] += literal["solvers"]
        problems.append(problem)
    return problems


def sizes(problems):
    rows = []
    for number, problem in enumerate(problems, 1):
        free = problem["free_rows"]
        rows.append([number, f"{free}/{problem['n'] - free}", count(talk.NONZEROS.get(number)),
                     count(problem["nonzeros"]), talk.CONDITION.get(number, "-"),
                     problem["source"].rsplit("condition ", 1)[1].split()[0]])
    return table(["no.", "n_a/n_b", "nz, talk", "nz, ours", "condition, talk", "ours"], rows)


def sweeps(problems):
    rows = []
    for number, problem in enumerate(problems, 1):
        solver = solver_of(problem, "psor")
        ours = [reached(solver, error) for error in (1e-1, 1e-2)]
        known = talk.PSOR.get(number, ("-", "-"))
        rows.append([number, *known, *(count(level["sweeps"]) if level else f"> {SWEEPS:,}" for level in ours)])
    return table(["no.", "talk: to 1e-1", "to 1e-2", "ours: to 1e-1", "to 1e-2"], rows)


def active_rows(path, free):
    """Rows at their bound, of those with one."""
    return {i for i, x in enumerate(read_vector(path)[free:]) if x == 0}


def active_sets(tool, problems):
    rows = []
    folder = os.path.join(tool.out, "solutions")
    shutil.rmtree(folder, ignore_errors=True)
    for number in range(6, 11):
        problem = problems[number - 1]
        free, name = problem["free_rows"], problem["problem"]
        castle(tool, number, "--solver", "pgs-sm", "--errors", "none", "--solution", folder)
        final = active_rows(os.path.join(folder, name, "pgs-sm", "x.mtx"), free)
        cells = []
        for done in (2, 20, 1000, 10000):
            castle(tool, number, "--solver", "pgs", "--errors", "none", "--max-sweeps", done, "--solution", folder)
            found = active_rows(os.path.join(folder, name, "pgs", "x.mtx"), free)
            share = percent(len(found & final) / max(1, len(final)))
            known = talk.ACTIVE.get(done, {}).get(number)
            cells.append(f"{known} / {share}" if known else f"- / {share}")
        rows.append([number, f"{len(final)} of {problem['n'] - free}", *cells])
    return table(["no.", "active", "2 sweeps", "20", "1000", "10,000"], rows)


def methods(problems):
    rows = []
    for number, problem in enumerate(problems, 1):
        ipm, sm, literal = (solver_of(problem, name) for name in ("ipm", "pgs-sm", "pgs-sm-literal"))
        known = "{} s / {} s".format(*talk.CPU[number]) if number in talk.CPU else "-"
        ended = f"{literal['factorisations']}" if literal["solved"] else "does not end"
        rows.append([number, known, f"{time(ipm['time_ms'])} / {time(sm['time_ms'])}",
                     f"{count(ipm['factor_nonzeros'])} / {count(sm['factor_nonzeros'])}",
                     f"{ipm['factorisations']} / {sm['factorisations']}", ended,
                     f"{small(ipm['residual']['relative'])} / {small(sm['residual']['relative'])}"])
    return table(["no.", "CPU, talk", "CPU, ours", "nz(L)", "factorisations", "literal", "residual"], rows)


def figures(tool, docs):
    folder = os.path.join(docs, "paper")
    os.makedirs(folder, exist_ok=True)
    text = ""
    for number in (5, 10):
        castle(tool, number, "--solver", "pgs,ipm,pgs-sm", "--max-sweeps", 5000,
               "--plot", os.path.join(folder, f"castle-{number}.svg"))
        text += f"![Error against CPU time, castle no. {number}](paper/castle-{number}.svg)\n\n"
    return text
