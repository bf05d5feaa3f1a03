# SPDX-License-Identifier: MIT
"""The table of the README from results of cairn run: python3 readme_table.py RESULT.json...

Each scene comes from the budget that fits it: 4 ms, or 16 ms where Bullet's ten iterations take longer than 4 ms."""
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
        sys.exit(f"readme_table: {scene['scene']} at {budget:g} ms was run without {', '.join(missing)}")
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


if __name__ == "__main__":
    main(sys.argv[1:])
