# SPDX-License-Identifier: MIT
"""The public headers stay short enough to be read: what a game meets, all that a game or an engine
needs, the helpers that an engine may take besides, the interface of C and its helpers, and the library for matrices.
What is in a folder detail/ is no promise, and not counted."""
import os

import tree

CORE, LCP, ADAPTER = "core/include/cairn/", "core/lcp/include/cairn/", "bullet_adapter/include/cairn/"
C = "core/c/include/cairn/"
GAME = [CORE + name + ".h" for name in ("budget", "contact_problem", "executor", "joint", "manifold",
                                        "report", "settings", "solver")]
# The first three make problems of what an engine knows; whoever makes problems by himself needs none of them. The
# fourth is three and nine numbers, which nobody reads who has vectors of his own, the last for those who have memory
# of their own.
HELPERS = [CORE + name + ".h" for name in ("contacts", "joints", "strict", "vector", "memory")]
# Bullet's multithreaded world, for those who have a Bullet that is built for it.
MANY_THREADS = [ADAPTER + "bullet/" + name + ".h" for name in ("constraint_solver_pool", "task_scheduler")]
# For engines in C, as HELPERS.
HELPERS_OF_C = [C + "cairn_helpers.h"]
APART = HELPERS + MANY_THREADS + HELPERS_OF_C
# What -> its files, and how many lines they may have together, fewer than that.
LIMITS = {
    "what a game meets": (GAME, 500),
    "core and adapter": ((CORE, ADAPTER), 900),
    "helpers for engines, vectors, memory": (HELPERS, 355),
    "Bullet's multithreaded world": (MANY_THREADS, 150),
    "interface of C": ((C,), 370),
    "helpers for engines in C": (HELPERS_OF_C, 202),
    "matrices": ((LCP,), 300),
}


def public_headers():
    return [path for path in tree.walk((C, CORE, LCP, ADAPTER), (".h",)) if "/detail/" not in path]


def main():
    headers = public_headers()
    errors = [f"{path}: no such header" for path in GAME + APART if path not in headers]
    for what, (places, limit) in LIMITS.items():
        lines = {path: tree.read(path).count("\n") for path in headers
                 if path.startswith(tuple(places)) and (set(places) <= set(APART) or path not in APART)}
        total = sum(lines.values())
        print(f"{what}: {total} lines of less than {limit}")
        if total >= limit:
            longest = sorted(lines, key=lines.get, reverse=True)[:5]
            named = ", ".join(f"{os.path.basename(path)} {lines[path]}" for path in longest)
            errors.append(f"{what}: {total} lines, must be less than {limit}; the longest: {named}")
    tree.finish(errors, len(headers))


if __name__ == "__main__":
    main()
