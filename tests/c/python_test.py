# SPDX-License-Identifier: MIT
"""The example in Python over the interface of C. Arguments: the library, a folder to write to.
Skipped (77) where no Python has NumPy."""
import os
import re
import subprocess
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
EXAMPLE = os.path.join(HERE, "..", "..", "examples", "python")
SKIPPED = 77
CHILD = "child"


def python_with_numpy():
    for python in (sys.executable, "/usr/bin/python3"):
        try:
            answer = subprocess.run([python, "-c", "import numpy"], capture_output=True)
        except OSError:
            continue
        if answer.returncode == 0:
            return python
    return None


def expect(condition, what):
    if not condition:
        sys.exit(f"not true: {what}")


def refusal(function):
    import cairn
    try:
        function()
    except cairn.CairnError as error:
        return str(error)
    return ""


def test_binding(library_path):
    import cairn
    import error_against_sweeps
    import numpy
    library = cairn.Library(library_path)
    solver = cairn.Solver(library, library.settings(tolerance=1e-4))

    # by hand: the ground carries five boxes of 1 kg
    bodies, manifolds, points = error_against_sweeps.tower(5)
    impulses = numpy.zeros(len(points), cairn.IMPULSE)
    velocities = solver.solve(bodies, manifolds, points, impulses)
    ground = impulses["normal"][:4].sum()
    expect(abs(ground - 5 * 9.81 / 60) < 1e-3, f"the ground gives {ground}")
    expect(abs(velocities["linear"]).max() < 1e-3, "the tower rests")
    expect(solver.report.islandCount == 1 and solver.report.residualMax <= 1e-4, "the report")

    # a box hangs from the world on three rows
    joints = cairn.default_array(cairn.JOINT, 1)
    joints["bodyA"], joints["rows"] = 0, 3
    rows = cairn.default_array(cairn.JOINT_ROW, 3)
    rows["linearA"] = numpy.eye(3)
    carried = numpy.zeros(3, "f4")
    solver.solve(bodies[:1], joints=joints, rows=rows, row_impulses=carried)
    expect(abs(carried[1] - 9.81 / 60) < 1e-3, f"the joint gives {carried[1]}")

    points["bias"][7] = numpy.nan
    said = refusal(lambda: solver.solve(bodies, manifolds, points, impulses))
    expect("manifold 1: bias of a point is nan, must be finite" in said, said)
    said = refusal(lambda: cairn.Solver(library, library.settings(threads=0)))
    expect(said == "threads is 0, must be 1 to 1024", said)
    said = refusal(lambda: solver.solve(numpy.zeros(3, cairn.VELOCITY)))
    expect("contiguous array" in said, said)
    good, cairn.VERSION = cairn.VERSION, (cairn.VERSION[0], cairn.VERSION[1] + 1, 0)
    said = refusal(lambda: cairn.Solver(library))
    cairn.VERSION = good
    expect("another version" in said, said)


def run_script(library_path, picture, *frames):
    """What it printed, and the errors by the number of sweeps."""
    if os.path.exists(picture):
        os.remove(picture)
    script = os.path.join(EXAMPLE, "error_against_sweeps.py")
    said = subprocess.run([sys.executable, "-B", script, "--library", library_path, "--plot", picture, *frames],
                          check=True, capture_output=True, text=True).stdout
    print(said)
    lines = [line.split(" | ") for line in said.splitlines() if re.match(r"\d+ \|", line)]
    errors = {int(line[0]): [float(cell) for cell in line[1:]] for line in lines}
    expect(len(errors) == 12 and all(len(row) == 3 for row in errors.values()), "the table")
    return said, errors


def test_script(library_path, folder):
    """Without a frame: a tower of its own."""
    picture = os.path.join(folder, "error_against_sweeps.png")
    said, errors = run_script(library_path, picture)
    plain, accelerated, steps = errors[100]
    expect(steps < accelerated < plain < errors[1][0], "each method leaves less, and more sweeps do")
    if "no picture: No module named" not in said:
        with open(picture, "rb") as file:
            expect(file.read(4) == b"\x89PNG", "the picture")
    return errors


def test_recorded_frame(library_path, folder, of_tower):
    import cairn
    import error_against_sweeps
    import numpy
    library = cairn.Library(library_path)
    frame = os.path.join(folder, "python_test.cairn")
    if os.path.exists(frame):
        os.remove(frame)
    solver = cairn.Solver(library)
    solver.record_next(frame)
    # boxes that fall at 3 m/s: errors are larger than those of the script's own tower, put down at rest
    bodies, manifolds, points = error_against_sweeps.tower(5)
    bodies["velocity"]["linear"][:, 1] = -3
    solver.solve(bodies, manifolds, points, numpy.zeros(len(points), cairn.IMPULSE))
    _, errors = run_script(library_path, os.path.join(folder, "recorded_frame.png"), frame)
    expect(errors[1][0] > 3 * of_tower[1][0], "the frame is solved, not the tower")
    expect(errors[100][2] < 1e-3 < errors[1][2], "more sweeps leave less of it")


def main():
    library, folder = sys.argv[1:3]
    if sys.argv[3:] == [CHILD]:
        sys.path.insert(0, EXAMPLE)
        test_binding(library)
        errors = test_script(library, folder)
        test_recorded_frame(library, folder, errors)
        return
    python = python_with_numpy()
    if python is None:
        print("skipped: no Python here has NumPy (Debian: python3-numpy)")
        sys.exit(SKIPPED)
    sys.exit(subprocess.run([python, "-B", __file__, library, folder, CHILD]).returncode)


if __name__ == "__main__":
    main()
