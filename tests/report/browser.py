"""Chromium without a window, over the DevTools protocol's pipe: requests on its file descriptor 3, answers on 4, JSON between zero bytes.
https://chromedevtools.github.io/devtools-protocol/"""

import json
import os
import re
import select
import shutil
import subprocess
import tempfile
import time


# A colour of the page as [red, green, blue], 0 to 255.
COLOUR = "(c => c.match(/[\\d.]+/g).slice(0, 3).map(Number))(getComputedStyle({}).{})"
# The colours of all texts and of what is behind them, each pair once. A canvas mixes the colours that lie one over the other.
TEXT_COLOURS = """(() => {
    const context = Object.assign(document.createElement("canvas"), {width: 1, height: 1}).getContext("2d", {willReadFrequently: true}), known = new Map();
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
        if (!Array.from(e.childNodes).some(n => n.nodeType === 3 && n.textContent.trim()) || e.closest("title, style, script")) return null;
        const behind = [];
        for (let back = e; back; back = back.parentElement) behind.unshift(getComputedStyle(back).backgroundColor);
        return JSON.stringify([mixed([...behind, e.closest("svg") ? getComputedStyle(e).fill : getComputedStyle(e).color]), mixed(behind)]);
    }))].filter(x => x).map(x => JSON.parse(x)); })()"""


def luminance(colour):
    """WCAG 2.1, relative luminance."""
    parts = [part / 255 for part in colour]
    linear = [part / 12.92 if part <= 0.04045 else ((part + 0.055) / 1.055) ** 2.4 for part in parts]
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]


def contrast(*colours):
    """Of two colours as a style has them."""
    bright, dark = sorted((luminance([float(part) for part in re.findall(r"[\d.]+", colour)[:3]]) for colour in colours), reverse=True)
    return (bright + 0.05) / (dark + 0.05)


class BrowserError(Exception):
    pass


def find_chromium():
    return shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")


class Browser:
    """One page. messages: what it wrote on its console, exceptions, and what the browser logged; requests: what it asked for."""

    def __init__(self, program, width=1400, height=900):
        self.profile = tempfile.TemporaryDirectory(prefix="report-chromium-", ignore_cleanup_errors=True)
        to_read, self.to = os.pipe()
        self.source, to_write = os.pipe()

        def place():  # whatever numbers the pipes have
            read, write = os.dup(to_read), os.dup(to_write)
            read, write = os.dup(read), os.dup(write)
            os.dup2(read, 3)
            os.dup2(write, 4)

        command = [program, "--headless=new", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage", "--no-first-run", "--hide-scrollbars",
                   "--disable-extensions", "--disable-background-networking", "--force-device-scale-factor=1", "--remote-debugging-pipe",
                   f"--user-data-dir={self.profile.name}", f"--window-size={width},{height}", "about:blank"]
        environment = {**os.environ, "HOME": self.profile.name}
        self.process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                                        preexec_fn=place, close_fds=False, env=environment, start_new_session=True)
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
            self.messages.append(f"exception: {given['exceptionDetails'].get('exception', {}).get('description') or given['exceptionDetails']['text']}")
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
