# SPDX-License-Identifier: MIT
"""The report page in a real browser: python3 page_test.py PATH_OF_CAIRN FOLDER_FOR_PICTURES

Exit code 77, skipped, where there is no Chromium, or the tool was built without the scripts of the page."""
import os
import re
import subprocess
import sys
import unittest

from browser import Browser, find_programs

SKIPPED = 77
TOOL, FOLDER, PAGE = "", "", ""
FRAMES = 60
# The chain swings, so that every frame looks different; the tower can fall, and has contacts.
RUN = ["run", "chain", "tower", "--size", "8", "--frames", str(FRAMES), "--samples", "2",
       "--budget", "2ms", "--solver", "bullet-si,cairn", "--quiet"]

# How many colours a canvas has, whatever it was drawn with, up to 50.
COLOURS = """
  const canvas = arguments[0], copy = document.createElement('canvas');
  copy.width = canvas.width; copy.height = canvas.height;
  const context = copy.getContext('2d');
  context.drawImage(canvas, 0, 0);
  const data = new Uint32Array(context.getImageData(0, 0, copy.width, copy.height).data.buffer);
  const seen = new Set();
  for (const pixel of data) { seen.add(pixel); if (seen.size >= 50) break; }
  return seen.size;"""
# All but the keys of legends, which may have one colour.
CANVASES = "document.querySelectorAll('[data-plot] canvas:not(.legend canvas)')"
# A number that changes with any pixel of the two panes of the first replay.
PANES = """
  return [...document.querySelectorAll('[data-plot=replay]')[0].querySelectorAll('.pane canvas')].map((canvas) => {
    const copy = document.createElement('canvas');
    copy.width = canvas.width; copy.height = canvas.height;
    const context = copy.getContext('2d');
    context.drawImage(canvas, 0, 0);
    let hash = 0;
    for (const pixel of new Uint32Array(context.getImageData(0, 0, copy.width, copy.height).data.buffer)) {
      hash = (Math.imul(hash, 31) + pixel) | 0;
    }
    return hash;
  });"""
SCRUB = """
  const slider = document.querySelector('[data-plot=replay] input[type=range]');
  slider.value = arguments[0];
  slider.dispatchEvent(new Event('input'));"""
FRAME = "return Number(document.querySelector('[data-plot=replay] input[type=range]').value);"


def box_of(browser, selector):
    """The place of an element in the window, after it was brought there."""
    browser.run("document.querySelector(arguments[0]).scrollIntoView({block: 'center'})", selector)
    return browser.run("const b = document.querySelector(arguments[0]).getBoundingClientRect();"
                       "return [b.left, b.top, b.width, b.height];", selector)


class PageTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.browser = Browser()
        cls.addClassCleanup(cls.browser.__exit__, None, None, None)

    def open(self, scheme="light"):
        self.browser.emulate(scheme)
        self.browser.open(PAGE)
        self.assertTrue(self.browser.until(
            "return document.documentElement.classList.contains('with-scripts')"))
        self.wake()

    def wake(self):
        """Replays are made when they come into view."""
        box_of(self.browser, "[data-plot=replay] .panes")
        self.assertTrue(self.browser.until(
            "const c = document.querySelector('[data-plot=replay] .pane canvas'); return c.width > 300;"))

    def colours(self, index):
        return self.browser.run(
            COLOURS.replace("arguments[0]", f"{CANVASES}[arguments[0]]"), index)

    def test_scaling_has_a_time_for_every_scene_and_way(self):
        self.open()
        rows = self.browser.run(
            "const host = document.querySelector('[data-plot=scaling]').closest('section');"
            "return [...host.querySelectorAll('tbody tr')].map((row) => [...row.cells].map((c) => c.textContent));")
        ways = self.browser.run(
            "const host = document.querySelector('[data-plot=scaling]').closest('section');"
            "return [...host.querySelectorAll('th')].map((cell) => cell.firstChild.textContent);")
        self.assertEqual([row[0] for row in rows], ["chain", "tower"])
        self.assertEqual(ways[:3], ["scene", "rows", "1 thread"])
        self.assertIn("scalar", ways)
        for row in rows:
            self.assertEqual(len(row), len(ways))
            for time in row[2:]:
                self.assertGreater(float(time), 0)

    def test_every_picture_is_drawn_in_light_and_dark(self):
        for scheme in ("light", "dark"):
            self.open(scheme)
            hosts = self.browser.run(
                "return [...document.querySelectorAll('[data-plot]')].map((host) => [host.dataset.plot,"
                "host.dataset.drawn, host.querySelectorAll('canvas').length,"
                "host.querySelectorAll('p.soft').length]);")
            self.assertEqual({name for name, *_ in hosts}, {
                "error-time", "profile", "histogram", "strip", "replay", "timeline", "facts", "scaling"})
            for name, drawn, canvases, texts in hosts:
                self.assertEqual(drawn, "yes", name)
                self.assertGreater(canvases + texts, 0, name)
                if name not in ("profile", "scaling"):
                    self.assertGreater(canvases, 0, name)
            # the replay of the second scene wakes up when it is seen
            self.browser.run("document.querySelectorAll('[data-plot=replay]')[1].scrollIntoView()")
            self.assertTrue(self.browser.until(
                "return [...document.querySelectorAll('.pane canvas')].every((c) => c.width > 300)"))
            count = self.browser.run(f"return {CANVASES}.length")
            for index in range(count):
                self.assertGreater(self.colours(index), 2, f"canvas {index} is blank, {scheme}")
            self.assertEqual(self.browser.complaints(), [])
            self.browser.picture(os.path.join(FOLDER, f"page-{scheme}.png"))

    def test_a_blank_canvas_is_noticed(self):
        self.open()
        self.browser.run("document.querySelector('[data-plot]').prepend(document.createElement('canvas'))")
        self.assertEqual(self.colours(0), 1)

    def test_light_and_dark_are_different_and_readable(self):
        papers = []
        for scheme in ("light", "dark"):
            self.open(scheme)
            papers.append(self.browser.run("return getComputedStyle(document.body).backgroundColor"))
        light, dark = (sum(map(int, re.findall(r"\d+", paper)[:3])) for paper in papers)
        self.assertGreater(light, 700)
        self.assertLess(dark, 120)

    def test_colours_follow_a_change_of_scheme(self):
        self.open("light")
        before = self.browser.run(PANES)
        self.browser.emulate("dark")
        self.assertTrue(self.browser.until(f"{PANES.replace('return', 'const now =', 1)}"
                                           "return now[0] !== arguments[0];", before[0]))

    def test_the_replay_moves_when_it_is_scrubbed(self):
        self.open()
        seen = set()
        for frame in (0, 20, 45, FRAMES):
            self.browser.run(SCRUB, frame)
            self.assertEqual(self.browser.run(FRAME), frame)
            seen.add(tuple(self.browser.run(PANES)))
        for pane in range(2):
            self.assertEqual(len({panes[pane] for panes in seen}), 4)

    def test_a_click_on_the_strip_moves_the_replay(self):
        self.open()
        self.browser.run(SCRUB, 0)
        before = self.browser.run(PANES)
        left, top, width, height = box_of(self.browser, "[data-plot=strip] canvas")
        self.browser.click(left + 0.75 * width, top + height / 3)
        frame = self.browser.run(FRAME)
        self.assertGreater(frame, 0.55 * FRAMES)
        self.assertLess(frame, 0.85 * FRAMES)
        after = self.browser.run(PANES)
        self.assertNotEqual(before[0], after[0])
        self.assertNotEqual(before[1], after[1])

    def test_it_plays_and_pauses(self):
        self.open()
        self.browser.run(SCRUB, 0)
        button = "document.querySelector('[data-plot=replay] button')"
        self.browser.run(f"{button}.click()")
        self.assertTrue(self.browser.until(FRAME.replace("return", "return 2 <", 1)))
        self.browser.run(f"if ({button}.textContent === 'Pause') {button}.click()")
        stopped = self.browser.run(FRAME)
        self.browser.run("return new Promise((done) => setTimeout(done, 300))")
        self.assertEqual(self.browser.run(FRAME), stopped)

    def test_the_cameras_are_one(self):
        self.open()
        before = self.browser.run(PANES)
        left, top, width, height = box_of(self.browser, "[data-plot=replay] .pane canvas")
        x, y = left + width / 2, top + height / 2
        for kind, step in (("mousePressed", 0), ("mouseMoved", 40), ("mouseMoved", 80), ("mouseReleased", 80)):
            self.browser.devtools("Input.dispatchMouseEvent", type=kind, x=x + step, y=y, button="left",
                                  buttons=1, clickCount=1)
        after = self.browser.run(PANES)
        self.assertNotEqual(before[0], after[0])
        self.assertNotEqual(before[1], after[1], "the other pane follows")

    def test_another_solver_can_be_chosen(self):
        self.open()
        self.browser.run(SCRUB, 40)
        before = self.browser.run(PANES)
        self.browser.run("const s = document.querySelectorAll('[data-plot=replay] select')[0];"
                         "s.value = s.value === '0' ? '1' : '0'; s.dispatchEvent(new Event('change'));")
        after = self.browser.run(PANES)
        self.assertNotEqual(before[0], after[0])
        self.assertEqual(before[1], after[1])

    def test_nothing_is_fetched(self):
        self.open()
        self.assertEqual(self.browser.run("return performance.getEntriesByType('resource').length"), 0)

    def test_the_verdict_and_the_table_come_first(self):
        self.open()
        order = self.browser.run(
            "return [...document.querySelectorAll('section')[0].querySelectorAll('.verdict, table, [data-plot]')]"
            ".map((e) => e.dataset.plot ?? (e.className || e.tagName).toLowerCase()).slice(0, 3)")
        self.assertEqual(order, ["verdict", "table", "error-time"])
        self.assertIn("use ", self.browser.run("return document.querySelector('.verdict').textContent"))

    def test_it_prints(self):
        self.open("dark")
        path = os.path.join(FOLDER, "page.pdf")
        self.browser.paper(path)
        self.assertGreater(os.path.getsize(path), 100_000)
        self.assertEqual(self.browser.complaints(), [])

    def test_without_scripts_there_is_a_still_picture_of_every_scene(self):
        with open(PAGE, encoding="utf-8") as file:
            page = re.sub(r"(?s)<script.*?</script>", "", file.read())
        path = os.path.join(FOLDER, "without-scripts.html")
        with open(path, "w", encoding="utf-8") as file:
            file.write(page)
        self.browser.emulate("light")
        self.browser.open(path)
        shown = self.browser.run("return [...document.querySelectorAll('figure svg')]"
                                 ".filter((s) => s.getBoundingClientRect().height > 50).length")
        self.assertEqual(shown, 2)
        paths = self.browser.run("return document.querySelectorAll('figure svg path.l').length")
        self.assertEqual(paths, 4)
        self.browser.picture(os.path.join(FOLDER, "page-without-scripts.png"))

    def test_a_narrow_window_does_not_scroll_sideways(self):
        self.browser.devtools("Emulation.setDeviceMetricsOverride", width=420, height=800,
                              deviceScaleFactor=2, mobile=False)
        self.addCleanup(self.browser.devtools, "Emulation.clearDeviceMetricsOverride")
        self.open()
        self.assertLessEqual(self.browser.run("return document.documentElement.scrollWidth"), 421)


def main():
    global TOOL, FOLDER, PAGE
    TOOL, FOLDER = (os.path.abspath(path) for path in sys.argv[1:3])
    _, _, missing = find_programs()
    if missing:
        print(f"skipped: no {' and no '.join(missing)} (Debian: chromium, chromium-driver)")
        sys.exit(SKIPPED)
    os.makedirs(FOLDER, exist_ok=True)
    PAGE = os.path.join(FOLDER, "page.html")
    subprocess.run([TOOL, *RUN, "--report", PAGE], check=True, stdout=subprocess.DEVNULL)
    with open(PAGE, encoding="utf-8") as file:
        if 'id="data"' not in file.read():
            print("skipped: this tool writes pages without scripts; it was built without npm, or without a network")
            sys.exit(SKIPPED)
    unittest.main(argv=sys.argv[:1] + sys.argv[3:])


if __name__ == "__main__":
    main()
