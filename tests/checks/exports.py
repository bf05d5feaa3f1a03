# SPDX-License-Identifier: MIT
"""Shared libraries show their public interface and nothing else, have their version in their name, stay when they are
closed, do nothing when they are loaded, keep no global but those of a list, and still have the names that
cmake/exports/*.abi has:
exports.py BUILD [--users BUILD] [--write], of a build with -DBUILD_SHARED_LIBS=ON -DCAIRN_TESTS=OFF. --users names a
build of static libraries and of the tools: what its tools take from a library, the shared one must show. --write keeps
the names of this build there (abigail-tools); without debug information these are names, not the layout of structs."""
import argparse
import glob
import os
import re
import subprocess
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))

# Names that users may count on, by library; what is of CAIRN_PRIVATE they cannot link by accident.
SHOWN = {
    "cairn": r"cairn::(?!simd::|lcp::|\(anonymous)",
    "cairn-lcp": r"cairn::lcp::",
    "cairn-bullet": r"(typeinfo( name)?|vtable) for cairn::bullet::|cairn::bullet::",
    "cairn-bullet-float64": r"(typeinfo( name)?|vtable) for cairn::bullet::|cairn::bullet::",
    "cairn-c": r"cairn[A-Z]\w+$",
}
# At most so many functions.
MOST = {"cairn": 85, "cairn-lcp": 30, "cairn-bullet": 75, "cairn-bullet-float64": 75, "cairn-c": 65}
# All storage of Cairn's that can be written and outlives a call, by the end of its name: constants that are found when
# they are first asked for, the jobs that oneTBB may still hold, and whose memory a thread takes while it is in a call.
GLOBALS = ("::usable", "::kKernel", "::kKernels", "ConstraintSolver::recorded() const::none",
           "Jobs::OfProcess()::jobs", "::memory_of_thread")
# Versions of names that nobody was promised.
UNPROMISED = ("CAIRN_DETAIL", "CAIRN_PRIVATE")


def run(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def public_names(path):
    """Demangled names that are defined, without those nobody was promised and the names of versions."""
    lines = [line.split(" ", 2) for line in run("nm", "-DC", "--defined-only", path).splitlines()]
    names = [fields[2] for fields in lines if fields[1] != "A"]
    return [re.sub(r"@@?CAIRN_[\d.]+$", "", name) for name in names if not name.endswith(UNPROMISED)]


def describe(path, names):
    """What docs/everywhere.md has of a library."""
    inner = sum(name.startswith("cairn::detail::") for name in names)
    defined = run("nm", "-D", "--defined-only", path).splitlines()
    others = ", ".join(f"{sum(f'@@{version}' in line for line in defined)} {version}" for version in UNPROMISED)
    return f"{os.path.basename(path)}: {len(names)} names, {inner} of them of detail; {others}; " \
           f"{os.path.getsize(path) / 1e6:.2f} MB"


def initialisers(path):
    """Functions that are called when the library is loaded, but for the compiler's own."""
    size = re.search(r"INIT_ARRAYSZ\)\s+(\d+)", run("readelf", "-dW", path))
    return int(size.group(1)) // 8 - 1 if size else 0


def unknown_globals(path):
    """Storage that can be written, without what headers of others and the compiler bring."""
    symbols = re.findall(r"\s\.t?(?:bss|data)\s+\w+\s+(?:\.hidden )?(.*)", run("objdump", "-tC", path))
    return [name for name in symbols if name.startswith("cairn") and not name.endswith(GLOBALS)]


def check(path):
    library = re.match(r"lib([\w-]+)\.so", os.path.basename(path)).group(1)
    errors = []
    names = public_names(path)
    for name in names:
        if not re.match(SHOWN[library], name):
            errors.append(f"{library}: shows {name}")
    if not 0 < len(names) <= MOST[library]:
        errors.append(f"{library}: shows {len(names)} names, expected at most {MOST[library]}")
    if initialisers(path) > 0:
        errors.append(f"{library}: runs {initialisers(path)} functions when it is loaded")
    if not re.search(rf"SONAME.*\[lib{library}\.so\.\d+\.\d+\]", run("readelf", "-dW", path)):
        errors.append(f"{library}: no version in its soname")
    if "NODELETE" not in run("readelf", "-dW", path):
        errors.append(f"{library}: may be unloaded while threads are in it")
    errors += [f"{library}: keeps a global, {name}" for name in unknown_globals(path)]
    errors += [f"{library}: {line}" for line in removed(path)]
    return describe(path, names), errors


def kept_names(path):
    library = os.path.basename(path).split(".")[0]
    return os.path.join(ROOT, "cmake", "exports", library + ".abi")


def write(path):
    """Keeps the names of a library, but for those nobody was promised."""
    lines = run("abidw", "--no-corpus-path", path).splitlines()
    with open(kept_names(path), "w", encoding="utf-8") as file:
        file.write("\n".join(line for line in lines if not any(version in line for version in UNPROMISED)) + "\n")


def removed(path):
    """What a library showed, and shows no longer."""
    if not os.path.exists(kept_names(path)):
        return []
    said = subprocess.run(["abidiff", "--no-added-syms", kept_names(path), path], capture_output=True, text=True)
    return said.stdout.splitlines() if said.returncode != 0 else []


def symbols(option, paths):
    """Mangled names of object files, archives or shared libraries, without their versions."""
    return {line.split()[0].split("@")[0] for line in run("nm", "-P", option, *paths).splitlines() if " " in line}


def hidden_from_tools(paths, users, build):
    """What the tools of another build take from its static libraries, and these shared ones do not show. Benchmarks of
    single functions (bench/micro) are not built with shared libraries."""
    objects = [path for path in glob.glob(os.path.join(users, "bench", "**", "*.o"), recursive=True)
               if f"{os.sep}micro{os.sep}" not in path]
    if not objects:
        return [f"{users}: has no object files of tools"]
    taken = symbols("-u", objects)
    errors = []
    for path in paths:
        library = os.path.basename(path).split(".")[0]
        beside = os.path.join(users, os.path.relpath(os.path.dirname(path), build), library)
        if os.path.exists(beside + ".so"):
            continue  # Shared in every build, so tools were linked with it.
        if not os.path.exists(beside + ".a"):
            errors.append(f"{beside}.a: is not there")
            continue
        hidden = (taken & symbols("--defined-only", [beside + ".a"])) - symbols("-D", [path])
        errors += [f"{library}: does not show {name}, which tools take" for name in sorted(hidden)]
    return errors


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("build")
    parser.add_argument("--users")
    parser.add_argument("--write", action="store_true")
    asked = parser.parse_args()
    paths = sorted(glob.glob(os.path.join(asked.build, "**", "libcairn*.so"), recursive=True))
    if asked.write:
        for path in paths:
            write(path)
    results = {os.path.basename(path): check(path) for path in paths}
    errors = [error for _, errors in results.values() for error in errors]
    if asked.users:
        errors += hidden_from_tools(paths, asked.users, asked.build)
    for error in errors:
        print(error)
    for described, _ in results.values():
        print(described)
    print(f"{len(results)} libraries, {len(errors)} errors")
    sys.exit(1 if errors or not results else 0)


if __name__ == "__main__":
    main()
