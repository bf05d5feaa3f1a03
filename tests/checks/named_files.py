# SPDX-License-Identifier: MIT
"""Files that documents name are there. Looked at are the targets of links, and words in code marks:
a path from the root, or from core/src; and in tables of docs/architecture.md and docs/solver.md a
bare name beside a path, which is in the folder of that path. The ending may be left out."""
import glob
import os
import re

import tree

LINK = re.compile(r"\]\(([^)#\s]+)(?:#[^)]*)?\)")
CODE = re.compile(r"`([^`\n]+)`")
PATH = re.compile(r"[a-z][\w.-]*(?:/[a-z0-9_.-]+)+/?$|[a-z][\w-]*/$")
BARE = re.compile(r"[a-z][a-z0-9_]*$")
# Tables in which bare names are files.
WITH_BARE_NAMES = ("docs/architecture.md", "docs/solver.md")
# From where a path may start.
ROOTS = ("", "core/src", "core", "core/include", "core/lcp/include", "core/c/include", "bullet_adapter/include", "bench")
# What programs write.
MADE = re.compile(r"(out|build|frames)/|.*\b(json|html|cairn|png)$")


def there(path):
    path = os.path.join(tree.ROOT, path)
    return os.path.exists(path) or bool(glob.glob(glob.escape(path.rstrip("/")) + ".*"))


def find(path):
    """The path from the root, or None."""
    return next((full for full in (os.path.join(root, path) for root in ROOTS) if there(full)), None)


def broken_links(page, text):
    folder = os.path.dirname(page)
    for target in LINK.findall(text):
        if not re.match(r"[a-z]+:", target) and not there(os.path.normpath(os.path.join(folder, target))):
            yield f"{page}: a link to {target}, which is not there"


def is_ours(path):
    """Whether it starts as a path of this project does: else it may be of another, or a quotient."""
    first = path.split("/")[0]
    return any(os.path.isdir(os.path.join(tree.ROOT, root, first)) for root in ROOTS)


def broken_names(page, text):
    bare_names = page in WITH_BARE_NAMES
    for line in text.splitlines():
        for cell in line.split("|") if line.startswith("|") else [line]:
            folder = None
            for word in CODE.findall(cell):
                if PATH.match(word) and is_ours(word) and not MADE.match(word):
                    full = find(word)
                    if full is None:
                        yield f"{page}: {word}, which is not there"
                    folder = full and (full.rstrip("/") if word.endswith("/") else os.path.dirname(full))
                elif bare_names and folder and line.startswith("|") and BARE.match(word):
                    if not any(there(os.path.join(near, word)) for near in (folder, os.path.dirname(folder))):
                        yield f"{page}: {word} beside {folder}, which is not there"


def main():
    pages = [name for name in os.listdir(tree.ROOT) if name.endswith(".md")]
    pages += [path for path in tree.walk(("docs",)) if path.endswith(".md")]
    errors, count = [], 0
    for page in sorted(pages):
        text = tree.read(page)
        errors += broken_links(page, text)
        if page != "CHANGELOG.md":  # history names what was
            errors += broken_names(page, text)
        count += 1
    tree.finish(errors, count)


if __name__ == "__main__":
    main()
