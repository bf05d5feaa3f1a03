# SPDX-License-Identifier: MIT
"""The window of cairn play on a screen that nobody sees: python3 play_test.py PATH_OF_CAIRN FOLDER_FOR_PICTURES

Exit code 77, skipped, where there is no Xvfb or it has no OpenGL."""
import json
import os
import shutil
import struct
import subprocess
import sys
import tempfile
import unittest
import zlib

SKIPPED, USAGE, BAD_INPUT = 77, 2, 3
TOOL, FOLDER = "", ""
WIDTH, HEIGHT = 760, 660
SIDE, STRIP = 292, 158  # pixels of the panels
WINDOW = ["--window", f"{WIDTH}x{HEIGHT}"]
ENVIRONMENT = {}


def play(*arguments):
    return subprocess.run([TOOL, "play", *WINDOW, *arguments], capture_output=True, text=True, timeout=300,
                          env={**os.environ, **ENVIRONMENT})


def unfilter(kind, line, above):
    for i in range(len(line)):
        left = line[i - 3] if i >= 3 else 0
        up, corner = above[i], above[i - 3] if i >= 3 else 0
        if kind == 1:
            line[i] = (line[i] + left) & 255
        elif kind == 2:
            line[i] = (line[i] + up) & 255
        elif kind == 3:
            line[i] = (line[i] + (left + up) // 2) & 255
        elif kind == 4:
            nearest = min((abs(up - corner), 0, left), (abs(left - corner), 1, up),
                          (abs(left + up - 2 * corner), 2, corner))
            line[i] = (line[i] + nearest[2]) & 255


def read_png(path):
    """Rows of bytes, three a pixel."""
    with open(path, "rb") as file:
        data = file.read()
    assert data[:8] == b"\x89PNG\r\n\x1a\n"
    at, packed, size = 8, b"", None
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at:at + 8])
        if kind == b"IHDR":
            size = struct.unpack(">IIBB", data[at + 8:at + 18])
        if kind == b"IDAT":
            packed += data[at + 8:at + 8 + length]
        at += 12 + length
    assert size == (WIDTH, HEIGHT, 8, 2), size
    raw, rows = zlib.decompress(packed), []
    above = bytearray(3 * WIDTH)
    for y in range(HEIGHT):
        start = y * (3 * WIDTH + 1)
        line = bytearray(raw[start + 1:start + 1 + 3 * WIDTH])
        unfilter(raw[start], line, above)
        rows.append(line)
        above = line
    return rows


def area(rows, left, top, right, bottom):
    """The pixels of a part."""
    return [bytes(row[3 * x:3 * x + 3]) for row in rows[top:bottom] for x in range(left, right)]


HALF = (WIDTH - SIDE) // 2
LEFT = (SIDE, 100, SIDE + HALF - 1, HEIGHT - STRIP)  # below the label
RIGHT = (SIDE + HALF + 1, 100, SIDE + 2 * HALF, HEIGHT - STRIP)


def differences(rows):
    """Of the worlds on both sides, pixel by pixel."""
    return [max(abs(x - y) for x, y in zip(a, b)) for a, b in zip(area(rows, *LEFT), area(rows, *RIGHT))]


def count_near(pixels, colour):
    return sum(max(abs(x - y) for x, y in zip(pixel, colour)) < 6 for pixel in pixels)


class PlayTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def path(self, name):
        return os.path.join(self.folder, name)

    def script(self, text, *arguments):
        """What a file of commands ends in; DIR in it is the folder of the test."""
        text = "set smooth off\nset shadows off\n" + text.replace("DIR", self.folder)
        with open(self.path("commands"), "w", encoding="utf-8") as file:
            file.write(text + f"\nstate {self.path('end.json')}\n")
        result = play("--commands", self.path("commands"), *arguments)
        self.assertEqual(result.returncode, 0, result.stderr)
        return self.state("end.json")

    def state(self, name):
        with open(self.path(name), encoding="utf-8") as file:
            return json.load(file)

    def test_the_picture_shows_worlds_that_differ_and_panels(self):
        picture = os.path.join(FOLDER, "play_bridge.png")
        result = play("bridge", "--frames", "45", "--screenshot", picture)
        self.assertEqual(result.returncode, 0, result.stderr)
        rows = read_png(picture)
        for side in (LEFT, RIGHT):
            self.assertGreater(len(set(area(rows, *side))), 200)
        # the bridge sags on one side only; the rest is the same
        differ = differences(rows)
        share = sum(d > 16 for d in differ) / len(differ)
        self.assertGreater(share, 0.01)
        self.assertLess(share, 0.3)
        # dark panels with light text on them
        for panel in (area(rows, 0, 0, SIDE, HEIGHT), area(rows, SIDE, HEIGHT - STRIP, WIDTH, HEIGHT)):
            self.assertGreater(sum(max(p) < 64 for p in panel), len(panel) // 3)
            self.assertGreater(sum(min(p) > 150 for p in panel), 150)

    def test_the_same_solver_on_both_sides_draws_the_same(self):
        picture = self.path("same.png")
        self.assertEqual(play("tower", "--solver", "cairn,cairn@10", "--frames", "2", "--screenshot",
                              picture).returncode, 0)
        rows = read_png(picture)
        self.assertLess(max(differences(rows)), 10)  # edges are rounded to other places

    def test_every_control_reads_back_and_reaches_the_solver(self):
        values = {"size": 7, "seed": 3, "worlds": 2, "rate": 120.0, "substeps": 2, "sleep": True, "paused": False,
                  "speed": 0.5, "measure": False, "ball_mass": 5.0, "ball_speed": 12.0, "contacts": True,
                  "joints": True, "shadows": False, "smooth": False, "panels": False, "interpolate": False,
                  "colours": "islands", "scene": "tower"}
        for side, solver in (("left", "bullet-nncg"), ("right", "cairn")):
            values |= {side + ".solver": solver, side + ".iterations": 4, side + ".budget": "fixed",
                       side + ".budget_ms": 3.5, side + ".threads": 2, side + ".steps": False,
                       side + ".acceleration": False}
        words = {True: "on", False: "off"}
        text = "".join(f"set {name} {words[v] if isinstance(v, bool) else v}\n" for name, v in values.items())
        state = self.script(text + "restart\nframes 4\n", "wall")
        self.assertEqual(state["controls"], values)
        left, right = state["worlds"]
        self.assertEqual((left["solver"], left["iterations"]), ("bullet-nncg", 4))
        self.assertEqual(right["solver"], "cairn")
        self.assertEqual((right["bodies"], left["bodies"]), (7, 7))
        self.assertAlmostEqual(right["time_step"], 1 / 120, 6)
        self.assertEqual((right["budget_ms"], right["threads"]), (3.5, 2))
        self.assertEqual((right["steps"], right["acceleration"]), (False, False))
        self.assertEqual(right["frame"], 2)  # four pictures in slow motion
        self.assertEqual(state.get("widgets"), None)  # no panels

    def test_buttons_and_boxes_are_clicked(self):
        state = self.script("""frames 5
click right.steps
click right.acceleration
click paused
state DIR/paused.json
frames 3
state DIR/still.json
click step
state DIR/step.json
click shoot
click restart
state DIR/restarted.json
click left.preset.match
click contacts
click joints
click sleep
click measure
click shadows
click smooth
click interpolate
frames 1
""", "pyramid", "--size", "5")
        clicked = self.state("step.json")["worlds"][1]
        self.assertEqual((clicked["steps"], clicked["acceleration"]), (False, False))
        frames = {name: self.state(name + ".json")["worlds"][0]["frame"] for name in
                  ("paused", "still", "step", "restarted")}
        self.assertGreater(frames["paused"], 5)
        self.assertEqual(frames["still"], frames["paused"])
        self.assertEqual(frames["step"], frames["still"] + 1)
        self.assertEqual(frames["restarted"], 0)
        controls = state["controls"]
        self.assertEqual(controls["left.budget"], "match")
        self.assertEqual(controls["right.solver"], "bullet-si")
        for name in ("contacts", "joints", "sleep", "shadows", "smooth"):
            self.assertTrue(controls[name], name)
        for name in ("measure", "interpolate"):
            self.assertFalse(controls[name], name)

    def test_the_mouse_drags_what_it_is_over(self):
        x, y = SIDE + HALF // 2, (HEIGHT - STRIP) // 2
        state = self.script(f"""frames 2
mouse {x} {y}
state DIR/over.json
mouse {x} {y} left
mouse {x} {y} left
frames 1
state DIR/held.json
mouse {x} {y - 120} left
frames 40
state DIR/up.json
mouse {x} {y - 120}
frames 2
""", "tower", "--size", "3")
        over, held = self.state("over.json"), self.state("held.json")
        self.assertEqual(over["hovered"]["world"], 0)
        self.assertGreaterEqual(over["hovered"]["body"], 0)
        self.assertEqual([world["constraints"] for world in held["worlds"]], [1, 1])
        self.assertEqual([world["constraints"] for world in state["worlds"]], [0, 0])
        for before, after in zip(held["worlds"], self.state("up.json")["worlds"]):
            self.assertGreater(after["last"]["energy"], before["last"]["energy"] * 1.02)

    def test_the_mouse_turns_moves_and_nears_the_camera(self):
        x, y = SIDE + 20, 150  # the sky
        self.script(f"mouse {x} {y}\nstate DIR/a.json\nmouse {x} {y} right\nmouse {x + 50} {y} right\n"
                    "frames 1\nstate DIR/b.json\ncamera 1 0.5 7\nstate DIR/c.json\nview\n", "tower")
        a, b, c, end = (self.state(name + ".json")["camera"] for name in ("a", "b", "c", "end"))
        self.assertLess(b[0], a[0] - 0.1)
        self.assertEqual([round(v, 4) for v in c], [1, 0.5, 7])
        for before, after in zip(a, end):  # the tower has settled a little meanwhile
            self.assertAlmostEqual(after / before, 1, 2)

    def test_by_the_clock_steps_keep_the_time(self):
        self.script("set measure off\nset right.budget rest\nlive 2\nstate DIR/a.json\nset speed 0.1\nlive 2\n",
                    "tower")
        fast, slow = (self.state(name + ".json")["worlds"][1]["frame"] for name in ("a", "end"))
        # 120 and 12; fewer where a picture takes more than four steps, and one more where it is late
        self.assertGreater(fast, 20)
        self.assertLess(fast, 150)
        self.assertGreater(slow, fast)
        self.assertLess(slow, fast + 30)
        self.assertGreater(self.state("a.json")["worlds"][1]["budget_ms"], 0.05)

    def test_a_ball_comes_and_scenes_change(self):
        self.script("frames 1\nshoot\nframes 1\nstate DIR/ball.json\nset scene random\nset seed 12\nrestart\nview\n"
                    "frames 3\nstate DIR/random.json\nset worlds 1\nframes 1\n", "wall")
        self.assertEqual(self.state("ball.json")["worlds"][1]["bodies"], 106)
        random, end = self.state("random.json"), self.state("end.json")
        self.assertNotEqual(random["worlds"][0]["bodies"], 106)
        self.assertEqual(random["worlds"][0]["failure"], "")
        self.assertEqual(len(end["worlds"]), 1)

    def test_the_same_pictures_make_the_same_bits(self):
        text = "frames 20\nset contacts on\nset joints on\nset measure off\nframes 20\n"
        first, second = self.script("frames 40\n", "bridge"), self.script(text, "bridge")
        for a, b in zip(first["worlds"], second["worlds"]):
            self.assertEqual((a["frame"], a["hash"]), (40, b["hash"]))
        self.assertNotEqual(first["worlds"][0]["hash"], first["worlds"][1]["hash"])

    def test_a_frame_is_saved_that_solvers_read(self):
        state = self.script("frames 5\nsave DIR/frame.cairn\n", "tower")
        self.assertTrue(state["worlds"][0]["saved"].startswith("written"), state["worlds"][0]["saved"])
        for side in ("left", "right"):
            result = subprocess.run([TOOL, "solve", self.path(f"frame-{side}.cairn")], capture_output=True,
                                    text=True, timeout=120)
            self.assertEqual(result.returncode, 0, result.stderr)

    def test_recordings_are_chosen_and_solved_in_the_panel(self):
        self.script("frames 8\nsave DIR/one.cairn\nset scene tower\nset worlds 1\nrestart\nframes 20\n"
                    "save DIR/number two.cairn\n", "bridge")
        first, second = self.path("one-right.cairn"), self.path("number two.cairn")
        for state in (self.script("frames 3\n", first),
                      self.script(f"frames 1\nclick scenes\nclick scenes.{first}\nframes 3\n", second)):
            left, right = state["worlds"]
            self.assertEqual(state["controls"]["scene"], first)
            self.assertEqual((left["bodies"], right["constraints"]), (52, 82))
            self.assertEqual((left["failure"], right["failure"]), ("", ""))
            self.assertLess(right["last"]["residual"], left["last"]["residual"] / 2)
            self.assertGreater(right["last"]["steps_kept"], 0)
            self.assertIsNone(right["last"]["penetration"])  # not recorded
        state = self.script("""frames 1
state DIR/before.json
set left.iterations 500
click right.steps
click right.budget
click right.budget.fixed
set contacts on
set joints on
frames 2
key b
key s
""", first)
        left, right = state["worlds"]
        self.assertLess(left["last"]["residual"], self.state("before.json")["worlds"][0]["last"]["residual"] / 2)
        self.assertEqual((right["steps"], right["budget_ms"]), (False, 2))
        self.assertEqual((right["bodies"], right["last"]["steps_kept"]), (52, 0))  # nothing is shot into it
        self.assertIn("recording already", state["message"])

    def test_recordings_that_are_none_are_refused(self):
        self.script("frames 2\nset worlds 1\nsave DIR/whole.cairn\n", "tower")
        with open(self.path("whole.cairn"), "rb") as file:
            data = file.read()
        for name, content, words in (("cut", data[:2000], "was cut"), ("text", b"text\n" * 500, "no recording"),
                                     ("altered", data[:1000] + b"!" + data[1001:], "altered")):
            with open(self.path(name + ".cairn"), "wb") as file:
                file.write(content)
            self.assertIn(words, self.refused(BAD_INPUT, self.path(name + ".cairn")))
            # in the panel what is shown stays, and the reason is told
            state = self.script(f"frames 1\nclick scenes\nclick scenes.{self.path(name + '.cairn')}\nframes 2\n",
                                self.path("whole.cairn"))
            self.assertIn(words, state["message"])
            self.assertEqual(state["worlds"][0]["bodies"], 30)
        self.assertIn("No such file", self.refused(BAD_INPUT, self.path("none.cairn")))

    def test_keys_do_what_buttons_do(self):
        self.script("""frames 3
key space
state DIR/paused.json
key n
state DIR/step.json
key b
state DIR/shot.json
key p
state DIR/bare.json
key p
camera 1 1 3
key v
state DIR/view.json
key space
mouse 400 200
wheel 5
state DIR/near.json
key r
""", "tower")
        paused, step, shot, bare, view, near, end = (
            self.state(name + ".json") for name in ("paused", "step", "shot", "bare", "view", "near", "end"))
        self.assertTrue(paused["controls"]["paused"])
        self.assertEqual(step["worlds"][0]["frame"], paused["worlds"][0]["frame"] + 1)
        self.assertEqual(shot["worlds"][1]["bodies"], 31)
        self.assertEqual((bare["controls"]["panels"], bare.get("widgets")), (False, None))
        self.assertLess(view["camera"][0], 0.9)
        self.assertGreater(view["camera"][2], 4)
        self.assertAlmostEqual(near["camera"][2] / view["camera"][2], 0.9 ** 5, 3)
        self.assertFalse(end["controls"]["paused"])
        self.assertEqual(end["worlds"][1]["bodies"], 30)  # begun again

    def test_words_are_chosen_with_the_mouse(self):
        before = self.script("frames 1\n", "tower")
        state = self.script("frames 1\nclick left.solver\nclick left.solver.bullet-nncg\nclick colours\n"
                            "click colours.islands\nclick scenes\nclick scenes.random\nframes 2\n", "tower")
        self.assertEqual(state["worlds"][0]["solver"], "bullet-nncg")
        self.assertEqual(state["controls"]["colours"], "islands")
        self.assertNotEqual(state["camera"][2], before["camera"][2])  # another scene is looked at whole
        self.assertEqual((state["controls"]["scene"], state["message"]), ("random", ""))

    def test_small_windows_keep_to_their_places(self):
        for size, panels in (("120x100", False), ("640x360", True), ("500x700", False)):
            script = self.path("small")
            with open(script, "w", encoding="utf-8") as file:
                file.write(f"frames 2\nmouse 60 50\nframes 1\nstate {self.path('small.json')}\n")
            result = play("wall", "--window", size, "--commands", script)
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertEqual("restart" in (self.state("small.json").get("widgets") or []), panels, size)

    def test_every_scene_is_drawn(self):
        listed = subprocess.run([TOOL, "list", "scenes"], capture_output=True, text=True, timeout=60, check=True)
        scenes = [line.split()[0] for line in listed.stdout.splitlines()] + ["random"]
        self.assertGreater(len(scenes), 20)
        self.script("".join(f"set scene {scene}\nrestart\nview\nframes 2\nscreenshot DIR/{scene}.png\n"
                            f"state DIR/{scene}.json\n" for scene in scenes), "wall")
        for scene in scenes:
            state = self.state(scene + ".json")
            self.assertEqual([world["failure"] for world in state["worlds"]], ["", ""], scene)
            self.assertEqual(state["worlds"][0]["bodies"], state["worlds"][1]["bodies"])
            self.assertLess(state["picture"]["draw_calls"], 20 + state["picture"]["bodies"] // 2, scene)
            self.assertGreater(len(set(area(read_png(self.path(scene + ".png")), *RIGHT))), 100, scene)

    def test_what_is_switched_on_is_drawn(self):
        names = ("contacts", "joints", "shadows", "smooth", "colours")
        self.script("set worlds 1\nframes 60\nset paused on\nframes 1\nscreenshot DIR/plain.png\n" + "".join(
            f"set {name} {on}\nframes 1\nscreenshot DIR/{name}.png\nset {name} {off}\n"
            for name, on, off in [(name, "on", "off") for name in names[:-1]] + [("colours", "islands", "stone")]),
            "ragdolls", "--size", "4")
        pictures = {name: area(read_png(self.path(name + ".png")), *LEFT) for name in names + ("plain",)}
        for name in names:
            self.assertTrue(pictures[name] != pictures["plain"], name)
        arms = (0xc7, 0xa6, 0xff)  # of joints, in examples/debug_draw.h
        self.assertGreater(count_near(pictures["joints"], arms), 100)
        self.assertEqual(count_near(pictures["plain"], arms), 0)

    def test_impulses_are_drawn_and_sleeping_bodies_are_blue(self):
        state = self.script("""set worlds 1
set contacts on
frames 30
screenshot DIR/contacts.png
set contacts off
set sleep on
frames 1
screenshot DIR/awake.png
frames 150
screenshot DIR/asleep.png
""", "wall", "--size", "3")
        self.assertEqual(state["worlds"][0]["last"]["asleep"], state["worlds"][0]["bodies"])
        contacts, awake, asleep = (area(read_png(self.path(name + ".png")), *LEFT)
                                   for name in ("contacts", "awake", "asleep"))
        for colour in ((0xff, 0xd7, 0x5e), (0x4c, 0xd9, 0x64)):  # points and impulses
            self.assertGreater(count_near(contacts, colour), 20)
            self.assertEqual(count_near(awake, colour), 0)
        # stones are red rather than blue; the sky is neither far apart
        stones, blue = (sum(p[0] > p[2] + 30 for p in rows) for rows in (awake, asleep))
        self.assertGreater(stones, 2000)
        self.assertEqual(blue, 0)

    def test_a_video_is_numbered_pictures(self):
        self.assertEqual(play("tower", "--frames", "3", "--video", self.path("video")).returncode, 0)
        self.assertEqual(sorted(os.listdir(self.path("video"))), [f"{i:06}.png" for i in range(3)])

    def refused(self, code, *arguments):
        result = play(*arguments)
        self.assertEqual(result.returncode, code, result.stderr)
        self.assertTrue(result.stderr.startswith("cairn play: "), result.stderr)
        self.assertEqual(result.stderr.count("\n"), 1, result.stderr)
        return result.stderr

    def test_what_cannot_be_is_refused(self):
        self.assertIn("did you mean 'castle'", self.refused(USAGE, "castel"))
        self.refused(USAGE, "wall", "--solver", "cairn,bullet-si,bullet-nncg")
        self.refused(USAGE, "wall", "--window", "100")
        self.refused(BAD_INPUT, "wall", "--commands", self.path("none"))
        for line in ("set left.volume 11", "set rate fast", "click heels", "jump", "preset up cairn", "frames"):
            with open(self.path("bad"), "w", encoding="utf-8") as file:
                file.write(line + "\n")
            self.assertIn(line, self.refused(USAGE, "wall", "--commands", self.path("bad")))

    def test_without_a_screen_it_says_so(self):
        result = subprocess.run([TOOL, "play", "wall", "--frames", "1"], capture_output=True, text=True, timeout=60,
                                env={k: v for k, v in os.environ.items() if "DISPLAY" not in k})
        self.assertEqual(result.returncode, BAD_INPUT)
        self.assertIn("no screen", result.stderr)


def main():
    global TOOL, FOLDER
    TOOL, FOLDER = sys.argv[1:3]
    xvfb = shutil.which("Xvfb")
    if xvfb is None:
        print("skipped: there is no Xvfb (Debian: xvfb)")
        sys.exit(SKIPPED)
    os.makedirs(FOLDER, exist_ok=True)
    screen = subprocess.Popen([xvfb, "-displayfd", "1", "-screen", "0", "1280x1024x24", "-nolisten", "tcp"],
                              stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
    try:
        ENVIRONMENT["DISPLAY"] = ":" + screen.stdout.readline().strip()
        ENVIRONMENT["LIBGL_ALWAYS_SOFTWARE"] = "1"
        ENVIRONMENT["ASAN_OPTIONS"] = "detect_leaks=0"  # drivers of Mesa leave some when they are unloaded
        first = play("wall", "--frames", "1")
        if "OpenGL 3.3" in first.stderr:
            print("skipped: " + first.stderr)
            sys.exit(SKIPPED)
        unittest.main(argv=sys.argv[:1] + sys.argv[3:])
    finally:
        screen.terminate()
        screen.wait()


if __name__ == "__main__":
    main()
