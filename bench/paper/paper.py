# SPDX-License-Identifier: MIT
"""Writes docs/paper.md: solves its problems with the cairn tool, and sets the talk's figures beside ours."""
import argparse
import json
import os
import string

import collection
import rigid
import sources
from run import Tool


def facts_of(folder, name):
    with open(os.path.join(folder, name, "meta.json"), encoding="utf-8") as file:
        meta = json.load(file)
    # the suffix says 1e6 where the number in the file is a rounding below
    ill = meta["kind"] == "mlcp" and (meta.get("cond") or 0) >= 0.99 * collection.ILL
    return {"ill": ill, "n": meta["n"], "inequalities": meta["n"] - meta.get("n_a", 0)}


def collection_text(tool, folder):
    if not os.path.isdir(folder):
        return {key: f"Left out: {os.path.basename(folder)} was not there.\n"
                for key in ("summary", "everything", "ill", "siconos")}
    problems = collection.solve_all(tool, folder)
    facts = {problem["problem"]: facts_of(folder, problem["problem"]) for problem in problems}
    ill = [name for name, fact in facts.items() if fact["ill"]]
    large = {name: fact["inequalities"] for name, fact in facts.items() if fact["n"] >= collection.LARGE}
    return {"summary": collection.summary(problems), "everything": collection.everything(problems),
            "ill": collection.ill_conditioned(tool, folder, ill),
            "siconos": collection.siconos(tool, folder, large)}


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--cairn", required=True, help="the tool")
    parser.add_argument("--out", required=True, help="folder for what was measured")
    parser.add_argument("--docs", required=True, help="folder that gets paper.md")
    parser.add_argument("--problems", required=True, help="folder of problems of others")
    parser.add_argument("--keep", action="store_true", help="measure only what --out does not hold yet")
    args = parser.parse_args()

    tool = Tool(args.cairn, args.out, args.keep)
    castles = rigid.solve_all(tool)
    context = tool.solve("machine", "castle", "--size", 1)["context"]
    values = {"cpu": context["host"]["cpu"], "cores": context["host"]["cores"], "date": context["date"][:10],
              "sizes": rigid.sizes(castles), "sweeps": rigid.sweeps(castles),
              "active": rigid.active_sets(tool, castles), "methods": rigid.methods(castles),
              "figures": rigid.figures(tool, args.docs), "options": sources.options(tool),
              "fluids": sources.fluids(tool), "growth": sources.growth(tool)}
    values.update(collection_text(tool, args.problems))

    here = os.path.dirname(os.path.abspath(__file__))
    with open(os.path.join(here, "paper.md.in"), encoding="ascii") as file:
        template = string.Template(file.read())
    with open(os.path.join(args.docs, "paper.md"), "w", encoding="ascii") as file:
        file.write(template.substitute(values))
    print("Written:", os.path.join(args.docs, "paper.md"))


if __name__ == "__main__":
    main()
