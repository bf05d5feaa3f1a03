# SPDX-License-Identifier: MIT
"""Problems of others with certified solutions, and the solvers of others."""
import os

from run import reached, solver_of
from text import count, small, table, time

SWEEPS = 50000
ILL = 1e6  # condition number from which a problem counts as ill conditioned
LARGE = 1000
# Solvers of Siconos and their limit of iterations; the dense ones only up to so many inequalities.
SPARSE_PEERS = {"siconos-pgs": 5000}
DENSE_PEERS = {"siconos-lemke": 20000, "siconos-newton-min-fb": 100}
MOST_DENSE = 1100


def solve_all(tool, folder):
    return tool.solve("open", folder, "--solver", "psor,pgs-sm,ipm,pgs-sm-literal", "--omega", "1",
                      "--max-sweeps", 2000, "--tolerance", "1e-9")["problems"]


def everything(problems):
    rows = []
    for problem in problems:
        cells = []
        for name in ("pgs-sm", "ipm"):
            solver = solver_of(problem, name)
            cells += [time(solver["time_ms"]), solver["factorisations"], small(solver["residual"]["relative"]),
                      small(solver["error"])]
        literal = solver_of(problem, "pgs-sm-literal")
        rows.append([problem["problem"], count(problem["n"]), "w" if problem["error_against"] == "w" else "x",
                     *cells, literal["factorisations"] if literal["solved"] else "does not end"])
    head = ["problem", "n", "error of"]
    head += [f"{name}: {what}" for name in ("pgs-sm", "ipm") for what in ("CPU", "fact.", "residual", "error")]
    return table(head + ["literal: fact."], rows)


def summary(problems):
    text = ""
    for name in ("pgs-sm", "ipm", "pgs-sm-literal"):
        solvers = [solver_of(problem, name) for problem in problems]
        solved = [solver for solver in solvers if solver["residual"]["relative"] <= 1e-8]
        work = sum(solver["factorisations"] for solver in solvers)
        text += f"- `{name}`: {len(solved)} of {len(solvers)} to a residual of 1e-8, {work:,} factorisations in all\n"
    return text


def ill_conditioned(tool, folder, names):
    """Time of PSOR to an error of 1e-2 over that of pgs-sm."""
    paths = [os.path.join(folder, name) for name in names]
    problems = tool.solve("ill", *paths, "--solver", "psor,pgs-sm,ipm", "--omega", "1",
                          "--max-sweeps", SWEEPS)["problems"]
    rows = []
    for problem in problems:
        psor, sm, ipm = (reached(solver_of(problem, name), 1e-2) for name in ("psor", "pgs-sm", "ipm"))
        slow = time(psor["time_ms"]) if psor else f"> {time(solver_of(problem, 'psor')['time_ms'])}"
        least = psor["time_ms"] if psor else solver_of(problem, "psor")["time_ms"]
        gain = f"{'' if psor else '> '}{least / sm['time_ms']:.0f}" if sm else "-"
        fewest = "-" if not (sm and ipm) else ("pgs-sm" if sm["factorisations"] <= ipm["factorisations"] else "ipm")
        rows.append([problem["problem"], count(problem["n"]), slow, time(sm and sm["time_ms"]),
                     time(ipm and ipm["time_ms"]), gain, sm and sm["factorisations"], ipm and ipm["factorisations"],
                     fewest])
    return table(["problem", "n", "PSOR", "pgs-sm", "ipm", "PSOR / pgs-sm", "fact. pgs-sm", "ipm", "fewer"], rows)


def fastest(solvers):
    right = [solver for solver in solvers if solver["error"] is not None and solver["error"] <= 1e-6]
    return min(right, key=lambda solver: solver["time_ms"], default=None)


def siconos(tool, folder, inequalities):
    runs = {name: [os.path.join(folder, name)] for name in inequalities}
    runs.update({name: [name] for name in ("journal-bearing", "american-put-step")})
    rows = []
    for name, words in runs.items():
        def solve(solvers, limit):
            return tool.solve(f"siconos-{name}-{solvers}", *words, "--solver", solvers, "--errors", "1e-6",
                              "--max-sweeps", limit, "--tolerance", "1e-8")["problems"][0]

        ours = solve("pgs-sm,ipm", SWEEPS)
        dense = inequalities.get(name, ours["n"]) <= MOST_DENSE
        limits = {**SPARSE_PEERS, **(DENSE_PEERS if dense else {})}
        theirs = [solve(peer, limit)["solvers"][0] for peer, limit in limits.items()]
        best, mine = fastest(theirs), fastest(ours["solvers"])
        rows.append([ours["problem"], count(ours["n"]), best["solver"] if best else "none",
                     time(best and best["time_ms"]), mine["solver"] if mine else "none",
                     time(mine and mine["time_ms"]),
                     f"{best['time_ms'] / mine['time_ms']:.1f}" if best and mine else "-"])
    return table(["problem", "n", "best of Siconos", "CPU", "best of Cairn", "CPU", "times faster"], rows)
