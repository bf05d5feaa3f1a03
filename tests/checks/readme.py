# SPDX-License-Identifier: MIT
"""The programs shown in README.md are the ones that are compiled: each ```cpp block after a comment
<!-- FILE --> equals the part of FILE between its lines // [readme] and // [/readme]."""
import re

import tree

BLOCK = re.compile(r"<!-- (\S+) -->\n+```cpp\n(.*?)```", re.DOTALL)


def shown_part(path):
    found = re.search(r"// \[readme\]\n(.*?)[ ]*// \[/readme\]", tree.read(path), re.DOTALL)
    return found.group(1) if found else None


def main():
    blocks = BLOCK.findall(tree.read("README.md"))
    errors = [] if blocks else ["README.md shows no program"]
    for path, shown in blocks:
        if shown_part(path) != shown:
            errors.append(f"README.md: the block of {path} differs from the file")
    tree.finish(errors, len(blocks))


if __name__ == "__main__":
    main()
