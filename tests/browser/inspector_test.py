#!/usr/bin/env python3
"""The pages of gnomon inspect and gnomon lab in headless Chromium, opened from disk.

Oracles: the program itself (gnomon history, gnomon lab) for what the pages tell, and the contract of
docs/inspector.md for what can be done with them. Screenshots go to OUT.

usage: inspector_test.py GNOMON SOURCE_DIR OUT [unittest's own arguments]
"""
import json
import pathlib
import random
import subprocess
import sys
import unittest

from selenium import webdriver
from selenium.webdriver.chrome.service import Service
from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys
from selenium.webdriver.support.ui import Select, WebDriverWait

PROGRAM, SOURCE, OUT = (pathlib.Path(a).resolve() for a in sys.argv[1:4])
DESK = SOURCE / "examples/desk"
FOCUSABLE = "button, select, input, canvas, a[href], [tabindex='0']"


def gnomon(*arguments):
    done = subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise AssertionError(f"gnomon {arguments[0]} failed: {done.stderr}")
    return done.stdout


def start_browser():
    options = webdriver.ChromeOptions()
    options.binary_location = "/usr/bin/chromium"
    for argument in ("--headless=new", "--no-sandbox", "--disable-gpu", "--window-size=1600,950", "--hide-scrollbars",
                     "--disable-dev-shm-usage", "--host-resolver-rules=MAP * ~NOTFOUND"):
        options.add_argument(argument)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
    return webdriver.Chrome(service=Service("/usr/bin/chromedriver"), options=options)


class PageTest(unittest.TestCase):
    """One browser and one page a class."""

    @classmethod
    def setUpClass(cls):
        OUT.mkdir(parents=True, exist_ok=True)
        cls.page = cls.make_page()
        cls.browser = start_browser()
        cls.addClassCleanup(cls.browser.quit)
        cls.browser.get(cls.page.as_uri())
        cls.wait(cls.ready)

    @classmethod
    def wait(cls, script):
        WebDriverWait(cls.browser, 30).until(lambda b: b.execute_script(f"return {script}"))

    @classmethod
    def run_script(cls, script, *arguments):
        return cls.browser.execute_script(script, *arguments)

    @classmethod
    def screenshot(cls, name):
        # Two frames later everything is painted.
        cls.browser.execute_async_script("const done = arguments[0]; requestAnimationFrame(() => requestAnimationFrame(() => done()))")
        cls.browser.save_screenshot(str(OUT / f"{name}.png"))

    def tearDown(self):
        errors = [line for line in self.browser.get_log("browser") if line["level"] in ("SEVERE", "WARNING")]
        self.assertEqual(errors, [])
        self.assertTrue(self.run_script("return document.getElementById('error').hidden"))

    def element(self, name):
        return self.browser.find_element(By.ID, name)

    def expect_all_reached_by_tab(self):
        # A history follows the last step a quarter of a second later, with elements of its own.
        self.browser.execute_async_script("setTimeout(arguments[0], 500)")
        wanted = self.run_script(
            f"return [...document.querySelectorAll(\"{FOCUSABLE}\")].filter(e => e.tabIndex >= 0 && e.checkVisibility() && !e.closest('dialog'))"
            ".map((e, i) => e.dataset.stop = String(i))")
        self.run_script("document.activeElement.blur(); window.getSelection().removeAllRanges()")
        reached = set()
        for _ in range(len(wanted) + 3):
            ActionChains(self.browser).send_keys(Keys.TAB).perform()
            reached.add(self.run_script("return document.activeElement.dataset.stop"))
        self.assertEqual(set(wanted) - reached, set())


class InspectPage(PageTest):
    ready = "document.body.dataset.readyMs"

    @classmethod
    def make_page(cls):
        # One light, so that the frame is the paper's; what --samples 1 draws has the photograph's pixels.
        cls.frame, other = OUT / "desk.frame", OUT / "desk-zpass.frame"
        scene, image = DESK / "01_torus_on_house.toml", DESK / "background.png"
        for method, frame in (("zfail", cls.frame), ("zpass", other)):
            gnomon("ar", scene, "--image", image, "--samples", 1, "--method", method, "--out", OUT / "ar", "--save-frame", frame)
        page = OUT / "inspect.html"
        gnomon("inspect", cls.frame, "--compare", other, "--out", page)
        return page

    def position(self):
        return self.run_script("return inspector.panes[0].position")

    def values(self):
        """A number that stands for all values shown."""
        return self.run_script("let h = 0; for (const v of inspector.panes[0].buffer.values) h = (h * 31 + v) | 0; return h")

    def go(self, command):
        self.run_script("inspector.go(arguments[0])", command)

    def choose(self, select, value):
        Select(self.element(select)).select_by_value(value)

    def first_volume(self):
        return self.run_script("return inspector.panes[0].commands.findIndex(c => (c.label || '').startsWith('volume of torus')) + 1")

    def test_is_small_and_opens_quickly(self):
        size = self.page.stat().st_size
        opened = self.run_script("return performance.timing.domContentLoadedEventEnd - performance.timing.navigationStart")
        ready = self.run_script("return document.body.dataset.readyMs")
        print(f"inspect page: {size / 1e6:.2f} MB; document in {opened} ms, ready {ready} ms after it")
        self.assertLess(size, 15e6)

    def test_scrubbing_changes_the_buffers(self):
        self.choose("buffer", "stencil")
        slider = self.browser.find_element(By.CSS_SELECTOR, ".pane input[type=range]")
        seen = []
        self.go(self.first_volume() - 1)
        for _ in range(3):
            seen.append(self.values())
            slider.send_keys(Keys.ARROW_RIGHT)
        self.assertEqual(len(set(seen[:2])), 2)
        # And back again to the same bytes.
        for _ in range(3):
            slider.send_keys(Keys.ARROW_LEFT)
        self.assertEqual(self.values(), seen[0])

    def test_before_the_command_shows_what_the_one_before_left(self):
        self.choose("buffer", "stencil")
        self.go(self.first_volume())
        after = self.values()
        self.element("before").click()
        before = self.values()
        self.element("before").click()
        self.go(self.first_volume() - 1)
        self.assertEqual(self.values(), before)
        self.assertNotEqual(after, before)

    def test_a_clicked_pixel_has_the_history_that_the_program_tells(self):
        self.go(10**6)
        canvas = self.browser.find_element(By.CSS_SELECTOR, ".pane canvas")
        box = canvas.rect
        scatter = random.Random(20030)
        told = 0
        while told < 50:
            dx = scatter.uniform(-0.48, 0.48) * box["width"]
            dy = scatter.uniform(-0.48, 0.48) * box["height"]
            self.run_script("inspector.history = null")
            ActionChains(self.browser).move_to_element_with_offset(canvas, dx, dy).click().perform()
            history = self.run_script("return JSON.stringify(inspector.history)")
            if history == "null":
                continue  # beside the picture
            history = json.loads(history)
            is_told = json.loads(gnomon("history", self.frame, history["x"], history["y"], "--json"))
            self.assertEqual(history, is_told)
            self.assertGreater(len(history["commands"]), 3)
            told += 1

    def test_layers_wires_and_buffers_are_shown_for_every_command(self):
        for overlay in ("counts", "depth", "stencil", "changed", "differs"):
            self.choose("overlay", overlay)
            self.choose("wires", "command")
            for command in range(1, self.run_script("return inspector.panes[0].commands.length") + 1, 3):
                self.go(command)
        self.choose("overlay", "none")
        self.choose("wires", "none")
        for option in self.run_script("return [...document.getElementById('buffer').options].map(o => o.value)"):
            self.choose("buffer", option)
        self.choose("buffer", "color")

    def test_keyboard_alone_reaches_everything(self):
        self.expect_all_reached_by_tab()
        body = self.browser.find_element(By.TAG_NAME, "body")
        self.go(20)
        for key, position in ((".", 21), (",", 20)):
            body.send_keys(key)
            self.assertEqual(self.position(), position)
        body.send_keys("[")
        self.assertLess(self.position(), 20)
        body.send_keys("s")
        self.assertEqual(self.run_script("return inspector.panes[0].buffer.kind"), "stencil")
        body.send_keys("c")
        commands = self.element("commands")
        commands.send_keys(Keys.END)
        self.assertEqual(self.position(), self.run_script("return inspector.panes[0].commands.length"))
        commands.send_keys(Keys.ARROW_UP)
        canvas = self.browser.find_element(By.CSS_SELECTOR, ".pane canvas")
        self.run_script("inspector.panes[0].view.moveTo(300, 200); inspector.history = null")
        canvas.send_keys(Keys.ARROW_RIGHT, Keys.SHIFT, Keys.ARROW_UP)
        ActionChains(self.browser).key_up(Keys.SHIFT).send_keys(Keys.ENTER).perform()
        self.assertEqual(self.run_script("return [inspector.history.x, inspector.history.y]"), [301, 210])
        scale = self.run_script("return inspector.panes[0].view.scale")
        canvas.send_keys("+")
        self.assertGreater(self.run_script("return inspector.panes[0].view.scale"), scale)
        canvas.send_keys("0")
        body.send_keys("h")
        self.assertTrue(self.run_script("return document.getElementById('helpbox').open"))
        ActionChains(self.browser).send_keys(Keys.ESCAPE).perform()
        body.send_keys("p")
        self.wait("document.getElementById('play').textContent === 'stop'")
        body.send_keys("p")

    def test_screenshots_are_taken(self):
        volumes = self.run_script(
            "const {commands, description} = inspector.panes[0];"
            "return commands.findLastIndex(c => description.passes[c.pass].label.startsWith('step 3: volumes')) + 1")
        self.choose("buffer", "stencil")
        self.choose("wires", "command")
        self.go(volumes)
        # The middle one of the pixels in the torus's shadow.
        self.run_script("""
            const [pane] = inspector.panes, shadow = [];
            pane.buffer.values.forEach((count, i) => { if (count > 0 && count < 128) shadow.push(i); });
            const i = shadow[shadow.length >> 1];
            pane.view.pick(i % pane.view.width, Math.floor(i / pane.view.width));""")
        self.screenshot("inspector")
        self.choose("wires", "none")
        self.choose("buffer", "color")
        self.go(10**6)


class UnlikeFrames(PageTest):
    """Two frames with other passes, other buffers, of other sizes; one without stencil, one without a map."""

    ready = "document.body.dataset.readyMs"

    @classmethod
    def make_page(cls):
        page, frames = OUT / "unlike.html", SOURCE / "golden/frames"
        cls.frame = frames / "shadow-map-linear.frame"
        gnomon("inspect", cls.frame, "--compare", frames / "state-stencil-saturation.frame", "--out", page)
        return page

    def test_everything_is_shown_or_it_is_said_why_not(self):
        for buffer in self.run_script("return [...document.getElementById('buffer').options].map(o => o.value)"):
            Select(self.element("buffer")).select_by_value(buffer)
            for overlay in ("none", "counts", "depth", "stencil", "changed", "differs"):
                Select(self.element("overlay")).select_by_value(overlay)
                for scope in ("command", "pass"):
                    Select(self.element("scope")).select_by_value(scope)
                    for command in (1, 2, 5, 12):
                        self.run_script("inspector.go(arguments[0])", command)
                        self.assertTrue(self.run_script("return document.getElementById('error').hidden"))
            self.browser.find_element(By.TAG_NAME, "body").send_keys("x.]]][[[x")

    def test_a_pixel_of_the_map_has_the_maps_history(self):
        self.run_script("inspector.go(12)")
        number = self.run_script(
            "const {buffers} = inspector.panes[0].description; return buffers.findIndex(b => b.kind === 'depth' && b.width === 48)")
        Select(self.element("buffer")).select_by_value(f"#{number}")
        self.run_script("inspector.panes[0].view.pick(20, 17)")
        self.assertEqual(self.run_script("return inspector.history"),
                         json.loads(gnomon("history", self.frame, 20, 17, "--pass", 1, "--json")))


class LabPage(PageTest):
    ready = "document.body.dataset.ready"

    @classmethod
    def make_page(cls):
        page = OUT / "lab.html"
        gnomon("lab", "--page", page)
        return page

    def test_frames_have_the_programs_hashes(self):
        states = sorted((SOURCE / "tests/data/lab").glob("*.json"))
        self.assertEqual(len(states), 10)
        hashes = set()
        for state in states:
            page = self.run_script("return lab.hashesOf(JSON.parse(arguments[0]))", state.read_text())
            self.assertEqual(page, gnomon("lab", state).splitlines(), state.name)
            hashes.add(tuple(page))
        self.assertEqual(len(hashes), 10)

    def test_is_drawn_while_one_moves_things(self):
        self.run_script("lab.hashesOf({format: 'gnomon-lab', version: 1, stage: 'camera-in-shadow'})")
        times = sorted(self.run_script("return lab.measure(60)"))
        print(f"lab 640x480: median {times[30]:.1f} ms a frame, slowest {times[-1]:.1f} ms: {1000 / times[30]:.0f} frames a second")

    def test_a_control_changes_the_picture_at_once(self):
        before = self.run_script("return lab.hashesOf({format: 'gnomon-lab', version: 1, stage: 'camera-in-shadow'})")
        self.element("light_x_m").send_keys(Keys.ARROW_RIGHT)
        self.wait("document.getElementById('hashes').textContent !== " + json.dumps("\n".join(before)))

    def test_a_wrong_state_is_refused_and_the_old_one_stays(self):
        message = self.run_script("""
            const before = lab.state.stage;
            try { lab.hashesOf({format: 'gnomon-lab', version: 1, plates: 0}); } catch (error) {
              return [error.message, before === lab.state.stage]; }""")
        self.assertEqual(message, ["'plates' is 0, not a whole number from 1 to 600", True])

    def test_keyboard_alone_reaches_everything(self):
        self.expect_all_reached_by_tab()
        body = self.browser.find_element(By.TAG_NAME, "body")
        method = self.run_script("return lab.state.method")
        body.send_keys("z")
        self.wait(f"lab.state.method !== '{method}'")
        canvas = self.element("canvas")
        self.run_script("lab.view.moveTo(320, 150); lab.history = null")
        canvas.send_keys(Keys.ARROW_LEFT, Keys.ENTER)
        self.assertEqual(self.run_script("return [lab.history.x, lab.history.y]"), [319, 150])

    def test_screenshots_are_taken(self):
        shots = {
            "lab-camera": {"stage": "camera-in-shadow", "camera_tilt_deg": 18},
            "lab-cap": {"stage": "missing-cap"},
            "lab-overflow": {"stage": "overflow"},
            "lab-open": {"stage": "open-mesh"},
            "lab-acne": {"stage": "acne"},
        }
        for name, state in shots.items():
            # The middle one of the pixels where something was counted.
            self.run_script("""
                const {lab} = window;
                lab.hashesOf({format: 'gnomon-lab', version: 1, ...arguments[0]});
                const {passes} = lab.engine.describe(0, true), {width} = lab.view, counted = [];
                const counting = passes.findIndex((pass) => pass.label === 'shadow volumes');
                if (counting >= 0) {
                  const first = passes.slice(0, counting).reduce((n, pass) => n + pass.commands, 0);
                  const fates = lab.engine.fates(0, first, first + passes[counting].commands);
                  fates.raised.forEach((n, i) => { if (n > fates.lowered[i]) counted.push(i); });
                }
                const i = counted.length ? counted[counted.length >> 1] : 170 * width + 330;
                lab.view.pick(i % width, Math.floor(i / width));""", state)
            self.run_script("document.getElementById('wires').checked = arguments[0]; document.getElementById('wires').dispatchEvent(new Event('change'))",
                            name in ("lab-cap", "lab-open"))
            self.wait("document.getElementById('hashes').textContent")
            self.browser.execute_async_script("setTimeout(arguments[0], 300)")
            self.screenshot(name)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[4:]], verbosity=2)
