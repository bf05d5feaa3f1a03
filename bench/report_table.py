# SPDX-License-Identifier: MIT
"""The first table of docs/benchmarks.md, The full report: python3 report_table.py RESULT.json...

Each scene comes from the budget that fits it: 4 ms, or 16 ms where Bullet's ten iterations take longer than 4 ms.
Below it the same residuals under every budget, and how many frames were over it."""
import json
import sys

SOLVERS = ("bullet-si", "bullet-si@fit", "cairn")
USUAL, LARGE = 4, 16
HEAD = ("| scene | residual: Bullet 10 | Bullet fit | Cairn | p99 ms: Bullet 10 | Bullet fit | Cairn | "
        "at the end, same order |")


def short(value):
    """Three digits, without the exponents of %g."""
    if value is None:
        return "-"
    text = f"{value:.3g}"
    return f"{value:.6f}".rstrip("0") if "e-" in text else text


def verdict(solver):
    if solver["failure"]:
        return "fails"
    return {True: "stands", False: "falls", None: "-"}[solver["standing"]]


def row(scene, budget):
    solvers = {solver["solver"]: solver for solver in scene["solvers"]}
    missing = [label for label in SOLVERS if label not in solvers]
    if missing:
        sys.exit(f"report_table: {scene['scene']} at {budget:g} ms was run without {', '.join(missing)}")
    chosen = [solvers[label] for label in SOLVERS]
    ends = [verdict(solver) for solver in chosen]
    cells = [scene["scene"] + ("" if budget == USUAL else f", {budget:g} ms")]
    cells += [short(solver["summary"]["residual_mean_m_s"]) for solver in chosen]
    cells += [f"{solver['summary']['p99_ms']:.2f}" for solver in chosen]
    cells.append("-" if set(ends) == {"-"} else ", ".join(ends))
    return "| " + " | ".join(cells) + " |"


def is_large(scene):
    p50 = next(s["summary"]["p50_ms"] for s in scene["solvers"] if s["solver"] == SOLVERS[0])
    return p50 is not None and p50 > USUAL


def under_budget(scene):
    """Mean residuals of Bullet as it fits and of Cairn, and the share of their frames over the budget."""
    cells = {}
    for solver in scene["solvers"]:
        summary = solver["summary"]
        over = 100 * (summary["overruns"] or 0) / max(1, summary["timed_frames"])
        fallen = ", falls" if solver["standing"] is False else ""
        late = f" ({over:.0f} %)" if over >= 1 else ""
        cells[solver["solver"]] = short(summary["residual_mean_m_s"]) + late + fallen
    return f"{cells[SOLVERS[1]]} / {cells[SOLVERS[2]]}"


def print_budgets(runs):
    budgets = sorted(runs)
    print("\n| scene | " + " | ".join(f"{budget:g} ms" for budget in budgets) + " |")
    print("|---|" + "---|" * len(budgets))
    for name in next(iter(runs.values())):
        print("| " + " | ".join([name] + [under_budget(runs[budget][name]) for budget in budgets]) + " |")


def main(paths):
    if not paths:
        sys.exit(__doc__)
    runs = {}
    for path in paths:
        with open(path, encoding="utf-8") as file:
            result = json.load(file)
        runs[result["budget_ms"]] = {scene["scene"]: scene for scene in result["scenes"]}
    usual = runs.get(USUAL) or next(iter(runs.values()))
    budget_of_usual = next(budget for budget, scenes in runs.items() if scenes is usual)
    print(HEAD)
    print("|---|---|---|---|---|---|---|---|")
    for name, scene in usual.items():
        large = LARGE in runs and name in runs[LARGE] and is_large(scene)
        print(row(runs[LARGE][name], LARGE) if large else row(scene, budget_of_usual))
    if len(runs) > 1:
        print_budgets(runs)


if __name__ == "__main__":
    main(sys.argv[1:])
