# SPDX-License-Identifier: MIT
"""Who may include whom: bullet_adapter -> core -> simd, third parties in one home each, no cycle."""
import os
import re

import tree

# Where a quoted include is looked for, beside the folder of the file itself.
INCLUDE_ROOTS = ("", "core/include", "core/src", "core/lcp/include", "core/lcp/src", "core/c/include", "bullet_adapter/include", "bullet_adapter/src",
                 "bench")

# Rooms of the core, in the order of a frame.
BELOW_PLAN = ("core/include/", "simd/", "core/src/problem/", "core/src/runtime/")
BELOW_SWEEP = BELOW_PLAN + ("core/src/plan/", "core/src/pack/")
BELOW_STEP = BELOW_SWEEP + ("core/src/sweep/", "core/src/cholesky/")

# Rooms of the bench.
BELOW_RUN = ("bullet_adapter/include/", "core/include/", "bench/support/", "bench/measure/",
             "bench/contestants/")
ABOVE_RUN = BELOW_RUN + ("bench/scenes/", "bench/effort/", "bench/animation/")

# Folder -> prefixes of our own files that it may include. The longest folder that fits a file counts.
MAY_INCLUDE = {
    "simd": ("simd/",),
    "core/include": ("core/include/",),
    "core/src/problem": ("core/include/", "simd/", "core/src/problem/"),
    "core/src/runtime": ("core/include/", "core/src/runtime/"),
    "core/src/plan": BELOW_PLAN + ("core/src/plan/",),
    "core/src/pack": BELOW_PLAN + ("core/src/plan/", "core/src/pack/"),
    "core/src/sweep": BELOW_SWEEP + ("core/src/sweep/",),
    "core/src/cholesky": ("core/include/", "core/src/runtime/", "core/src/cholesky/", "simd/"),
    "core/src/step": BELOW_STEP + ("core/src/step/",),
    "core/src/cycle": BELOW_STEP + ("core/src/step/", "core/src/cycle/"),
    # The double-precision path: the frame above never includes it.
    "core/src/reference": BELOW_STEP + ("core/src/step/", "core/src/reference/"),
    "core/src/engine": ("core/include/", "core/src/problem/", "core/src/engine/"),
    "core/src/recording": ("core/include/", "core/src/problem/", "core/src/recording/"),
    "core/src": ("core/include/", "core/src/", "simd/"),
    # C, and what stands behind it.
    "core/c/include": ("core/c/include/",),
    "core/c/src": ("core/c/", "core/include/"),
    "core/lcp/include": ("core/lcp/include/", "core/include/"),
    "core/lcp/src": ("core/include/", "core/lcp/", "core/src/cholesky/", "core/src/problem/",
                     "core/src/runtime/", "simd/"),
    "bullet_adapter/include": ("bullet_adapter/include/", "core/include/"),
    "bullet_adapter/src": ("bullet_adapter/", "core/include/"),
    # Rooms of the bench, from what all use up to programs.
    "bench/support": ("bench/support/", "core/include/", "core/lcp/include/", "simd/"),
    "bench/scenes": ("bench/scenes/",),
    "bench/problems": ("bench/problems/", "core/include/", "core/lcp/include/"),
    "bench/measure": ("bench/measure/", "bench/support/machine/stopwatch.h", "bullet_adapter/include/", "core/include/"),
    "bench/rigid": ("bullet_adapter/include/", "core/include/", "core/lcp/include/", "bench/measure/", "bench/scenes/",
                    "bench/problems/", "bench/rigid/"),
    "bench/worlds": ("bench/scenes/", "bench/measure/", "bench/support/machine/stopwatch.h", "bench/worlds/", "bullet_adapter/include/",
                     "core/include/", "core/src/problem/"),
    "bench/campaign": ("bench/support/", "bench/worlds/", "bench/campaign/", "simd/"),
    "bench/verify": ("bench/scenes/", "bench/verify/", "bullet_adapter/include/", "core/include/",
                     "core/lcp/include/", "simd/"),
    "bench/contestants": BELOW_RUN[:4] + ("bench/contestants/",),
    "bench/effort": BELOW_RUN + ("bench/effort/", "simd/"),
    "bench/animation": ("bench/scenes/", "bench/animation/"),
    "bench/run": ABOVE_RUN + ("bench/run/", "bench/worlds/"),
    "bench/compare": ("bench/support/", "bench/run/", "bench/compare/"),
    "bench/page": ("bench/support/", "bench/run/", "bench/compare/", "bench/page/"),
    "bench/small": ABOVE_RUN + ("bench/run/", "bench/small/", "bench/worlds/"),
    "bench/lcp": ("bench/support/", "bench/lcp/", "core/include/", "core/lcp/include/"),
    "bench/rows": BELOW_RUN + ("bench/scenes/", "core/lcp/include/", "bench/rigid/", "bench/lcp/", "bench/rows/"),
    "bench/solve": ("bench/support/", "bench/problems/", "bench/measure/", "bench/rigid/", "bench/lcp/",
                    "bench/rows/", "bench/solve/", "core/include/", "core/lcp/include/"),
    "bench/play": ABOVE_RUN + ("bench/run/", "bench/rows/", "bench/worlds/", "bench/play/", "examples/debug_draw.h",
                                "examples/fixed_steps.h"),
    "bench/tools": ("bench/", "core/include/", "core/lcp/include/", "simd/"),
    "bench/frames": ABOVE_RUN + ("bench/run/", "bench/worlds/", "bench/frames/"),
    "bench/accuracy": ABOVE_RUN + ("bench/run/", "bench/accuracy/"),
    "bench/micro": ("bench/support/", "bench/measure/", "bench/scenes/", "bench/run/", "bench/micro/",
                    "bullet_adapter/include/", "core/", "simd/"),
    "examples": ("examples/", "bullet_adapter/include/", "core/include/", "core/c/include/",
                 "core/lcp/include/"),
    "tests": ("",),
}

# Third party -> what its headers look like, and the files that may include them (regular expressions).
THIRD_PARTIES = {
    "Highway": (r"hwy/", r"(tests/)?simd/.*(\.cc|-inl\.h)$"),
    "oneTBB": (r"(tbb|oneapi)/", r"core/src/runtime/executor_tbb"),
    "Eigen's orderings": (r"Eigen/OrderingMethods$", r"core/src/cholesky/minimum_degree\.|tests/"),
    "Eigen's sparse factorisations": (
        r"(unsupported/)?Eigen/(Sparse(Cholesky|LU|QR)?|.*Support|Iterative.*)$",
        r"bench/micro/cholesky/eigen_cholesky\.|tests/"),
    "Eigen": (r"(unsupported/)?Eigen/",
              r"core/(src|lcp)/|core/include/cairn/detail/eigen\.h$|bullet_adapter/src/|bench/|examples/|tests/"),
    "Bullet": (r"bt\w+\.h$|(Bullet\w+|LinearMath|bullet)/", r"bullet_adapter/|bench/|examples/|tests/"),
    "command line, JSON, text": (r"(CLI|nlohmann|fmt)/", r"bench/|tests/bench/"),
    "DART": (r"dart/.*\.hpp$", r"examples/dart/"),
    "GLFW, Dear ImGui, OpenGL, stb": (r"(GLFW|GL)/|(backends/)?imgui|stb_image", r"bench/play/view/"),
    "Siconos": (r"siconos/", r"bench/lcp/siconos_"),
    "CHOLMOD": (r"suitesparse/", r"bench/micro/cholesky/cholmod_"),
    "Google Benchmark": (r"benchmark/", r"bench/micro/"),
    "test libraries": (r"(gtest|gmock|rapidcheck)(/|\.h)", r"tests/"),
}

INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]', re.MULTILINE)


def resolve(includer, name):
    """The file of the project that an include means, or None."""
    for root in (os.path.dirname(includer),) + INCLUDE_ROOTS:
        path = os.path.normpath(os.path.join(root, name)).replace(os.sep, "/")
        if os.path.isfile(os.path.join(tree.ROOT, path)):
            return path
    return None


def allowed_folders(path):
    fitting = [folder for folder in MAY_INCLUDE if path.startswith(folder + "/")]
    return MAY_INCLUDE[max(fitting, key=len)] if fitting else None


def third_party_error(path, bracket, name):
    for party, (pattern, homes) in THIRD_PARTIES.items():
        if re.match(pattern, name):
            return None if re.match(homes, path) else f"no place for {party}: {name}"
    if bracket == '"':
        return f"no such file: {name}"
    # What is left in <> is the standard library and POSIX: no folder but those of POSIX.
    if "/" in name and not name.startswith(("sys/", "linux/")):
        return f"unknown library: {name}"
    return None


def check(path, graph):
    errors = []
    allowed = allowed_folders(path)
    if allowed is None:
        return [f"{path}: no layer; add its folder to {os.path.basename(__file__)}"]
    for bracket, name in INCLUDE.findall(tree.read(path)):
        target = resolve(path, name)
        if target:
            graph[path].append(target)
            if not target.startswith(allowed):
                errors.append(f"{path}: may not include {target}")
        else:
            error = third_party_error(path, bracket, name)
            errors += [f"{path}: {error}"] if error else []
    return errors


def find_cycle(graph):
    """A list of files that include one another in a ring, or []."""
    finished = set()

    def visit(path, trail):
        if path in trail:
            return trail[trail.index(path):] + [path]
        if path in finished:
            return []
        for target in graph.get(path, []):
            cycle = visit(target, trail + [path])
            if cycle:
                return cycle
        finished.add(path)
        return []

    for path in graph:
        cycle = visit(path, [])
        if cycle:
            return cycle
    return []


def main():
    paths = tree.walk(tree.SOURCE_FOLDERS, tree.CPP)
    graph = {path: [] for path in paths}
    errors = [error for path in paths for error in check(path, graph)]
    cycle = find_cycle(graph)
    if cycle:
        errors.append("cycle: " + " -> ".join(cycle))
    tree.finish(errors, len(paths))


if __name__ == "__main__":
    main()
