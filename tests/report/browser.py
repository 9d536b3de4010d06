"""Chromium without a window, over the DevTools protocol's pipe: requests on its file descriptor 3, answers on 4, JSON
between zero bytes. https://chromedevtools.github.io/devtools-protocol/ And the tests of what every page must do in
it."""

import base64
import json
import os
import pathlib
import re
import select
import shutil
import subprocess
import sys
import tempfile
import time
import zlib

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from png_files import chunks  # noqa: E402

# A colour of the page as [red, green, blue], 0 to 255.
COLOUR = "(c => c.match(/[\\d.]+/g).slice(0, 3).map(Number))(getComputedStyle({}).{})"
# The colours of all texts and of what is behind them, each pair once. A canvas mixes the colours that lie one over the
# other.
TEXT_COLOURS = """(() => {
    const canvas = Object.assign(document.createElement("canvas"), {width: 1, height: 1});
    const context = canvas.getContext("2d", {willReadFrequently: true}), known = new Map();
    const mixed = colours => {
        const key = colours.join();
        if (!known.has(key)) {
            context.clearRect(0, 0, 1, 1);
            for (const colour of colours) { context.fillStyle = colour; context.fillRect(0, 0, 1, 1); }
            known.set(key, `rgb(${[...context.getImageData(0, 0, 1, 1).data.slice(0, 3)].join(", ")})`);
        }
        return known.get(key);
    };
    return [...new Set(Array.from(document.querySelectorAll("main *, header *"), e => {
        const texts = Array.from(e.childNodes).some(n => n.nodeType === 3 && n.textContent.trim());
        if (!texts || e.closest("title, style, script")) return null;
        const behind = [];
        for (let back = e; back; back = back.parentElement) behind.unshift(getComputedStyle(back).backgroundColor);
        const style = getComputedStyle(e), own = e.closest("svg") ? style.fill : style.color;
        return JSON.stringify([mixed([...behind, own]), mixed(behind)]);
    }))].filter(x => x).map(x => JSON.parse(x)); })()"""


def luminance(colour):
    """WCAG 2.1, relative luminance."""
    parts = [part / 255 for part in colour]
    linear = [part / 12.92 if part <= 0.04045 else ((part + 0.055) / 1.055)**2.4 for part in parts]
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]


def contrast(*colours):
    """Returns the contrast of two colours as a style has them."""
    bright, dark = sorted(
        (luminance([float(part) for part in re.findall(r"[\d.]+", colour)[:3]]) for colour in colours), reverse=True)
    return (bright + 0.05) / (dark + 0.05)


def first_pixel(png):
    """[red, green, blue] of the first pixel of a PNG of 8 bits a channel: no filter changes it."""
    packed = b"".join(content for kind, content in chunks(png) if kind == b"IDAT")
    return list(zlib.decompressobj().decompress(packed)[1:4])


class BrowserError(Exception):
    pass


def find_chromium():
    found = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
    if not found:
        raise AssertionError("Chromium is not installed; on Debian it is the package chromium")
    return found


def take_keep():
    """The folder of --keep DIR, which is taken out of the command line; None without it."""
    if "--keep" not in sys.argv:
        return None
    place = sys.argv.index("--keep")
    folder = pathlib.Path(sys.argv[place + 1])
    folder.mkdir(parents=True, exist_ok=True)
    del sys.argv[place:place + 2]
    return folder


class Browser:
    """One page. messages: what it wrote on its console, exceptions, and what the browser logged; requests: what it
    asked for."""
    def __init__(self, program, width=1400, height=900):
        self.profile = tempfile.TemporaryDirectory(prefix="report-chromium-", ignore_cleanup_errors=True)
        to_read, self.to = os.pipe()
        self.source, to_write = os.pipe()

        def place():  # whatever numbers the pipes have
            read, write = os.dup(to_read), os.dup(to_write)
            read, write = os.dup(read), os.dup(write)
            os.dup2(read, 3)
            os.dup2(write, 4)

        command = [
            program, "--headless=new", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage", "--no-first-run",
            "--hide-scrollbars", "--disable-extensions", "--disable-background-networking",
            "--force-device-scale-factor=1", "--remote-debugging-pipe", f"--user-data-dir={self.profile.name}",
            f"--window-size={width},{height}", "about:blank"
        ]
        environment = {**os.environ, "HOME": self.profile.name}
        self.process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                                        stderr=subprocess.DEVNULL, preexec_fn=place, close_fds=False, env=environment,
                                        start_new_session=True)
        os.close(to_read)
        os.close(to_write)
        self.buffer, self.number, self.session = b"", 0, None
        self.messages, self.requests, self.events = [], [], []
        target = next(one for one in self.call("Target.getTargets")["targetInfos"] if one["type"] == "page")
        self.session = self.call("Target.attachToTarget", targetId=target["targetId"], flatten=True)["sessionId"]
        for domain in ("Runtime", "Log", "Network", "Page"):
            self.call(domain + ".enable")

    def _message(self, deadline):
        while b"\0" not in self.buffer:
            left = deadline - time.monotonic()
            if left <= 0 or not select.select([self.source], [], [], left)[0]:
                raise BrowserError("Chromium did not answer in time")
            data = os.read(self.source, 1 << 20)
            if not data:
                raise BrowserError(f"Chromium has ended (status {self.process.poll()})")
            self.buffer += data
        text, self.buffer = self.buffer.split(b"\0", 1)
        return json.loads(text)

    def _event(self, message):
        method, given = message.get("method"), message.get("params", {})
        if method == "Runtime.consoleAPICalled":
            self.messages.append(f"console.{given['type']}: {given['args']}")
        elif method == "Runtime.exceptionThrown":
            details = given["exceptionDetails"]
            self.messages.append(f"exception: {details.get('exception', {}).get('description') or details['text']}")
        elif method == "Log.entryAdded":
            self.messages.append(f"log: {given['entry']['text']} {given['entry'].get('url', '')}")
        elif method == "Network.requestWillBeSent":
            self.requests.append(given["request"]["url"])
        self.events.append(method)

    def call(self, method, timeout=60, **parameters):
        self.number += 1
        request = {"id": self.number, "method": method, "params": parameters}
        if self.session:
            request["sessionId"] = self.session
        os.write(self.to, json.dumps(request).encode() + b"\0")
        deadline = time.monotonic() + timeout
        while True:
            message = self._message(deadline)
            if message.get("id") == self.number:
                if "error" in message:
                    raise BrowserError(f"{method}: {message['error']['message']}")
                return message["result"]
            self._event(message)

    def open(self, path):
        self.messages, self.requests, self.events = [], [], []
        self.call("Page.navigate", url="file://" + os.path.abspath(path))
        deadline = time.monotonic() + 60
        while "Page.loadEventFired" not in self.events:
            self._event(self._message(deadline))

    def run(self, expression):
        """The value of a JavaScript expression, which may be a promise."""
        answer = self.call("Runtime.evaluate", expression=expression, returnByValue=True, awaitPromise=True)
        if "exceptionDetails" in answer:
            raise BrowserError(f"{expression}: {answer['exceptionDetails']['exception'].get('description')}")
        return answer["result"].get("value")

    def press(self, x, y):
        for kind in ("mousePressed", "mouseReleased"):
            self.call("Input.dispatchMouseEvent", type=kind, x=x, y=y, button="left", clickCount=1)

    def close(self):
        try:
            self.session = None
            self.call("Browser.close", timeout=10)
        except (BrowserError, OSError):
            pass
        try:
            self.process.wait(timeout=10)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()
        os.close(self.to)
        os.close(self.source)
        self.profile.cleanup()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()


class PageTests:
    """What every page must do: follow light and dark, fit a narrow window, print. The test's class has a browser, the
    paths of its pages, and what stands below; its pictures and its PDF are left in the folder KEEP."""

    KEEP = None
    CLOSELY = None  # the page that is looked at closely
    REQUESTS = r"^file://.*\.html$"
    TEXTS = 6  # pairs of colours at least
    MARGIN = 24  # of paper, in mm, both sides together
    PAPER = (3, 40)  # pages
    WIDE = "table"  # what may be too wide for paper

    def load(self, name):
        self.browser.open(self.pages[name])

    def unfold(self):
        """Shows what is hidden at first."""

    def keep(self, name, data):
        if self.KEEP:
            (self.KEEP / name).write_bytes(base64.b64decode(data))

    def picture(self, name, width=1400):
        if self.KEEP:
            clip = {
                "x": 0, "y": 0, "width": width, "height": self.browser.run("document.documentElement.scrollHeight"),
                "scale": 1
            }
            self.keep(name, self.browser.call("Page.captureScreenshot", captureBeyondViewport=True, clip=clip)["data"])

    def is_quiet(self):
        self.assertEqual(self.browser.messages, [])
        for url in self.browser.requests:
            self.assertRegex(url, self.REQUESTS)

    def ground(self):
        return self.browser.run(COLOUR.format("document.body", "backgroundColor"))

    def can_be_read(self, scheme):
        texts = self.browser.run(TEXT_COLOURS)
        self.assertGreater(len(texts), self.TEXTS)
        for text, back in texts:
            self.assertGreaterEqual(contrast(text, back), 4.5, (scheme, text, back))

    def test_light_and_dark(self):
        seen = {}
        for scheme in ("light", "dark"):
            self.browser.call("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme",
                                                                       "value": scheme}])
            self.load(self.CLOSELY)
            seen[scheme] = self.ground()
            self.assertEqual(luminance(seen[scheme]) > 0.5, scheme == "light")
            # Text can be read everywhere: WCAG's 4.5 to 1.
            self.unfold()
            self.can_be_read(scheme)
            self.picture(f"{scheme}.png")
            self.is_quiet()
        for scheme in ("light", "dark"):  # it is dark
            self.browser.run("document.getElementById('theme').click()")
            self.assertEqual(self.ground(), seen[scheme])
        self.browser.run("try { localStorage.clear() } catch {}")
        self.browser.call("Emulation.setEmulatedMedia", features=[])

    def edge(self, place):
        """The colours at the right edge of a table that scrolls, above its first row: at the beginning, and at its
        end."""
        box = self.browser.run(f"""(e => {{ e.scrollIntoView({{block: "center"}}); const b = e.getBoundingClientRect();
            return [b.right - 3 + scrollX, b.y + scrollY + 2]; }})({place})""")
        seen = []
        for end in (0, 100000):
            self.browser.run(f"{place}.scrollLeft = {end}")
            clip = {"x": box[0], "y": box[1], "width": 2, "height": 2, "scale": 1}
            png = base64.b64decode(
                self.browser.call("Page.captureScreenshot", captureBeyondViewport=True, clip=clip)["data"])
            seen.append(first_pixel(png))
        return seen

    def test_narrow(self):
        self.browser.call("Emulation.setDeviceMetricsOverride", width=390, height=800, deviceScaleFactor=1, mobile=True)
        for name in sorted(self.pages, key=lambda name: name == self.CLOSELY):  # this one last
            self.load(name)
            self.assertLessEqual(self.browser.run("document.documentElement.scrollWidth"), 390, name)
        # A table that is cut at the edge has a sign of it, and none once it is scrolled to its end: one style for all.
        cut = "Array.from(document.querySelectorAll('.scroll:not(details:not([open]) *)'))" \
              ".filter(e => e.scrollWidth > e.clientWidth + 1)"
        count = self.browser.run(cut + ".length")
        self.assertGreater(count, 1)
        ground = self.ground()
        for number in range(2):
            begin, end = self.edge(f"{cut}[{number}]")
            self.assertGreater(max(abs(a - b) for a, b in zip(begin, ground)), 20, (number, begin))
            self.assertLess(max(abs(a - b) for a, b in zip(end, ground)), 8, (number, end))
        if self.KEEP:
            self.load(self.CLOSELY)
            self.picture("narrow.png", 390)
        self.browser.call("Emulation.clearDeviceMetricsOverride")

    def test_prints(self):
        self.browser.call("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": "dark"}])
        self.load(self.CLOSELY)
        data = self.browser.call("Page.printToPDF", printBackground=False, preferCSSPageSize=True)["data"]
        self.keep("page.pdf", data)
        pdf = base64.b64decode(data)
        self.assertTrue(pdf.startswith(b"%PDF-"))
        pages = len(re.findall(rb"/Type\s*/Page\b", pdf))
        self.assertTrue(self.PAPER[0] <= pages <= self.PAPER[1], pages)
        self.fits_paper()

    def fits_paper(self):
        """On paper it is light, and nothing is wider than it: 297 mm less the margins."""
        self.browser.call("Emulation.setEmulatedMedia", media="print",
                          features=[{"name": "prefers-color-scheme", "value": "dark"}])
        self.browser.call("Emulation.setDeviceMetricsOverride", width=round((297 - self.MARGIN) / 25.4 * 96),
                          height=1000, deviceScaleFactor=1, mobile=False)
        self.assertGreater(luminance(self.ground()), 0.9)
        wide = self.browser.run(
            f"Array.from(document.querySelectorAll('{self.WIDE}'), e => [e.id || e.tagName, "
            f"e.getBoundingClientRect().right]).filter(([, right]) => right > innerWidth + 1)"
        )
        self.assertEqual(wide, [])
        self.assertEqual(
            self.browser.run(
                "Array.from(document.querySelectorAll('nav'), e => getComputedStyle(e).display).filter(x => x !== "
                "'none')"
            ), [])
        self.browser.call("Emulation.clearDeviceMetricsOverride")
        self.browser.call("Emulation.setEmulatedMedia", media="", features=[])
