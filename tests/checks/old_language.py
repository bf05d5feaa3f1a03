# SPDX-License-Identifier: MIT
"""Every public header tells users of C++17 in its first error what is missing: the compiler is the
argument."""
import subprocess
import sys

import tree

FOLDERS = ("core/include", "core/lcp/include", "bullet_adapter/include")
SENTENCE = "Cairn needs C++20"


def first_error(compiler, path):
    """The first line with an error of a header compiled as C++17."""
    includes = [part for folder in FOLDERS for part in ("-I", f"{tree.ROOT}/{folder}")]
    command = [compiler, "-std=c++17", "-fsyntax-only", "-x", "c++", *includes, f"{tree.ROOT}/{path}"]
    said = subprocess.run(command, capture_output=True, text=True).stderr
    return next((line for line in said.splitlines() if "error" in line), "none")


def main():
    headers = tree.walk(FOLDERS, (".h",))
    errors = []
    for path in headers:
        error = first_error(sys.argv[1], path)
        if SENTENCE not in error:
            errors.append(f"{path}: the first error is: {error}")
    tree.finish(errors, len(headers))


if __name__ == "__main__":
    main()
