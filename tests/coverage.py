# SPDX-License-Identifier: MIT
"""Which lines of core/ and simd/ the tests ran: python3 coverage.py BUILD_FOLDER [--lines]
Reads what programs built with --coverage left behind, by gcov. --lines: each range that no test ran."""
import argparse
import collections
import gzip
import json
import os
import subprocess
import tempfile

ROOT = os.path.normpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
FOLDERS = ("core/", "simd/")


def notes(build):
    for path, _, files in os.walk(build):
        yield from (os.path.join(path, file) for file in files if file.endswith(".gcda"))


def count(build):
    """File -> line -> how often it ran, summed over everything that was compiled with it."""
    lines = collections.defaultdict(collections.Counter)
    for data in notes(build):
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run(["gcov", "--json-format", data], cwd=folder, check=True,
                           stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            for name in os.listdir(folder):
                with gzip.open(os.path.join(folder, name)) as file:
                    found = json.load(file)
                for source in found["files"]:
                    path = os.path.join(found["current_working_directory"], source["file"])
                    path = os.path.relpath(os.path.realpath(path), ROOT)
                    if path.startswith(FOLDERS):
                        for line in source["lines"]:
                            lines[path][line["line_number"]] += line["count"]
    return lines


def ranges(numbers):
    """7, 8, 9, 12 -> 7-9, 12"""
    found = []
    for number in sorted(numbers):
        if found and number == found[-1][1] + 1:
            found[-1][1] = number
        else:
            found.append([number, number])
    return ", ".join(str(a) if a == b else f"{a}-{b}" for a, b in found)


def percent(ran, of):
    return f"{100 * ran / of:5.1f} %" if of else "    -  "


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("build")
    parser.add_argument("--lines", action="store_true")
    options = parser.parse_args()
    lines = count(os.path.abspath(options.build))
    for folder in FOLDERS:
        files = {path: found for path, found in sorted(lines.items()) if path.startswith(folder)}
        for path, found in files.items():
            missed = [number for number, times in found.items() if times == 0]
            print(f"{percent(len(found) - len(missed), len(found))}  {path}"
                  + (f": {ranges(missed)}" if options.lines and missed else ""))
        total = sum(len(found) for found in files.values())
        ran = sum(sum(times > 0 for times in found.values()) for found in files.values())
        print(f"{percent(ran, total)}  {folder} ({ran} of {total} lines)")


if __name__ == "__main__":
    main()
