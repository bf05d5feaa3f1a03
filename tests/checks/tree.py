# SPDX-License-Identifier: MIT
"""The files of the project, found without git so that an unpacked archive can be checked too."""
import os
import sys

ROOT = os.path.normpath(os.path.join(os.path.dirname(__file__), "..", ".."))
SOURCE_FOLDERS = ("bench", "bullet_adapter", "core", "examples", "simd", "tests")
TEXT_FOLDERS = SOURCE_FOLDERS + (".ci", "cmake", "docs")
CPP = (".h", ".cc", ".c")


def walk(folders, suffixes=("",)):
    """Paths relative to ROOT, with forward slashes, sorted."""
    found = []
    for folder in folders:
        for path, names, files in os.walk(os.path.join(ROOT, folder)):
            names[:] = [n for n in names if n != "__pycache__"]
            found += [os.path.relpath(os.path.join(path, f), ROOT).replace(os.sep, "/")
                      for f in files if f.endswith(suffixes)]
    return sorted(found)


def read(path):
    with open(os.path.join(ROOT, path), encoding="utf-8") as file:
        return file.read()


def finish(errors, checked):
    """Ends a check: the errors, or what was checked."""
    for error in errors:
        print(error)
    print(f"{checked} files checked, {len(errors)} errors")
    sys.exit(1 if errors else 0)
