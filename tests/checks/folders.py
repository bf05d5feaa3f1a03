# SPDX-License-Identifier: MIT
"""No folder holds more files than a reader takes in at a glance; folders in it do not count."""
import collections
import os

import tree

MOST_FILES = 25


def main():
    counts = collections.Counter(os.path.dirname(path) for path in tree.walk(tree.TEXT_FOLDERS))
    tree.finish([f"{folder}: {count} files, more than {MOST_FILES}; sort them by subject"
                 for folder, count in sorted(counts.items()) if count > MOST_FILES], len(counts))


if __name__ == "__main__":
    main()
