# SPDX-License-Identifier: MIT
"""Plain text everywhere: ASCII, no tabs, no trailing blanks; licence line in sources; no loose
ends; documents in 100 columns; nothing that compilers drop."""
import os
import re

import tree

NEEDS_LICENCE = tree.CPP + (".py",)
PICTURES = (".png",)
INPUTS_OF_FUZZERS = "tests/fuzz/corpus/"
LOOSE_END = re.compile(r"\b(TODO(?!\(#\d+\))|FIXME|XXX)\b")
# Where it may be called, as the file says.
PREFETCH = "__builtin_" + "prefetch", "core/include/cairn/detail/prefetch.h"
SELF = os.path.relpath(os.path.abspath(__file__), tree.ROOT).replace(os.sep, "/")


def check(path):
    errors = []
    try:
        text = tree.read(path)
    except UnicodeDecodeError:
        return [f"{path}: not text"]
    if path.endswith(NEEDS_LICENCE) and "SPDX-License-Identifier: MIT" not in text[:200]:
        errors.append(f"{path}: no SPDX licence line on top")
    if text and not text.endswith("\n"):
        errors.append(f"{path}: no newline at the end")
    for number, line in enumerate(text.splitlines(), 1):
        if not line.isascii():
            errors.append(f"{path}:{number}: not ASCII")
        if "\t" in line:
            errors.append(f"{path}:{number}: tab")
        if line != line.rstrip():
            errors.append(f"{path}:{number}: blank at the end")
        if PREFETCH[0] in line and path != PREFETCH[1]:
            errors.append(f"{path}:{number}: call cairn::Prefetch() of {PREFETCH[1]}")
        # Tables may be wider.
        if path.endswith(".md") and line[:1] != "|" and len(line) > 100:
            errors.append(f"{path}:{number}: longer than 100 columns")
        # A note of work to do names where it is tracked; documents and this script may speak of it.
        if not path.endswith(".md") and path != SELF and LOOSE_END.search(line):
            errors.append(f"{path}:{number}: write TODO(#number)")
    return errors


def main():
    top = [name for name in os.listdir(tree.ROOT) if os.path.isfile(os.path.join(tree.ROOT, name))]
    paths = [path for path in sorted(top) + tree.walk(tree.TEXT_FOLDERS)
             if not path.endswith(PICTURES) and not path.startswith(INPUTS_OF_FUZZERS)]
    tree.finish([error for path in paths for error in check(path)], len(paths))


if __name__ == "__main__":
    main()
