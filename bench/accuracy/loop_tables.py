# SPDX-License-Identifier: MIT
"""Statistics over the seeds of a closed loop: what was better than what, and a table for each scene.

    cairn_accuracy loop --json loop.json
    python3 bench/accuracy/loop_tables.py loop.json

Medians have order statistics around them that hold the true one with at least 95 %, whatever the distribution
(of fewer than 6 runs the smallest and the largest, which is less). Collapses have Wilson's 95 %. Compared are runs
of the same seed: lower:higher figure, and p of Wilcoxon's signed-rank test, two-sided, corrected by Holm for all
scenes. A failed run counts as infinite. Needs SciPy (Debian: python3-scipy)."""
import argparse
import json
import math

import numpy
from scipy import stats

LEVEL = 0.05
FEW_PAIRS = 12
# Key in the file -> name and unit in a table, and the factor to that unit.
FIGURES = {"height_lost_m": ("height lost mm", 1e3), "joint_gap_m": ("joint gap mm", 1e3),
           "penetration_m": ("penetration mm", 1e3), "residual_m_s": ("residual m/s", 1),
           "speed_at_rest_m_s": ("speed m/s", 1), "time_ms": ("time ms", 1),
           "steps_accepted": ("accepted /frame", 1), "steps_restored": ("restored /frame", 1)}
# Of each budget; Bullet has none.
COMPARISONS = (("sweeps", "Bullet"), ("accelerated", "Bullet"), ("steps", "Bullet"), ("steps", "sweeps"),
               ("steps", "accelerated"))


def digits(value):
    return "-" if math.isnan(value) else f"{value:.3g}"


def values(solver, key):
    """A figure of every run: NaN where it does not apply, infinite where the run failed."""
    return numpy.array([math.inf if seed in solver["failed_seeds"] else math.nan if value is None else value
                        for seed, value in enumerate(solver["figures"][key]["runs"], 1)], dtype=float)


def median_interval(numbers):
    """The lower median, and the order statistics around it; NaN are left out."""
    known = numpy.sort(numbers[~numpy.isnan(numbers)])
    if known.size == 0:
        return {"value": math.nan, "low": math.nan, "high": math.nan}
    cut = max(int(stats.binom.ppf(0.025, known.size, 0.5)), 1)
    return {"value": known[(known.size + 1) // 2 - 1], "low": known[cut - 1], "high": known[-cut]}


def share_interval(hits, count):
    low, high = stats.binomtest(hits, count).proportion_ci(0.95, "wilson")
    return {"value": hits / count, "low": low, "high": high}


def compare_paired(first, second):
    """Pairs that are equal, also both infinite, are left out of p; those with a NaN out of everything."""
    known = ~(numpy.isnan(first) | numpy.isnan(second))
    first, second = first[known], second[known]
    differ = first != second
    difference = first[differ] - second[differ]
    ranks = stats.rankdata(numpy.abs(difference))
    p = 1.0
    if ranks.size:
        signed = numpy.sign(difference) * ranks
        if len(set(ranks)) < ranks.size <= FEW_PAIRS:
            # SciPy's exact distribution knows no ties: all ways to choose the signs
            p = float(stats.permutation_test((signed,), numpy.sum, permutation_type="samples",
                                             n_resamples=2 ** FEW_PAIRS).pvalue)
        else:
            method = "exact" if len(set(ranks)) == ranks.size else "approx"
            p = float(stats.wilcoxon(signed, method=method).pvalue)
    return {"less": int((difference < 0).sum()), "more": int((difference > 0).sum()),
            "equal": int((~differ).sum()), "p": 1.0 if math.isnan(p) else p}


def holm(p):
    """Holm, "A simple sequentially rejective multiple test procedure", 1979; in the order in which they came."""
    adjusted, largest = [0.0] * len(p), 0.0
    for i, index in enumerate(sorted(range(len(p)), key=lambda k: p[k])):
        largest = max(largest, min(1.0, (len(p) - i) * p[index]))
        adjusted[index] = largest
    return adjusted


def solver_of(scene, budget, name):
    """Solvers are one for each budget and kind, in this order, and Bullet's."""
    if name == "Bullet":
        return scene["solvers"][-1]
    kinds = ("sweeps", "accelerated", "steps")
    return scene["solvers"][len(kinds) * budget + kinds.index(name)]


def compare(scenes, budget, first, second):
    tests = [compare_paired(values(solver_of(scene, budget, first), scene["judged_by"]),
                            values(solver_of(scene, budget, second), scene["judged_by"])) for scene in scenes]
    for test, p in zip(tests, holm([test["p"] for test in tests])):
        test["p"] = p
    return tests


def is_worse(test):
    return test["p"] < LEVEL and test["more"] > test["less"]


def add_statistics(run):
    """Writes into the file's own structure what is not measured but computed."""
    for scene in run["scenes"]:
        for solver in scene["solvers"]:
            runs = len(solver["figures"]["time_ms"]["runs"])
            solver["collapse_share"] = share_interval(solver["collapsed"], runs)
            for key, figure in solver["figures"].items():
                figure["median"] = median_interval(values(solver, key))
    run["comparisons"] = [
        {"budget_ms": budget, "compared": f"{first} with {second}",
         "scenes": {scene["scene"]: test
                    for scene, test in zip(run["scenes"], compare(run["scenes"], index, first, second))}}
        for index, budget in enumerate(run["budgets_ms"]) for first, second in COMPARISONS]


def table(columns, rows):
    widths = [max(3, *(len(row[i]) for row in [columns, *rows])) for i in range(len(columns))]
    def line(cells):
        return "| " + " | ".join([cells[0].ljust(widths[0]), *(c.rjust(w) for c, w in zip(cells[1:], widths[1:]))]) + " |"
    rule = "|:" + "-" * (widths[0] + 1) + "|" + "".join("-" * (width + 1) + ":|" for width in widths[1:])
    print("\n".join([line(columns), rule, *map(line, rows)]) + "\n")


def print_comparisons(run, budget):
    tests = [c for c in run["comparisons"] if c["budget_ms"] == budget]
    rows, lost = [], []
    for scene in run["scenes"]:
        row = [scene["scene"], FIGURES[scene["judged_by"]][0].rsplit(" ", 1)[0]]
        for comparison in tests:
            test = comparison["scenes"][scene["scene"]]
            verdict = "open" if test["p"] >= LEVEL else "WORSE" if is_worse(test) else "better"
            row.append(f"{verdict} {test['less']}:{test['more']} p {digits(test['p'])}")
            if is_worse(test):
                lost.append(f"{scene['scene']}, {comparison['compared']}")
        rows.append(row)
    print(f"## Compared, {budget:g} ms\n")
    table(["scene", "judged by", *(comparison["compared"] for comparison in tests)], rows)
    print("\n".join(f"- lost: {loss}" for loss in lost or ["none"]) + "\n")


def print_scene(scene):
    rows = []
    for solver in scene["solvers"]:
        share, runs = solver["collapse_share"], len(solver["figures"]["time_ms"]["runs"])
        falls = solver["can_fall"] or solver["collapsed"] > 0
        row = [solver["solver"], solver["effort"], f"{solver['collapsed']}/{runs} [{100 * share['low']:.0f}, "
               f"{100 * share['high']:.0f}] %" if falls else "-"]
        for key, (_, scale) in FIGURES.items():
            median = {name: scale * value for name, value in solver["figures"][key]["median"].items()}
            same = math.isnan(median["value"]) or median["low"] == median["high"]
            row.append(digits(median["value"]) + ("" if same else f" [{digits(median['low'])}, {digits(median['high'])}]"))
        rows.append(row)
    print(f"## {scene['scene']} (judged by {FIGURES[scene['judged_by']][0].rsplit(' ', 1)[0]}), "
          f"{len(scene['solvers'][0]['figures']['time_ms']['runs'])} seeds\n")
    table(["solver", "effort", "collapsed", *(name for name, _ in FIGURES.values())], rows)


def without_nan(value):
    """JSON has no NaN and no infinity."""
    if isinstance(value, dict):
        return {name: without_nan(part) for name, part in value.items()}
    if isinstance(value, list):
        return [without_nan(part) for part in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("file", help="what cairn_accuracy loop --json wrote")
    parser.add_argument("--json", metavar="FILE", help="write the same file with medians, shares and comparisons")
    arguments = parser.parse_args()
    with open(arguments.file, encoding="utf-8") as file:
        run = json.load(file)
    if run.get("subcommand") != "loop":
        parser.error(f"{arguments.file} is not of cairn_accuracy loop")
    add_statistics(run)
    print(f"# Scenes in closed loop\n\n- command: `{run['context']['command']}`\n")
    for budget in run["budgets_ms"]:
        print_comparisons(run, budget)
    for scene in run["scenes"]:
        print_scene(scene)
    if arguments.json:
        with open(arguments.json, "w", encoding="utf-8") as file:
            json.dump(without_nan(run), file, indent=1)


if __name__ == "__main__":
    main()
