# SPDX-License-Identifier: MIT
"""Builds the documents as a site in build/site, with mkdocs, doxygen for the public headers, and nothing from the
network, and checks that every link of every page leads to a file and a heading that are there."""
import html.parser
import os
import re
import shutil
import subprocess
import sys
import urllib.parse

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
SOURCE, SITE = os.path.join(ROOT, "build", "site-source"), os.path.join(ROOT, "build", "site")
LINK = re.compile(r"(\]\()([^)#\s]+)(#[^)]*)?(\))")
# doxygen leads to a list of nested classes that it leaves out where all of them are private.
OF_PRIVATE_CLASSES = "#nested-classes"
HEADERS = ("core", "core/c", "core/lcp", "bullet_adapter")
# Files that are read as they stand: shown as text.
TEXT = (".cc", ".h", ".c", ".py", ".sh", ".json", ".txt", ".in", ".cmake")


def linked_file(page, target):
    """Path from the root of what a page of the repository links to; None for other sites."""
    if re.match(r"[a-z]+:", target):
        return None
    return os.path.normpath(os.path.join(os.path.dirname(page), target))


def copy_page(page):
    """Copies a page; folders and sources it links to become files of the site."""
    with open(os.path.join(ROOT, page), encoding="utf-8") as file:
        text = file.read()

    def point(match):
        path = linked_file(page, match.group(2))
        if path is None:
            return match.group(0)
        full = os.path.join(ROOT, path)
        if os.path.isdir(full):
            return match.group(1) + listing(path, page) + match.group(4)
        if path.endswith(TEXT) or not path.endswith((".md", ".png", ".svg")):
            return match.group(1) + as_text(path, page) + match.group(4)
        if path == "README.md":
            return match.group(1) + relative("index.md", page) + (match.group(3) or "") + match.group(4)
        if not path.endswith(".md"):
            copy_file(path)
        return match.group(0)

    target = "index.md" if page == "README.md" else page
    write(target, LINK.sub(point, text))


def relative(path, page):
    return os.path.relpath(path, os.path.dirname(page) or ".").replace(os.sep, "/")


def write(path, text):
    full = os.path.join(SOURCE, path)
    os.makedirs(os.path.dirname(full), exist_ok=True)
    with open(full, "w", encoding="utf-8") as file:
        file.write(text)


def copy_file(path):
    full = os.path.join(SOURCE, path)
    os.makedirs(os.path.dirname(full), exist_ok=True)
    shutil.copyfile(os.path.join(ROOT, path), full)


def as_text(path, page):
    with open(os.path.join(ROOT, path), encoding="utf-8") as file:
        write("files/" + path + ".txt", file.read())
    return relative("files/" + path + ".txt", page)


def listing(path, page):
    names = sorted(os.listdir(os.path.join(ROOT, path)))
    write("files/" + path + "/list.txt", path + "\n\n" + "\n".join(names) + "\n")
    return relative("files/" + path + "/list.txt", page)


def describe_headers():
    """The public headers in api/, and a page that leads there."""
    with open(os.path.join(ROOT, "packaging", "Doxyfile"), encoding="utf-8") as file:
        settings = file.read()
    headers = " ".join(f'"{os.path.join(ROOT, path, "include")}"' for path in HEADERS)
    settings += f'INPUT = {headers}\nSTRIP_FROM_PATH = {headers}\nOUTPUT_DIRECTORY = "{SOURCE}"\n'
    done = subprocess.run(["doxygen", "-"], input=settings, capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(done.stderr)
    write("headers.md", "# Public headers\n\n"
          "- [Structs and classes](api/annotated.html), with the unit and range of each field\n"
          "- [By header](api/files.html)\n"
          "- [Functions and constants](api/namespacemembers.html)\n")
    return done.stderr.splitlines()


class Page(html.parser.HTMLParser):
    def __init__(self):
        super().__init__()
        self.links, self.names = [], set()

    def handle_starttag(self, tag, attributes):
        values = dict(attributes)
        self.names.update(values[key] for key in ("id", "name") if values.get(key))
        self.links += [values[key] for key in ("href", "src") if values.get(key)]


def dead_links():
    pages = {}
    for folder, _, names in os.walk(SITE):
        for name in names:
            if name.endswith(".html"):
                path = os.path.join(folder, name)
                pages[path] = Page()
                with open(path, encoding="utf-8") as file:
                    pages[path].feed(file.read())
    errors, checked, outside = [], 0, set()
    for path, page in pages.items():
        if os.path.basename(path) == "404.html":
            continue
        for link in page.links:
            parts = urllib.parse.urlsplit(link)
            if parts.scheme or parts.netloc:
                outside.add(link)
                continue
            if link == OF_PRIVATE_CLASSES and os.sep + "api" + os.sep in path:
                continue
            checked += 1
            target = os.path.normpath(os.path.join(os.path.dirname(path), urllib.parse.unquote(parts.path))) \
                if parts.path else path
            if not os.path.exists(target):
                errors.append(f"{os.path.relpath(path, SITE)}: {link} is not there")
            elif parts.fragment and target in pages and parts.fragment not in pages[target].names:
                errors.append(f"{os.path.relpath(path, SITE)}: {link}: no such heading")
    return errors, checked, sorted(outside)


def main():
    shutil.rmtree(SOURCE, ignore_errors=True)
    pages = ["README.md", "CHANGELOG.md", "CONTRIBUTING.md", "SECURITY.md", "THIRD_PARTY.md"]
    for folder, _, names in os.walk(os.path.join(ROOT, "docs")):
        pages += [os.path.relpath(os.path.join(folder, name), ROOT) for name in names if name.endswith(".md")]
    for page in pages:
        copy_page(page)
    complaints = describe_headers()
    for complaint in complaints:
        print(complaint)
    subprocess.run(["mkdocs", "build", "--quiet", "--clean", "-f", os.path.join(ROOT, "packaging", "mkdocs.yml")],
                   check=True)
    errors, checked, outside = dead_links()
    for error in errors:
        print(error)
    loaded = [link for link in outside if link.endswith((".js", ".css"))]
    print(f"{checked} links checked in {SITE}, {len(errors)} errors; {len(outside)} to other sites, "
          f"{len(loaded)} of them loaded by pages")
    sys.exit(1 if complaints or errors or loaded else 0)


if __name__ == "__main__":
    main()
