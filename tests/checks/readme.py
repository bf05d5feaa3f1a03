# SPDX-License-Identifier: MIT
"""Programs shown in README.md and docs/ are the ones that are compiled: each ```cpp block after a
comment <!-- FILE PART --> equals what FILE has between its lines // [PART] and // [/PART].
Without PART it is the whole file below its licence line."""
import re

import tree

BLOCK = re.compile(r"<!-- (\S+\.cc)(?: (\w+))? -->\n+```cpp\n(.*?)```", re.DOTALL)
MUST_SHOW = ("README.md", "docs/engine.md", "docs/matrix.md")


def shown_part(path, part):
    text = tree.read(path)
    if not part:
        return text.split("\n", 1)[1]
    found = re.search(rf"// \[{part}\]\n(.*?)[ ]*// \[/{part}\]", text, re.DOTALL)
    return found.group(1) if found else None


def main():
    pages = ["README.md"] + [path for path in tree.walk(("docs",)) if path.endswith(".md")]
    errors, count = [], 0
    for page in pages:
        blocks = BLOCK.findall(tree.read(page))
        count += len(blocks)
        if not blocks and page in MUST_SHOW:
            errors.append(f"{page} shows no program")
        for path, part, shown in blocks:
            if shown_part(path, part) != shown:
                errors.append(f"{page}: the block of {path} {part} differs from the file")
    tree.finish(errors, count)


if __name__ == "__main__":
    main()
