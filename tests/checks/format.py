# SPDX-License-Identifier: MIT
"""Every source file is as clang-format 14 leaves it (other versions disagree in places)."""
import os
import re
import subprocess
import sys

import tree

SKIPPED = 77
VERSION = "14"


def main():
    tool = sys.argv[1]
    try:
        answer = subprocess.run([tool, "--version"], capture_output=True, text=True, check=True).stdout
    except OSError:
        answer = ""
    if not re.search(rf"version {VERSION}\.", answer):
        print(f"needs clang-format {VERSION}, found: {answer.strip() or 'none'}")
        sys.exit(SKIPPED)

    paths = tree.walk(tree.SOURCE_FOLDERS, tree.CPP)
    result = subprocess.run([tool, "--dry-run", "-Werror", *paths], cwd=tree.ROOT,
                            stderr=subprocess.PIPE, text=True)
    places = re.findall(r"^(\S+?:\d+):\d+: error", result.stderr, re.MULTILINE)
    if result.returncode:
        print(*dict.fromkeys(places), sep="\n")
        print(f"To repair: {os.path.basename(tool)} -i FILES")
    print(f"{len(paths)} files checked, {len(set(places))} lines differ")
    sys.exit(result.returncode)


if __name__ == "__main__":
    main()
