# SPDX-License-Identifier: MIT
"""The cairn tool on files and command lines that are nearly right:
  python3 tool_fuzz.py PATH_OF_CAIRN [--runs N] [--seed N] [--minutes N] [matrix|compare|command ...]
Whatever comes, it ends within 10 s, by no signal, and an error is one line on stderr that names the
file or what of the command is wrong. The same seed makes the same inputs. What breaks a promise is
kept in build/fuzz/tool."""
import argparse
import copy
import json
import os
import random
import resource
import shlex
import shutil
import subprocess
import sys
import tempfile
import time

ROOT = os.path.normpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
sys.path.insert(0, os.path.join(ROOT, "tests", "bench", "tool"))
import solve_cli_test  # noqa: E402

KEPT = os.path.join(ROOT, "build", "fuzz", "tool")
MOST_SECONDS = 10
MOST_BYTES = 4 << 30  # of memory, so that a count in a file can ask for too much
# What each command may end with: fine, found something, usage, bad input.
CODES = range(4)
ERRORS = (2, 3)

NUMBERS = ["0", "-1", "1", "0.5", "nan", "inf", "-inf", "1e308", "1e999", "-1e308", "1e-320", "3.4e38",
           "2147483648", "-2147483649", "99999999999999999999", "1.", ".", "e5", "0x10", "1,5", "+1", ""]
WORDS = NUMBERS + ["x", "%", "{", "}", "[", "]", "\"", "\\", "\n", " ", "\0", "\x7f", "\u00e9", "null",
                   "symmetric", "general", "array", "coordinate", "pattern", "complex", "real"]
VALUES = [None, True, False, 0, -1, 1, 0.5, 1e308, -1e308, 2**31, 2**63, 2**64, 10**30, 1e-320, "", "x",
          "nan", [], {}, [[]], [None], [1, 2], {"x": 1}, float("nan"), float("inf"), "\u0000", "a" * 5000]
# Command lines of less than a second. {matrix}, {run}: files that are right.
LINES = [
    "doctor --json d.json",
    "list scenes --json", "list solvers", "list problems --json",
    "run tower --size 3 --frames 6 --samples 1 --quiet",
    "run chain --size 3 --frames 6 --samples 1 --solver cairn,bullet-si@5 --budget 1ms --json r.json",
    "run wall --size 2 --frames 4 --samples 0 --warmup 1 --repeat 2 --threads 1 --csv r.csv --quiet",
    "run tower --size 2 --frames 4 --samples 1 --seed 3 --simd scalar --markdown r.md --noise --quiet",
    "run tower --size 2 --frames 4 --samples 1 --trace t.json --trace-frame 2 --report p.html --quiet",
    "run --import {matrix}/q.mtx --frames 2 --quiet",
    "solve {matrix} --solver pgs,pgs-sm --errors none --max-sweeps 20 --quiet",
    "solve {matrix} --errors all --repeat 1 --history h.csv --plot p.svg --budget 5ms --quiet",
    "solve journal-bearing --size 4 --set eccentricity=0.5 --tolerance 1e-4 --max-sweeps 50 --json s.json",
    "solve {matrix} --order coloured --threads 1 --k-gs 3 --k-sm 1 --omega 1.2 --start zero --phases",
    "solve {matrix} --solution x --export e --csv s.csv --progress never",
    "compare {run} {run} --threshold 5% --error-threshold 10 --json c.json",
    "record tower --size 2 --frames 2 -o rec --solver cairn --iterations 3 --quiet",
    "worlds --seeds 0:1 --seconds 0.05 --solver cairn --scale 0.2 --jobs 1 --json w.json --quiet",
    "worlds --seed 3 --seconds 0.05 --scale 0.2 --audit --bits --progress never",
    "worlds --list",
]


class Broken(Exception):
    pass


class Tool:
    def __init__(self, path):
        self.path = os.path.abspath(path)

    def run(self, arguments, folder):
        """(exit code, stderr); Broken if it takes too long, or dies."""
        def limit():
            resource.setrlimit(resource.RLIMIT_AS, (MOST_BYTES, MOST_BYTES))
            resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        try:
            result = subprocess.run([self.path, *arguments], cwd=folder, capture_output=True,
                                    timeout=MOST_SECONDS, preexec_fn=limit, stdin=subprocess.DEVNULL,
                                    check=False)
        except subprocess.TimeoutExpired as error:
            raise Broken("takes longer than 10 s") from error
        errors = result.stderr.decode("utf-8", "replace")
        if result.returncode not in CODES:
            raise Broken(f"ends with {result.returncode}: {errors[-500:]}")
        if result.returncode in ERRORS and not errors.startswith("cairn: "):
            raise Broken(f"ends with {result.returncode} and says {errors[-500:]!r}")
        return result.returncode, errors


def mutate_text(text, source):
    """A few changes of bytes, numbers and lines."""
    for _ in range(source.choice((1, 1, 1, 2, 3, 8))):
        at = source.randrange(len(text) + 1)
        kind = source.randrange(9)
        if kind == 0:
            text = text[:at]
        elif kind == 1:
            text = text[:at] + source.choice(WORDS).encode() + text[at:]
        elif kind == 2:
            text = text[:at] + text[at + source.randrange(1, 9):]
        elif kind == 3 and text:
            at = min(at, len(text) - 1)
            text = text[:at] + bytes([text[at] ^ 1 << source.randrange(8)]) + text[at + 1:]
        elif kind == 4:
            text = text[:at] + bytes(source.randrange(256) for _ in range(source.randrange(1, 20))) + text[at:]
        elif kind == 5:
            other = source.randrange(len(text) + 1)
            text = text[:at] + text[min(at, other):max(at, other)] + text[at:]
        elif kind in (6, 7):
            words = text.split(b" ") if kind == 6 else text.split(b"\n")
            words[source.randrange(len(words))] = source.choice(NUMBERS).encode()
            text = (b" " if kind == 6 else b"\n").join(words)
        else:
            lines = text.split(b"\n")
            source.shuffle(lines)
            text = b"\n".join(lines)
        text = text[:1 << 20]
    return text


def places(value, path=()):
    """The ways to all members of a JSON value."""
    yield path
    members = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, member in members:
        yield from places(member, path + (key,))


def mutate_json(value, source):
    value = copy.deepcopy(value)
    for _ in range(source.choice((1, 1, 1, 2, 4))):
        ways = [way for way in places(value) if way]
        if not ways:
            return value
        # as often near the root as at the many leaves
        deepest = source.randrange(1, 9)
        way = source.choice([way for way in ways if len(way) <= deepest])
        parent = value
        for key in way[:-1]:
            parent = parent[key]
        key, kind = way[-1], source.randrange(6)
        if kind == 0:
            del parent[key]
        elif kind == 1 and isinstance(parent, list):
            parent.insert(key, copy.deepcopy(parent[key]))
        elif kind == 2 and isinstance(parent, dict):
            parent[source.choice((key + "x", "", "name"))] = parent.pop(key)
        elif kind == 3 and isinstance(parent[key], (int, float)):
            parent[key] *= source.choice((-1, 0, 1e-9, 1e9, 1e300))
        else:
            parent[key] = copy.deepcopy(source.choice(VALUES))
    return value


def read_json(path):
    """What is in a JSON file, None if it is none or was changed before so that it is no longer."""
    if not path.endswith(".json"):
        return None
    try:
        with open(path, encoding="utf-8") as file:
            return json.load(file)
    except ValueError:
        return None


def mutate_file(path, source):
    """Its bytes, its JSON, or what it is at all."""
    kind = source.randrange(40)
    if kind == 0:
        os.remove(path)
    elif kind == 1:
        os.remove(path)
        os.mkdir(path)
    elif kind == 2:
        os.remove(path)
        os.symlink("nowhere", path)
    elif kind < 30 and (value := read_json(path)) is not None:
        with open(path, "w", encoding="utf-8") as file:
            json.dump(mutate_json(value, source), file)
    else:
        with open(path, "rb") as file:
            text = file.read()
        with open(path, "wb") as file:
            file.write(mutate_text(text, source))


def write_matrices(folder):
    stack = solve_cli_test.STACK
    solve_cli_test.write_problem(folder, "stack", stack, [-1.0, 0.0], solution=[2.0, 1.0], w=[0.0, 0.0],
                                 reference={"unique_solution": True})
    solve_cli_test.write_problem(folder, "boxed", stack, [-1.0, 0.0], kind="boxqp", lower=[-1.0, 0.0],
                                 upper=[1.0, 1e300])
    solve_cli_test.write_problem(folder, "string", *solve_cli_test.string_problem(12))


class Matrix:
    def __init__(self, tool, folder):
        self.tool, self.seeds = tool, os.path.join(folder, "matrices")
        write_matrices(self.seeds)

    def run(self, source, folder):
        name = source.choice(sorted(os.listdir(self.seeds)))
        problem = shutil.copytree(os.path.join(self.seeds, name), os.path.join(folder, name))
        for _ in range(source.choice((1, 1, 1, 2))):
            files = [entry.path for entry in sorted(os.scandir(problem), key=lambda e: e.name)
                     if entry.is_file(follow_symlinks=False)]
            if files:
                mutate_file(source.choice(files), source)
        arguments = ["solve", problem, "--max-sweeps", "200", "--budget", "100ms", "--quiet"]
        code, errors = self.tool.run(arguments, folder)
        if code in ERRORS and name not in errors:
            raise Broken(f"does not name {name}: {errors}")


class Compare:
    def __init__(self, tool, folder):
        self.tool, self.seed = tool, os.path.join(folder, "run.json")
        code, errors = tool.run(["run", "tower", "wall", "--size", "2", "--frames", "6", "--warmup", "1",
                                 "--samples", "1", "--repeat", "2", "--solver", "bullet-si,cairn", "--quiet",
                                 "--json", self.seed], folder)
        assert code == 0, errors

    def run(self, source, folder):
        for name in ("old.json", "new.json"):
            shutil.copy(self.seed, os.path.join(folder, name))
        changed = source.choice((["new.json"], ["new.json"], ["old.json"], ["old.json", "new.json"]))
        for name in changed:
            mutate_file(os.path.join(folder, name), source)
        code, errors = self.tool.run(["compare", "old.json", "new.json"], folder)
        named = any(name in errors for name in ("old.json", "new.json", "scene", "solver", "run"))
        if code in ERRORS and not named:
            raise Broken(f"names neither file nor what of it: {errors}")


class Command:
    def __init__(self, tool, folder):
        self.tool = tool
        self.names = {"matrix": os.path.join(folder, "matrices", "stack"),
                      "run": os.path.join(folder, "run.json")}
        Matrix(tool, folder)
        Compare(tool, folder)

    def run(self, source, folder):
        words = source.choice(LINES).format(**self.names).split()
        for _ in range(source.choice((1, 1, 2, 4))):
            at = source.randrange(len(words)) if words else 0
            kind = source.randrange(7)
            if kind == 0:
                del words[at:at + 1]
            elif kind == 1:
                words[at:at + 1] = [source.choice(WORDS).replace("\0", "")]
            elif kind == 2:
                words.insert(at, source.choice(WORDS).replace("\0", ""))
            elif kind == 3:
                words.insert(at, source.choice(source.choice(LINES).format(**self.names).split()))
            elif kind == 4 and words:
                text = mutate_text(os.fsencode(words[at]), source).replace(b"\0", b"")
                # more digits are more work, which may be asked for
                words[at] = os.fsdecode(text[:len(words[at]) if words[at].isdigit() else 200])
            elif kind == 5:
                words.insert(at, words[at] if words else "")
            else:
                source.shuffle(words)
        words = [word for word in words if not word.startswith("/") or "/matrices/" in word or "run.json" in word]
        self.line = " ".join(shlex.quote(word) for word in words)
        with open(os.path.join(folder, "command"), "w", encoding="utf-8", errors="surrogateescape") as file:
            file.write(self.line + "\n")
        self.tool.run(words, folder)


KINDS = {"matrix": Matrix, "compare": Compare, "command": Command}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("cairn")
    parser.add_argument("kinds", nargs="*", choices=[[], *KINDS], help="default: all")
    parser.add_argument("--runs", type=int, default=1000, help="of each kind")
    parser.add_argument("--seed", type=int, default=0, help="of the first one")
    parser.add_argument("--minutes", type=float, default=1e9, help="for each kind at most")
    options = parser.parse_args()
    findings = 0
    for name in options.kinds or KINDS:
        with tempfile.TemporaryDirectory() as base:
            kind = KINDS[name](Tool(options.cairn), base)
            begin, runs = time.monotonic(), 0
            for seed in range(options.seed, options.seed + options.runs):
                if time.monotonic() - begin > 60 * options.minutes:
                    break
                folder = os.path.join(base, "now")
                os.mkdir(folder)
                runs += 1
                try:
                    kind.run(random.Random(f"{name} {seed}"), folder)
                except Broken as broken:
                    findings += 1
                    kept = os.path.join(KEPT, f"{name}-{seed}")
                    shutil.rmtree(kept, ignore_errors=True)
                    shutil.copytree(folder, kept, symlinks=True)
                    print(f"{name}, seed {seed}: {broken}\n  kept in {os.path.relpath(kept, ROOT)}")
                shutil.rmtree(folder)
            print(f"{name}: {runs} inputs in {time.monotonic() - begin:.0f} s")
    print(f"{findings} findings")
    sys.exit(findings > 0)


if __name__ == "__main__":
    main()
