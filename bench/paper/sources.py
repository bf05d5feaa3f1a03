# SPDX-License-Identifier: MIT
"""American options, lubrication and obstacles: what is known of them, and what we get."""
from run import solver_of
from text import count, small, table, time


def answer_rows(problem, name="pgs-sm"):
    solver = solver_of(problem, name)
    return [[problem["problem"], count(problem["n"]), problem["steps"], time(solver["time_ms"]),
             solver["sweeps"], solver["factorisations"], answer["name"], f"{answer['value']:.8g}",
             f"{answer['expected']:.8g}", small(abs(answer["difference"])), small(answer["tolerance"])]
            for answer in solver["answers"]]


HEAD = ["problem", "n", "steps", "CPU", "sweeps", "factorisations", "answer", "value", "known", "difference",
        "allowed"]


def options(tool):
    runs = [("put", ["american-put"])]
    runs += [(f"put-{spot}-{sigma}", ["american-put", "--set", f"spot={spot}", "--set", "strike=40", "--set",
                                      "rate=0.06", "--set", "dividend=0", "--set", f"sigma={sigma}"])
             for spot in (36, 44) for sigma in (0.2, 0.4)]
    runs += [(f"{name}-{size}-{kind}", [name, "--size", size, "--set", f"exercise={kind}", "--set",
                                        f"steps={max(100, size // 2)}"])
             for name in ("put-on-min", "put-on-average") for kind in (0, 1) for size in (50, 100, 200)]
    rows = []
    for name, words in runs:
        problem = tool.solve(name, *words, "--solver", "pgs-sm")["problems"][0]
        for row in answer_rows(problem):
            row[0] = " ".join(str(word) for word in words if word != "--set" and word != "--size")
            rows.append(row)
    return table(HEAD, rows)


def fluids(tool):
    runs = [["journal-bearing", "--size", size, "--set", f"eccentricity={e}", "--start", "nested"]
            for size, e in ((98, 0.1), (400, 0.1), (73, 0.5), (73, 0.9))]
    runs += [["infinite-bearing", "--set", f"eccentricity={e}"] for e in (0.1, 0.5, 0.8, 0.9)]
    runs += [["slider"], ["obstacle", "--size", 200, "--start", "nested"],
             ["torsion", "--start", "nested"], ["obstacle-two-sided", "--start", "nested"]]
    rows = []
    for number, words in enumerate(runs):
        problem = tool.solve(f"fluid-{number}", *words, "--solver", "pgs-sm", "--errors", "none")["problems"][0]
        rows += answer_rows(problem)
    return table(HEAD, rows)


def growth(tool):
    phases = ["layout", "sweeps", "ordering", "analysis", "factorising", "solving", "other"]
    rows, last = [], None
    for size in (100, 316, 1000):
        problem = tool.solve(f"growth-{size}", "obstacle", "--size", size, "--solver", "pgs-sm", "--start",
                             "nested", "--errors", "none", "--phases")["problems"][0]
        solver = solver_of(problem, "pgs-sm")
        ratio = "-" if last is None else f"{solver['time_ms'] / last:.1f}"
        last = solver["time_ms"]
        rows.append([count(problem["n"]), time(solver["time_ms"]), ratio, time(solver["nested_ms"]),
                     *(time(solver["phases_ms"][phase]) for phase in phases), solver["factorisations"],
                     count(solver["factor_nonzeros"])])
    return table(["n", "CPU", "times the last", "coarser grids", *phases, "factorisations", "nz(L)"], rows)
