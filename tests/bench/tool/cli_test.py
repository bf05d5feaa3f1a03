# SPDX-License-Identifier: MIT
"""The cairn tool as its users meet it: python3 cli_test.py PATH_OF_CAIRN"""
import csv
import html.parser
import json
import os
import re
import subprocess
import sys
import tempfile
import unittest

TOOL = ""
FINE, USAGE, BAD_INPUT = 0, 2, 3
# A second of work at most, on a slow machine.
SMALL = ["run", "tower", "--size", "4", "--frames", "12", "--samples", "2"]


def cairn(*arguments, environment=None):
    return subprocess.run([TOOL, *arguments], capture_output=True, text=True, timeout=300,
                          env={**os.environ, **(environment or {})})


class CairnTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def path(self, name):
        return os.path.join(self.folder, name)

    def fine(self, *arguments, **others):
        result = cairn(*arguments, **others)
        self.assertEqual(result.returncode, FINE, result.stdout + result.stderr)
        self.assertEqual(result.stderr, "")
        return result.stdout

    def refused(self, code, *arguments):
        """The message, which is one line on stderr."""
        result = cairn(*arguments)
        self.assertEqual(result.returncode, code, result.stdout + result.stderr)
        self.assertEqual(result.stdout, "")
        self.assertEqual(result.stderr.count("\n"), 1, result.stderr)
        self.assertTrue(result.stderr.startswith("cairn: "), result.stderr)
        return result.stderr

    def run_json(self, *arguments):
        self.fine(*arguments, "--json", self.path("r.json"))
        with open(self.path("r.json"), encoding="utf-8") as file:
            return json.load(file)


class HelpTest(CairnTest):
    def test_help_names_every_command(self):
        text = self.fine("--help")
        for command in ("doctor", "list", "run", "compare", "play"):
            self.assertIn(command, text)

    def test_help_of_run_explains_budget_iterations_and_exit_codes(self):
        text = self.fine("run", "--help")
        for words in ("--budget", "--iterations fit", "bullet-si@50", "Exit codes"):
            self.assertIn(words, text)

    def test_help_names_scenes_once(self):
        self.assertIn("  scene SCENE ... ", self.fine("run", "--help"))

    def test_version_is_a_version(self):
        self.assertRegex(self.fine("--version"), r"^\d+\.\d+\.\d+\n$")

    def test_lists_have_a_line_for_each_name_and_the_same_names_as_json(self):
        for kind, known in (("scenes", "castle"), ("solvers", "bullet-dantzig")):
            lines = self.fine("list", kind).splitlines()
            names = [entry["name"] for entry in json.loads(self.fine("list", kind, "--json"))]
            self.assertEqual([line.split()[0] for line in lines], names)
            self.assertIn(known, names)

    def test_the_tool_alone_shows_what_there_is(self):
        self.assertEqual(self.fine(), self.fine("--help"))

    def test_help_is_a_command_too(self):
        self.assertEqual(self.fine("help"), self.fine("--help"))
        self.assertEqual(self.fine("help", "help"), self.fine("--help"))
        self.assertEqual(self.fine("help", "run", "small"), self.fine("run", "small", "--help"))
        self.assertEqual(self.fine("help", "run"), self.fine("run", "--help"))
        self.assertIn("unknown command 'nope'", self.refused(USAGE, "help", "nope"))

    def test_list_alone_lists_everything(self):
        text = self.fine("list")
        lists = json.loads(self.fine("list", "--json"))
        self.assertEqual(list(lists), ["scenes", "problems", "solvers"])
        for kind, entries in lists.items():
            self.assertEqual(entries, json.loads(self.fine("list", kind, "--json")))
            self.assertIn(self.fine("list", kind), text)

    def test_a_command_may_be_shortened(self):
        self.assertEqual(self.fine("li", "sce"), self.fine("list", "scenes"))


class RefusalTest(CairnTest):
    def test_an_unknown_scene_is_answered_with_the_nearest(self):
        message = self.refused(USAGE, "run", "castel")
        self.assertIn("unknown scene 'castel': did you mean 'castle'?", message)
        self.assertIn("cairn list scenes", message)

    def test_an_unknown_solver_is_answered_with_the_nearest(self):
        self.assertIn("'bullet-dantzig'",
                      self.refused(USAGE, "run", "tower", "--solver", "bullet-danzig"))

    def test_a_solver_of_another_command_is_named_with_what_is_near(self):
        message = self.refused(USAGE, "run", "tower", "--solver", "pgs")
        self.assertIn("'pgs' is a solver of cairn solve", message)
        self.assertIn("cairn-pgs comes nearest", message)
        self.assertIn("did you mean 'cairn-sweeps'",
                      self.refused(USAGE, "run", "tower", "--solver", "cairn-sweps"))

    def test_an_unknown_command_is_answered_with_the_nearest(self):
        self.assertIn("did you mean 'doctor'", self.refused(USAGE, "docter"))

    def test_an_unknown_option_is_answered_with_the_nearest(self):
        self.assertIn("did you mean '--frames'", self.refused(USAGE, "run", "tower", "--frmaes", "9"))

    def test_a_prefix_of_two_names_is_answered_with_both(self):
        message = self.refused(USAGE, "run", "tower", "--solver", "bullet")
        self.assertIn("bullet-si, bullet-nncg, bullet-dantzig", message)

    def test_no_scene_is_a_usage_error_that_says_where_scenes_are_listed(self):
        self.assertIn("cairn list scenes", self.refused(USAGE, "run"))

    def test_what_is_like_nothing_gets_no_suggestion(self):
        for words, all_of_them in ((("xyzzy",), "'cairn --help' shows all"),
                                   (("run", "xyzzy"), "'cairn list scenes' shows all"),
                                   (("run", "tower", "--xyzzy"), "'cairn run --help' shows all")):
            message = self.refused(USAGE, *words)
            self.assertIn("unknown", message)
            self.assertIn(all_of_them, message)
            self.assertNotIn("did you mean", message)

    def test_what_differs_in_every_other_letter_is_not_suggested(self):
        self.assertIn("did you mean 'car'?", self.refused(USAGE, "run", "cat"))
        message = self.refused(USAGE, "run", "small", "--size", "3")
        self.assertIn("unknown option '--size': 'cairn run small --help'", message)

    def test_an_unknown_option_before_the_command_is_named(self):
        for word in ("--bogus", "-v", "--"):
            self.assertEqual(self.refused(USAGE, word),
                             f"cairn: unknown option '{word}': 'cairn' shows what there is\n")
        for word, meant in (("--verison", "--version"), ("--flaot64", "--float64")):
            self.assertEqual(self.refused(USAGE, word, "run"),
                             f"cairn: unknown option '{word}': did you mean '{meant}'? 'cairn' shows "
                             "what there is\n")

    def test_an_option_of_a_command_comes_after_it(self):
        self.assertEqual(self.refused(USAGE, "--budget", "2ms", "run", "tower"),
                         "cairn: --budget comes after the command, as in 'cairn run tower --budget "
                         "2ms'; 'cairn' shows what there is\n")
        self.assertIn("'cairn solve slider --budget 2ms'",
                      self.refused(USAGE, "--budget=2ms", "solve", "slider"))

    def test_what_is_missing_is_named_with_an_example_and_where_help_is(self):
        for words, missing, example in (
                (("compare",), "OLD.json and NEW.json", "cairn compare old.json new.json"),
                (("compare", "a.json"), "NEW.json", "cairn compare old.json new.json"),
                (("solve",), "FILE or GENERATOR", "cairn solve slider"),
                (("record",), "SCENE, --frames and --out",
                 "cairn record tower --frames 40,90 --out folder"),
                (("record", "tower", "-o", "x"), "--frames",
                 "cairn record tower --frames 40,90 --out folder")):
            self.assertEqual(self.refused(USAGE, *words),
                             f"cairn: cairn {words[0]} needs {missing}, as in '{example}'; 'cairn "
                             f"help {words[0]}' says more\n")
        self.assertIn("as in 'cairn run tower'", self.refused(USAGE, "run"))
        self.assertIn("as in 'cairn worlds --seeds 0:100'; 'cairn help worlds' says more",
                      self.refused(USAGE, "worlds"))

    def test_an_option_without_its_value_is_explained(self):
        message = self.refused(USAGE, "run", "tower", "--size")
        self.assertIn("--size needs a value, such as '--size 10' (Size of the scene", message)
        self.assertIn("; 'cairn help run' says more", message)
        self.assertIn("such as '--solver cairn'",
                      self.refused(USAGE, "run", "tower", "--solver"))
        self.assertIn("'cairn help run small' says more",
                      self.refused(USAGE, "run", "small", "--frames"))
        self.assertIn("--quiet stands alone", self.refused(USAGE, "run", "tower", "--quiet=maybe"))
        self.assertIn("--float64 stands alone", self.refused(USAGE, "--float64=yes", "run", "tower"))

    def test_an_unknown_option_is_named_though_something_is_missing(self):
        self.assertIn("did you mean '--json'", self.refused(USAGE, "compare", "--jsn"))

    def test_a_budget_that_is_no_time_is_explained(self):
        for text, why in (("2", "no unit"), ("2mz", "'mz'"), ("-2ms", "not more than 0"),
                          ("0ms", "not more than 0"), ("2h", "'h'"), ("ms", "number"),
                          ("nans", "not more than 0"), ("61s", "too long")):
            message = self.refused(USAGE, "run", "tower", "--budget=" + text)
            self.assertIn(why, message, text)
            self.assertIn("such as 2ms", message)

    def test_a_budget_of_work_is_a_whole_number_of_units(self):
        for text in ("0units", "-3units", "1.5units", "units", "9999999999999units"):
            message = self.refused(USAGE, "run", "tower", "--budget=" + text)
            self.assertIn("such as 100000units", message, text)

    def test_numbers_out_of_range_are_explained(self):
        for option, text, allowed in (("--frames", "0", "from 1"), ("--frames", "ten", "from 1"),
                                      ("--size", "0", "size of tower"), ("--size", "999999", "to "),
                                      ("--samples", "-1", "from 0"), ("--seed", "x", "from 0"),
                                      ("--iterations", "0", "from 1")):
            message = self.refused(USAGE, "run", "tower", f"{option}={text}")
            self.assertIn(option, message)
            self.assertIn(allowed, message)

    def test_fitting_iterations_needs_a_budget_and_a_solver_that_iterates(self):
        self.assertIn("--budget", self.refused(USAGE, "run", "tower", "--iterations", "fit"))
        self.assertIn("keeps time itself",
                      self.refused(USAGE, "run", "tower", "--budget", "1ms", "--solver", "cairn@fit"))

    def test_a_solver_named_twice_is_refused(self):
        self.assertIn("twice", self.refused(USAGE, "run", "tower", "--solver", "cairn,cairn"))

    def test_a_file_that_cannot_be_written_is_refused_before_the_run_with_its_path(self):
        for option in ("--json", "--csv", "--markdown", "--report", "--trace"):
            path = self.path("missing/file")
            message = self.refused(BAD_INPUT, "run", "castle", "--frames", "100000", option, path)
            self.assertIn(path, message)


class OutputTest(CairnTest):
    """A full disk, a closed stdout, a folder without rights, a kill."""
    COMMANDS = (("list", "scenes"), ("list", "problems", "--json"), ("doctor", "--bullet"),
                ("--help",), ("run", "--help"), (*SMALL, "--quiet"),
                ("solve", "slider", "--size", "20", "--quiet"))

    def failed(self, command, stdout):
        result = subprocess.run(command, stdout=stdout, stderr=subprocess.PIPE, text=True,
                                timeout=300, shell=isinstance(command, str))
        self.assertEqual(result.returncode, BAD_INPUT, result.stderr)
        # what is large does not wait for the end
        self.assertRegex(result.stderr, "^cairn: cannot write (the output|to file)")

    def test_output_that_finds_the_disk_full_is_an_error(self):
        for arguments in self.COMMANDS:
            with open("/dev/full", "w", encoding="utf-8") as full:
                self.failed([TOOL, *arguments], full)

    def test_output_without_a_stdout_is_an_error(self):
        for arguments in self.COMMANDS:
            self.failed(f"'{TOOL}' {' '.join(arguments)} >&-", None)

    def test_a_file_that_finds_the_disk_full_is_an_error(self):
        result = cairn(*SMALL, "--json", "/dev/full")
        self.assertEqual(result.returncode, BAD_INPUT)
        self.assertIn("/dev/full", result.stderr)

    def test_a_file_in_a_folder_that_may_not_be_written_is_refused_before_the_run(self):
        os.mkdir(self.path("closed"), mode=0o500)
        if os.access(self.path("closed"), os.W_OK):
            self.skipTest("nothing is closed to this user")
        self.refused(BAD_INPUT, *SMALL, "--json", self.path("closed/r.json"))

    def test_a_run_that_is_killed_leaves_the_old_file_or_none(self):
        with open(self.path("old.json"), "w", encoding="utf-8") as file:
            file.write("old")
        for name in ("old.json", "new.json"):
            run = subprocess.Popen([TOOL, "run", "castle", "--frames", "100000", "--json",
                                    self.path(name)], stdout=subprocess.DEVNULL)
            with self.assertRaises(subprocess.TimeoutExpired):
                run.wait(timeout=1)
            run.kill()
            run.wait()
        with open(self.path("old.json"), encoding="utf-8") as file:
            self.assertEqual(file.read(), "old")
        self.assertEqual(os.listdir(self.folder), ["old.json"])

    def test_a_file_that_is_written_again_keeps_its_rights_and_its_links(self):
        with open(self.path("r.json"), "w", encoding="utf-8") as file:
            file.write("old")
        os.chmod(self.path("r.json"), 0o640)
        os.symlink(self.path("r.json"), self.path("link.json"))
        self.fine(*SMALL, "--json", self.path("link.json"))
        self.assertEqual(os.stat(self.path("r.json")).st_mode & 0o777, 0o640)
        self.assertTrue(os.path.islink(self.path("link.json")))
        with open(self.path("r.json"), encoding="utf-8") as file:
            json.load(file)
        self.assertEqual(sorted(os.listdir(self.folder)), ["link.json", "r.json"])


class RunTest(CairnTest):
    def test_a_budget_of_work_gives_the_same_frames_on_every_run(self):
        command = ("run", "pyramid", "--size", "8", "--frames", "30", "--samples", "0", "--solver",
                   "cairn,bullet-si", "--budget", "5000units")
        runs = [self.run_json(*command) for _ in range(2)]
        self.assertIn("budget 5000 units a frame", self.fine(*command))
        self.assertIsNone(runs[0]["budget_ms"])
        self.assertEqual(runs[0]["budget_units"], 5000)
        cairn_s, bullet_s = (solver for solver in runs[0]["scenes"][0]["solvers"])
        self.assertEqual((cairn_s["effort"], bullet_s["effort"]), ("5000 units", "10 iterations"))
        # a frame has 432 rows, and Bullet's iterations are not what ends it
        self.assertNotEqual(set(cairn_s["frames"]["iterations"]), {10})
        for frames in ("iterations", "residual_m_s", "steps_accepted"):
            values = [[solver["frames"][frames] for solver in run["scenes"][0]["solvers"]]
                      for run in runs]
            self.assertEqual(values[0], values[1], frames)
        self.assertIn("budget of time", self.refused(USAGE, *command, "--iterations", "fit"))

    def test_each_kind_of_file_is_written_and_can_be_read(self):
        out = self.fine(*SMALL, "--solver", "bullet-si,cairn", "--budget", "2ms",
                        *(word for kind in ("json", "csv", "markdown", "report")
                          for word in ("--" + kind, self.path(kind))))
        self.assertIn("bullet-si", out)

        with open(self.path("json"), encoding="utf-8") as file:
            result = json.load(file)
        self.assertEqual(result["schema_version"], 1)
        self.assertEqual(result["budget_ms"], 2)
        self.assertNotIn(self.folder, json.dumps(result), "no paths of this machine")
        self.assertIn("--json json", result["context"]["command"])
        for key in ("date", "host", "build", "noise"):
            self.assertIn(key, result["context"])
        scene = result["scenes"][0]
        self.assertEqual(len(scene["samples"]), 2)
        for solver in scene["solvers"]:
            self.assertIsNone(solver["failure"])
            self.assertEqual(len(solver["velocity_errors_m_s"]), 2)
            for values in solver["frames"].values():
                self.assertEqual(len(values), 12)

        with open(self.path("csv"), encoding="utf-8", newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual(len(rows), 2 * 12)
        self.assertEqual({row["solver"] for row in rows}, {"bullet-si", "cairn"})
        self.assertTrue(all(float(row["time_ms"]) > 0 for row in rows))

        with open(self.path("markdown"), encoding="utf-8") as file:
            self.assertRegex(file.read(), r"\n\| solver +\|")

    def test_the_page_is_whole_and_asks_for_nothing_from_outside(self):
        self.fine(*SMALL, "--solver", "bullet-si,cairn", "--budget", "2ms",
                  "--report", self.path("page.html"))
        with open(self.path("page.html"), encoding="utf-8") as file:
            page = file.read()
        open_tags = []

        class Checker(html.parser.HTMLParser):
            def handle_starttag(self, tag, attributes):
                names = dict(attributes)
                assert "src" not in names and "href" not in names, (tag, attributes)
                if tag != "meta":
                    open_tags.append(tag)

            def handle_endtag(self, tag):
                assert open_tags.pop() == tag, tag

            def handle_startendtag(self, tag, attributes):
                pass

        Checker().feed(page)
        self.assertEqual(open_tags, [])
        # what the tool wrote itself: without the scripts, whose text is not ours
        written = re.sub(r"(?s)<script>.*?</script>", "", page)
        self.assertNotIn("nan", written.lower().replace("nanoseconds", ""))

    def test_without_a_budget_two_runs_agree_to_the_last_bit(self):
        def results():
            # bullet-dantzig is one of the four: 4 boxes are 48 rows.
            scene = self.run_json(*SMALL, "--seed", "3", "--iterations", "7")["scenes"][0]
            return [(s["solver"], s["facts"], s["standing"], s["velocity_errors_m_s"],
                     s["frames"]["residual_m_s"], s["frames"]["iterations"])
                    for s in scene["solvers"]]

        first = results()
        self.assertEqual(len(first), 4)
        self.assertEqual(first, results())

    def test_seeds_make_different_scenes(self):
        facts = [self.run_json(*SMALL, "--seed", seed)["scenes"][0]["solvers"][0]["facts"]
                 for seed in ("1", "2")]
        self.assertNotEqual(*facts)

    def test_iterations_are_those_asked_for(self):
        scene = self.run_json(*SMALL, "--iterations", "7", "--solver",
                              "bullet-si,bullet-si@50,cairn,cairn-pgs@3")["scenes"][0]
        counts = {s["solver"]: s["summary"]["iterations_mean"] for s in scene["solvers"]}
        self.assertEqual(counts,
                         {"bullet-si": 7, "bullet-si@50": 50, "cairn": 7, "cairn-pgs@3": 3})

    def test_names_of_solvers_in_worlds_and_solve_are_taken(self):
        for typed in ("pgs-sm,cairn-sweeps@3", "cairn,pgs-nncg@3"):
            scene = self.run_json(*SMALL, "--solver", typed)["scenes"][0]
            self.assertEqual([s["solver"] for s in scene["solvers"]], ["cairn", "cairn-pgs@3"])
        self.assertIn("names cairn-pgs twice",
                      self.refused(USAGE, *SMALL, "--solver", "cairn-pgs,cairn-sweeps"))

    def test_substeps_share_the_iterations_and_have_no_error_of_a_state(self):
        scene = self.run_json(*SMALL, "--iterations", "20", "--seed", "1", "--solver",
                              "bullet-si,bullet-si-substeps4,bullet-pgs-mlcp")["scenes"][0]
        whole, parts, dense = scene["solvers"]
        self.assertEqual([s["summary"]["iterations_mean"] for s in (whole, parts, dense)],
                         [20, 20, 20])
        self.assertTrue(all(error is None for error in parts["velocity_errors_m_s"]))
        for others in (whole, dense):
            self.assertTrue(all(error is not None for error in others["velocity_errors_m_s"]))
        self.assertTrue(parts["standing"])
        self.assertNotEqual(parts["facts"], whole["facts"])

    def test_fitted_iterations_leave_the_default_where_there_is_time(self):
        scene = self.run_json(*SMALL, "--frames", "40", "--budget", "20ms", "--iterations", "fit",
                              "--solver", "bullet-si")["scenes"][0]
        self.assertGreater(scene["solvers"][0]["summary"]["iterations_mean"], 50)

    def test_overruns_are_counted(self):
        # No solver gets through 60 rows in a microsecond.
        scene = self.run_json(*SMALL, "--budget", "1us", "--solver", "bullet-si")["scenes"][0]
        summary = scene["solvers"][0]["summary"]
        self.assertEqual(summary["overruns"], summary["timed_frames"])

    def test_several_scenes_and_short_names_run_in_one_go(self):
        scenes = self.run_json("run", "heavy", "chain", "--frames", "4", "--size", "5",
                               "--solver", "cairn")["scenes"]
        self.assertEqual([scene["scene"] for scene in scenes], ["heavy-top", "chain"])

    def test_cairn_and_plain_sweeps_begin_from_the_same_state(self):
        # In the first frame, ten sweeps of Bullet and of Cairn differ by the order of the rows only.
        scene = self.run_json("run", "chain", "--frames", "1", "--samples", "0",
                              "--solver", "bullet-si,cairn-pgs")["scenes"][0]
        first, second = (s["frames"]["residual_m_s"][0] for s in scene["solvers"])
        self.assertAlmostEqual(first / second, 1, delta=0.5)


class TargetTest(CairnTest):
    """CAIRN_SIMD that cannot be had: Cairn takes the best target, and the tool says so once."""
    COMMANDS = ((*SMALL, "--quiet"), ("run", "small", "door", "--frames", "2", "--samples", "0"),
                ("solve", "slider", "--size", "20", "--solver", "pgs-sm", "--quiet"),
                ("record", "tower", "--frames", "1", "--force", "-o"),
                ("worlds", "--seed", "0", "--seconds", "0.05", "--quiet"))

    def warning(self, target, *arguments):
        result = cairn(*arguments, environment={"CAIRN_SIMD": target})
        self.assertEqual(result.returncode, FINE, result.stderr)
        return result.stderr

    def test_what_is_no_target_is_said_with_what_there_is(self):
        for command in self.COMMANDS:
            words = (*command, self.path("r")) if command[-1] == "-o" else command
            said = self.warning("avx9", *words)
            self.assertRegex(said, r"^cairn: CAIRN_SIMD='avx9' is no target, this CPU has: scalar[ \w]*; "
                                   r"Cairn takes \w+\n$", command)

    def test_a_target_of_other_cpus_is_said_likewise(self):
        targets = re.search("SIMD targets *(.*)", self.fine("doctor")).group(1).split()
        other = "avx2" if "neon" in targets else "neon"
        self.assertEqual(self.warning(other, *SMALL),
                         f"cairn: CAIRN_SIMD='{other}' does not run on this CPU, which has: "
                         f"{' '.join(targets)}; Cairn takes {targets[-1]}\n")

    def test_nothing_is_said_of_what_can_be_had_or_does_not_count(self):
        self.assertEqual(self.warning("scalar", *SMALL), "")
        self.assertEqual(self.warning("avx9", *SMALL, "--simd", "scalar"), "")
        self.assertEqual(self.warning("avx9", "list", "scenes"), "")


class TraceTest(CairnTest):
    def trace(self, *arguments):
        self.fine(*SMALL, "--solver", "bullet-si,cairn", "--trace", self.path("t.json"), *arguments)
        with open(self.path("t.json"), encoding="utf-8") as file:
            return json.load(file)

    @staticmethod
    def spans(trace, process):
        return [event for event in trace["traceEvents"]
                if event["ph"] == "X" and event["pid"] == process]

    def test_each_solver_is_a_process_whose_spans_lie_within_each_other(self):
        trace = self.trace()
        names = [event["args"]["name"] for event in trace["traceEvents"]
                 if event["name"] == "process_name"]
        self.assertEqual([name.split(",")[0] for name in names], ["tower: bullet-si", "tower: cairn"])
        for process in (1, 2):
            spans = sorted(self.spans(trace, process), key=lambda e: (e["tid"], e["ts"], -e["dur"]))
            self.assertGreater(len(spans), 0)
            ends = []
            for span in spans:
                ends = [(t, end) for t, end in ends if t == span["tid"] and end > span["ts"]]
                end = span["ts"] + span["dur"]
                if ends:
                    # rounded to nanoseconds, twice
                    self.assertLessEqual(end, ends[-1][1] + 0.01, span)
                ends.append((span["tid"], end))

    def test_the_phases_of_cairn_and_the_zones_of_bullet_are_there(self):
        trace = self.trace()
        ours = {event["name"] for event in self.spans(trace, 2)}
        self.assertLessEqual({"read contacts", "set-up", "sweep", "residual", "write back"}, ours)
        sweeps = {event["args"]["sweep"] for event in self.spans(trace, 2) if event["name"] == "sweep"}
        self.assertIn(9, sweeps, "ten sweeps, counted from 0")
        zones = {event["name"] for event in self.spans(trace, 1) if event["cat"] == "Bullet"}
        if not any("without its profiler" in note for note in trace["otherData"]["notes"]):
            self.assertIn("solveGroup", zones)

    def test_a_frame_can_be_chosen(self):
        for name in (event["args"]["name"] for event in self.trace("--trace-frame", "3")["traceEvents"]
                     if event["name"] == "process_name"):
            self.assertIn("frame 3,", name)
        self.assertIn("--trace-frame", self.refused(USAGE, *SMALL, "--trace", self.path("t"),
                                                    "--trace-frame", "12"))
        self.assertIn("--trace", self.refused(USAGE, *SMALL, "--trace-frame", "1"))

    def test_recording_changes_no_result(self):
        plain, traced = (self.run_json(*SMALL, "--solver", "cairn", *more)["scenes"][0]["solvers"][0]
                         for more in ([], ["--trace", self.path("t.json")]))
        self.assertEqual(plain["facts"], traced["facts"])
        self.assertEqual(plain["frames"]["residual_m_s"], traced["frames"]["residual_m_s"])


class ImportTest(CairnTest):
    def test_what_is_no_saved_world_is_refused_with_its_name(self):
        with open(self.path("junk.bullet"), "wb") as file:
            file.write(b"no world at all" * 100)
        for name in ("missing.bullet", "junk.bullet"):
            message = self.refused(BAD_INPUT, "run", "--import", self.path(name))
            self.assertRegex(message, name + "|libbullet-extras-dev")


class FailureTest(CairnTest):
    def test_a_solver_that_explodes_is_shown_failed_with_frame_and_reason(self):
        arguments = ("run", "ragdolls", "--frames", "60", "--samples", "0",
                     "--solver", "bullet-nncg,bullet-si")
        failure = self.run_json(*arguments)["scenes"][0]["solvers"][0]["failure"]
        self.assertIsNotNone(failure)
        self.assertLess(failure["frame"], 60)
        out = self.fine(*arguments)  # a peer that fails is a result, not an error
        self.assertIn("FAILED at frame", out)
        self.assertRegex(out, "exploded|not a number")
        self.assertRegex(out, r"(?m)^bullet-si +\d")

    def test_a_matrix_that_is_too_large_is_refused_and_shown(self):
        out = self.fine("run", "castle", "--frames", "2", "--solver", "bullet-dantzig,bullet-si")
        self.assertRegex(out, r"bullet-dantzig +FAILED at frame 0: refused: \d+ rows .* GB")

    def test_joints_without_rows_do_not_break_the_direct_solver(self):
        # Ragdolls have hinges whose limits come and go.
        self.fine("run", "ragdolls", "--size", "1", "--frames", "90", "--solver", "bullet-dantzig")


class StreamTest(CairnTest):
    def test_results_go_to_stdout_and_progress_to_stderr(self):
        arguments = ["run", "wall", "--frames", "400", "--samples", "0", "--solver",
                     "bullet-si@100,cairn"]
        result = cairn(*arguments, "--progress", "always")
        self.assertEqual(result.returncode, FINE)
        self.assertIn("wall: frame", result.stderr)
        self.assertNotIn("wall: frame", result.stdout)
        self.assertTrue(result.stderr.endswith("\x1b[K"), "the line is wiped at the end")
        self.assertEqual(cairn(*arguments).stderr, "", "auto is silent without a terminal")

    def test_quiet_leaves_the_tables(self):
        loud, quiet = self.fine(*SMALL), self.fine(*SMALL, "--quiet")
        self.assertIn("p50", quiet)
        self.assertLess(len(quiet), len(loud))

    def test_tables_fit_120_columns(self):
        for line in self.fine(*SMALL, "--budget", "2ms").splitlines():
            self.assertLessEqual(len(line), 120, line)


class PrecisionTest(CairnTest):
    def setUp(self):
        super().setUp()
        if not os.path.exists(os.path.join(os.path.dirname(TOOL), "cairn-float64")):
            self.skipTest("cairn-float64 was not built")

    def test_both_ways_to_ask_for_double_precision_reach_it(self):
        for words in (["--float64", *SMALL], [*SMALL, "--precision", "float64"]):
            result = self.run_json(*words)
            self.assertEqual(result["context"]["build"]["bullet"]["precision"], "float64")
        self.assertEqual(self.run_json(*SMALL)["context"]["build"]["bullet"]["precision"], "float")

    def test_an_unknown_precision_is_refused(self):
        self.assertIn("float or float64", self.refused(USAGE, *SMALL, "--precision", "half"))


class DoctorTest(CairnTest):
    def test_doctor_says_what_matters_and_writes_the_same_as_json(self):
        out = self.fine("doctor", "--json", self.path("d.json"))
        for words in ("CPU", "SIMD in force", "Bullet 3", "load average", "be trusted"):
            self.assertIn(words, out)
        with open(self.path("d.json"), encoding="utf-8") as file:
            findings = json.load(file)
        self.assertEqual(findings["schema_version"], 1)
        self.assertIn(findings["verdict"], out)

    def test_a_simd_target_that_does_not_exist_is_named(self):
        out = self.fine("doctor", environment={"CAIRN_SIMD": "mmx"})
        self.assertIn("CAIRN_SIMD='mmx' is no target", out)
        out = self.fine("doctor", environment={"CAIRN_SIMD": "scalar"})
        self.assertIn("scalar, asked for by CAIRN_SIMD", out)


if __name__ == "__main__":
    TOOL = os.path.abspath(sys.argv.pop(1))
    unittest.main()
