# SPDX-License-Identifier: MIT
"""Programs shown in README.md and docs/ are the ones that are compiled: each ```cpp or ```c block after a
comment <!-- FILE PART --> equals what FILE has between its lines // [PART] and // [/PART].
Without PART it is the whole file below its licence line. A tutorial shows all parts of its program,
each once and in their order, so that its blocks put together are the program. It is short."""
import re

import tree

BLOCK = re.compile(r"<!-- (\S+\.cc?)(?: (\w+))? -->\n+```(?:cpp|c)\n(.*?)```", re.DOTALL)
# Page -> the program that it shows all of, and how many lines that may have, all together.
TUTORIALS = {"docs/engine.md": ("examples/engine.cc", 150)}
PART = re.compile(r"// \[(\w+)\]\n(.*?)[ ]*// \[/\1\]\n", re.DOTALL)
AROUND = re.compile(r"(// SPDX-License-Identifier: .*|)")
MUST_SHOW = ("README.md", "docs/c.md", "docs/engine.md", "docs/matrix.md")


def shown_part(path, part):
    text = tree.read(path)
    if not part:
        return text.split("\n", 1)[1]
    found = re.search(rf"// \[{part}\]\n(.*?)[ ]*// \[/{part}\]", text, re.DOTALL)
    return found.group(1) if found else None


def tutorial_errors(page, path, limit):
    source = tree.read(path)
    shown = [part for file, part, _ in BLOCK.findall(tree.read(page)) if file == path]
    parts = dict(PART.findall(source))
    errors = [f"{page} does not show {part} of {path}" for part in parts if part not in shown]
    if not errors and shown != list(parts):
        errors.append(f"{page} shows {', '.join(shown)}, but {path} has {', '.join(parts)}")
    errors += [f"{path}: in no part: {line}" for line in PART.sub("", source).splitlines()
               if not AROUND.fullmatch(line)]
    lines = sum(text.count("\n") for text in parts.values())
    if lines > limit:
        errors.append(f"{path}: {lines} lines, may be {limit}")
    return errors


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
    for page, (path, limit) in TUTORIALS.items():
        errors += tutorial_errors(page, path, limit)
    tree.finish(errors, count)


if __name__ == "__main__":
    main()
