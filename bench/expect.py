# SPDX-License-Identifier: MIT
"""The first two tables of the README: what Cairn takes of Bullet's time, and what stands.

    python3 bench/expect.py build/release/bin/cairn

Four minutes. Worlds are as Bullet makes them, with one direction of friction at a contact; the
last column of the first table has times with two. Both solvers make ten iterations."""
import json
import os
import subprocess
import sys
import tempfile

BOTH = ["--solver", "bullet-si,cairn", "--samples", "0", "--progress", "never", "--quiet"]
TIMED = ["pyramid3d", "islands", "castle", "wall", "tower", "ragdolls", "bridge", "heavy-top", "chain",
         "two-pin-bridge"]
STANDS = {"tower": ("tower of equal boxes", 30), "heavy-top": ("heavy-top: 100 kg on boxes of 1 kg", 15),
          "growing-tower": ("growing-tower: masses grow 64 times", 22),
          "arch": ("arch of stones without mortar", 21), "bridge": ("bridge of planks on pins, with crates", 40),
          "two-pin-bridge": ("two-pin-bridge", 50), "pyramid": ("pyramid", 20), "wall": ("wall", 10)}
SMALL_ARCH = ("arch of stones without mortar", 11)
SEEDS = range(1, 6)


def run(tool, *words):
    """The scene of a run, as its JSON has it."""
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "run.json")
        subprocess.run([tool, "run", *words, *BOTH, "--json", path], check=True, stdout=subprocess.DEVNULL)
        with open(path, encoding="utf-8") as file:
            return json.load(file)["scenes"][0]


def length(metres):
    for factor, unit in ((1e6, "um"), (1e3, "mm"), (1e2, "cm")):
        if metres * factor < 10 or unit == "cm":
            return f"{metres * factor:.2g} {unit}"


def fact(solver, name):
    return next(fact["value"] for fact in solver["facts"] if fact["name"] == name)


def became(solvers):
    """What became of a scene with one solver, of several runs the worst."""
    if any(solver["failure"] for solver in solvers):
        return "fails"
    fell = sum(solver["standing"] is False for solver in solvers)
    words = []
    if fell:
        words.append("falls" if len(solvers) == 1 else f"falls {fell} of {len(solvers)}")
    elif solvers[0]["standing"]:
        words.append(f"stands, {length(max(fact(solver, 'height lost') for solver in solvers))} lower")
    gaps = [fact(solver, "joint gap") for solver in solvers]
    if gaps[0] is not None:
        words.append(f"gaps {length(max(gaps))}")
    return ", ".join(words)


def time_table(tool):
    print("| scene | bodies | Bullet ms | Cairn, of that | Bullet at the end | Cairn at the end "
          "| Cairn, of Bullet's, two directions |")
    print("|---|---:|---:|---:|---|---|---:|")
    for name in TIMED:
        one, two = (run(tool, name, "--frames", "120", "--repeat", "3", "--directions", str(directions))
                    for directions in (1, 2))
        times = [[solver["summary"]["p50_ms"] for solver in scene["solvers"]] for scene in (one, two)]
        ratios = [cairn / bullet for bullet, cairn in times]
        ends = [became([solver]) for solver in one["solvers"]]
        print(f"| {name} | {one['bodies']} | {times[0][0]:.2g} | {ratios[0]:.2f} | {ends[0]} | {ends[1]} "
              f"| {ratios[1]:.2f} |")


def stand_table(tool):
    print("| scene | size | Bullet | Cairn |\n|---|---:|---|---|")
    for name, (label, size) in [*STANDS.items(), ("arch", SMALL_ARCH)]:
        runs = [run(tool, name, "--size", str(size), "--frames", "1200", "--seed", str(seed), "--directions", "1")
                for seed in SEEDS]
        ends = [became([scene["solvers"][i] for scene in runs]) for i in range(2)]
        print(f"| {label} | {size} | {ends[0]} | {ends[1]} |")


def main():
    if len(sys.argv) != 2 or not os.access(sys.argv[1], os.X_OK):
        sys.exit(__doc__)
    time_table(sys.argv[1])
    print()
    stand_table(sys.argv[1])


if __name__ == "__main__":
    main()
