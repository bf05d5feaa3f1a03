# SPDX-License-Identifier: MIT
"""Solves a recorded frame with more and more sweeps, and plots the error that is left.

    python3 error_against_sweeps.py frame.cairn --library libcairn-c.so --plot error.png

Without a frame it records one: a tower of thirty boxes that are put down at once. The plot needs
matplotlib; the table is printed in any case."""
import argparse
import os
import tempfile

import numpy

import cairn

METHODS = {
    "plain sweeps": dict(method=cairn.PGS),
    "accelerated sweeps": dict(method=cairn.PGS_SM, steps=False),
    "with steps": dict(method=cairn.PGS_SM),
}
SWEEPS = (1, 2, 3, 5, 7, 10, 15, 20, 30, 50, 70, 100)


def tower(boxes):
    """Boxes of 1 m and 1 kg on each other and the ground: bodies, manifolds and points."""
    bodies = cairn.default_array(cairn.BODY, boxes)
    bodies["invMass"] = 1
    bodies["invInertia"] = 6 * numpy.eye(3)
    bodies["impulse"][:, 1] = -9.81 / 60
    bodies["id"] = numpy.arange(boxes) + 1
    manifolds = cairn.default_array(cairn.MANIFOLD, boxes)
    manifolds["bodyA"] = numpy.arange(boxes)
    manifolds["bodyB"] = numpy.arange(boxes) - 1  # the first one: cairn.WORLD
    manifolds["firstPoint"] = 4 * numpy.arange(boxes)
    manifolds["points"] = 4
    points = cairn.default_array(cairn.POINT, 4 * boxes)
    corners = numpy.tile([[-0.5, 0, -0.5], [0.5, 0, -0.5], [-0.5, 0, 0.5], [0.5, 0, 0.5]],
                         (boxes, 1))
    points["armA"] = corners - [0, 0.5, 0]
    points["armB"] = corners + [0, 0.5, 0]
    points["normal"] = [0, 1, 0]
    points["friction"] = 0.5
    return bodies, manifolds, points


def record_tower(library, path):
    bodies, manifolds, points = tower(30)
    solver = cairn.Solver(library)
    solver.record_next(path)
    solver.solve(bodies, manifolds, points, numpy.zeros(len(points), cairn.IMPULSE))


def error_after(library, recording, sweeps, settings):
    """The largest distance of a row from its law [m/s], from the start of the recording."""
    settings = library.settings(maxSweeps=sweeps, tolerance=0, **settings)
    solver = cairn.Solver(library, settings)
    solver.solve_recording(recording)
    return solver.report.residualMax


def plot(errors, path):
    import matplotlib
    matplotlib.use("Agg")
    from matplotlib import pyplot
    figure, axes = pyplot.subplots(figsize=(7, 4.5))
    for name, of_method in errors.items():
        axes.loglog(SWEEPS, of_method, marker="o", label=name)
    axes.set_xlabel("sweeps")
    axes.set_ylabel("largest residual [m/s]")
    axes.grid(True, which="both", alpha=0.3)
    axes.legend()
    figure.tight_layout()
    figure.savefig(path, dpi=120)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("frame", nargs="?", help="a recorded frame; none: a tower")
    parser.add_argument("--library", help="path of libcairn-c")
    parser.add_argument("--plot", help="picture to write")
    args = parser.parse_args()

    library = cairn.Library(args.library)
    with tempfile.TemporaryDirectory() as folder:
        frame = args.frame or os.path.join(folder, "tower.cairn")
        if not args.frame:
            record_tower(library, frame)
        recording = cairn.Recording(library, frame)
    errors = {name: [error_after(library, recording, sweeps, settings) for sweeps in SWEEPS]
              for name, settings in METHODS.items()}

    print("sweeps", *errors, sep=" | ")
    for row, sweeps in enumerate(SWEEPS):
        print(sweeps, *[f"{of_method[row]:.2e}" for of_method in errors.values()], sep=" | ")
    if args.plot:
        try:
            plot(errors, args.plot)
            print("wrote", args.plot)
        except ImportError as error:
            print("no picture:", error)


if __name__ == "__main__":
    main()
