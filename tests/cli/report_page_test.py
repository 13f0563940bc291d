"""The report of tessera converge in a headless Chromium: the slider is moved, the numbers are read back.

report_page_test.py --screenshot OUT.png REPORT.html takes the picture that docs/converge.md shows.
"""

import json
import struct
import sys
import unittest

from chromium import PROGRAM, Chromium
from support import SLOWDOWN, TesseraTest

WIDE, PHONE = (1200, 1000), (390, 844)
EDGE = "parseFloat(getComputedStyle(document.querySelector('.stage')).getPropertyValue('--x'))"


def open_page(page, size=WIDE, **options):
    return Chromium(page, size, timeout=60 * SLOWDOWN, **options)


class Page(TesseraTest):
    """One report for all tests; each opens it anew."""

    @classmethod
    def setUpClass(cls):
        cls.maker = cls("setUp")
        cls.maker.setUp()
        cls.addClassCleanup(cls.maker.doCleanups)
        cls.maker.write_scene()
        cls.maker.expect(
            0, "converge", "a <scene>=scene.toml", "-o", "out", "--spp", "16", "--reference-spp", "64", "--vary", "max_depth=1,4",
            "--seeds", "2", "--history", "a <scene>/then@4440", "b=scene.toml", timeout=200,
        )  # fmt: skip
        cls.file = cls.maker.folder / "out" / "report.html"
        cls.report = json.loads((cls.maker.folder / "out" / "report.json").read_text())

    def browse(self, size=WIDE, **options):
        browser = open_page(self.file, size, **options)
        self.addCleanup(browser.close)
        return browser

    def edge(self, browser):
        """Where the edge stands, in percent; range and pictures agree with it."""
        edge = browser.evaluate(EDGE)
        self.assertAlmostEqual(float(browser.evaluate("document.querySelector('.slider input').value")), edge, delta=0.06)
        left, _, width, _ = browser.evaluate(
            "(() => { const b = document.querySelector('.stage').getBoundingClientRect(); return [b.left, b.top, b.width, b.height]; })()"
        )
        handle = browser.evaluate("(() => { const b = document.querySelector('.handle').getBoundingClientRect(); return b.left + 1; })()")
        self.assertAlmostEqual(handle, left + width * edge / 100, delta=1)
        return edge

    def test_a_pointer_drags_the_edge(self):
        browser = self.browse()
        self.assertEqual(self.edge(browser), 50)
        left, top, width, height = browser.box(".stage")
        y = top + height / 2
        before = self.picture(browser)
        browser.pointer("mousePressed", left + width / 2, y)
        for share in (0.6, 0.7, 0.8):
            browser.pointer("mouseMoved", left + width * share, y)
        self.assertAlmostEqual(self.edge(browser), 80, delta=0.3)
        browser.pointer("mouseMoved", left + 2 * width, y)  # beyond its end
        self.assertEqual(self.edge(browser), 100)
        browser.pointer("mouseMoved", left + width * 0.25, y)
        browser.pointer("mouseReleased", left + width * 0.25, y)
        self.assertAlmostEqual(self.edge(browser), 25, delta=0.3)
        browser.hover(left + width * 0.9, y)  # let go
        self.assertAlmostEqual(self.edge(browser), 25, delta=0.3)
        self.assertNotEqual(self.picture(browser), before, "what is seen has changed")
        self.assertEqual(browser.complaints(), [])

    def picture(self, browser):
        path = self.folder / "shot.png"
        browser.screenshot(path)
        return path.read_bytes()

    def test_keys_and_fingers_move_it_too(self):
        browser = self.browse()
        browser.evaluate("document.querySelector('.slider input').focus()")
        for _ in range(5):
            browser.key("ArrowRight", 39)
        self.assertAlmostEqual(self.edge(browser), 50.5, delta=0.01)
        browser.key("Home", 36)
        self.assertEqual(self.edge(browser), 0)
        phone = self.browse(PHONE, touch=True)
        left, top, width, height = phone.box(".stage")
        y = top + height / 2
        phone.finger([(left + width * share, y) for share in (0.5, 0.45, 0.35, 0.2)])
        self.assertAlmostEqual(self.edge(phone), 20, delta=1)

    def test_pictures_and_heat_maps_are_chosen(self):
        browser = self.browse()

        def choose(which, value):
            browser.evaluate(
                f"(() => {{ const s = document.querySelectorAll('.slider')[0].querySelectorAll('select')[{which}];"
                f" s.value = '{value}'; s.dispatchEvent(new Event('change', {{bubbles: true}})); }})()"
            )

        def shown(side):
            return browser.evaluate(
                f"[...document.querySelectorAll('.sheet img')].find(i => i.src === document.querySelector('.on-{side}').src)?.id"
            )

        self.assertEqual((shown("left"), shown("right")), ("p0-0-picture", "p0-1-picture"))
        choose(0, "p0-2")
        self.assertEqual(shown("left"), "p0-2-picture")
        choose(2, "flip")
        # The reference has no error: it stays itself.
        self.assertEqual((shown("left"), shown("right")), ("p0-2-picture", "p0-1-flip"))
        self.assertIn("reference", browser.evaluate("document.querySelector('.name.left').textContent"))
        sizes = browser.evaluate("[...document.querySelectorAll('img')].map(i => [i.naturalWidth, i.naturalHeight])")
        self.assertTrue(sizes and all(s == [48, 32] for s in sizes), sizes)

    def test_the_numbers_are_those_of_the_json(self):
        browser = self.browse()
        self.assertEqual(browser.evaluate("JSON.parse(document.getElementById('report').textContent)"), self.report)
        found = browser.evaluate(
            "[...document.querySelectorAll('section')].map(s => [s.querySelector('h2').textContent,"
            " [...s.querySelectorAll('tr[data-series]')].map(r => [r.dataset.series,"
            " Object.fromEntries([...r.querySelectorAll('[data-key]')].map(c => [c.dataset.key, [+c.dataset.value, c.textContent, c.firstChild.textContent]]))])])"
        )
        self.assertEqual([name for name, _ in found], ["a <scene>", "b"])
        for (_, rows), scene in zip(found, self.report["scenes"]):
            self.assertEqual([label for label, _ in rows], [s["label"] for s in scene["series"]])
            for (_, cells), series in zip(rows, scene["series"]):
                for key in ("relmse", "rmse", "flip"):
                    self.assertEqual(cells[key][0], series["error"][key]["value"])
                self.assertEqual(cells["efficiency"][0], series["efficiency"]["value"])
                self.assertEqual(cells["slope_spp"][0], series["slope"]["spp"]["value"])
                # What is read is that number, and its interval.
                value, low = series["error"]["relmse"]["value"], series["error"]["relmse"]["low"]
                self.assertAlmostEqual(float(cells["relmse"][2]) / value, 1, delta=0.005)
                self.assertIn(" to ", cells["relmse"][1])
                self.assertLess(low, value)
        self.assertIn("74 min", browser.evaluate("document.querySelector('tbody tr').textContent"))

    def test_a_point_of_a_curve_says_its_values(self):
        browser = self.browse()
        left, top, width, height = browser.box(".plots .series:nth-of-type(1) .mark:last-of-type")
        browser.hover(left + width / 2 + 3, top + height / 2 + 3)
        tip = browser.evaluate("(() => { const t = document.querySelector('.tip'); return t.hidden ? null : t.textContent; })()")
        self.assertIn("max_depth=1\nrelMSE ", tip or "nothing is shown")
        self.assertIn("16 spp", tip)
        browser.hover(2, 2)
        self.assertTrue(browser.evaluate("document.querySelector('.tip').hidden"))

    def test_buttons_choose_the_kind_of_error(self):
        browser = self.browse()
        browser.evaluate("document.querySelector('.choice button[data-kind=flip]').click()")
        seen = browser.evaluate(
            "[...document.querySelector('section').querySelectorAll('.plots')].filter(p => p.offsetHeight > 0).map(p => p.dataset.kind)"
        )
        self.assertEqual(seen, ["flip"])
        labels = browser.evaluate("[...document.querySelectorAll('.plots[data-kind=flip] svg')].map(s => s.getAttribute('aria-label'))")
        self.assertIn("a <scene>: FLIP against samples", labels)

    def test_it_fits_a_desk_and_a_phone_by_day_and_by_night(self):
        grounds = set()
        for size, dark in ((WIDE, False), (WIDE, True), (PHONE, False), (PHONE, True)):
            browser = self.browse(size, dark=dark, touch=size == PHONE)
            self.assertLessEqual(browser.evaluate("document.documentElement.scrollWidth"), size[0], "nothing sticks out")
            self.assertGreater(browser.evaluate("document.querySelector('svg.plot').getBoundingClientRect().width"), 330)
            text = browser.evaluate("document.querySelector('.plot .tick').getBoundingClientRect().height")
            self.assertGreater(text, 9, "ticks can be read")
            grounds.add((dark, browser.evaluate("getComputedStyle(document.body).backgroundColor")))
            self.assertEqual(browser.complaints(), [])
            browser.close()
        self.assertEqual(len(grounds), 2, "dark and light are two")

    def test_the_screenshot_is_one(self):
        take_screenshot(self.file, self.folder / "page.png")
        data = (self.folder / "page.png").read_bytes()
        width, height = struct.unpack(">II", data[16:24])
        self.assertEqual(width, round(WIDE[0] * SCALE))
        self.assertGreater(height, 600)
        self.assertGreater(len(data), 20000)


SCALE = 0.74


def take_screenshot(page, path):
    """From the top to the end of the first slider, whose edge was moved."""
    with open_page(page, (1200, 820)) as browser:
        left, top, width, height = browser.box(".stage")
        browser.pointer("mousePressed", left + width / 2, top + height / 2)
        browser.pointer("mouseMoved", left + width * 0.58, top + height / 2)
        browser.pointer("mouseReleased", left + width * 0.58, top + height / 2)
        browser.evaluate("scrollTo(0, 0)")
        end = browser.evaluate("document.querySelector('.slider').getBoundingClientRect().bottom")
        browser.screenshot(path, {"x": 0, "y": 0, "width": 1200, "height": end + 12, "scale": SCALE})


if __name__ == "__main__":
    if not PROGRAM:
        print("chromium is not here (Debian: apt-get install chromium)")
        sys.exit(77)
    if sys.argv[1:2] == ["--screenshot"]:
        take_screenshot(sys.argv[3], sys.argv[2])
    else:
        unittest.main()
