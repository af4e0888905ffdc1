"""A headless Chromium, driven over its DevTools protocol by a pair of pipes."""

import base64
import contextlib
import fcntl
import io
import json
import os
import select
import shutil
import subprocess
import tempfile
import time

import tools

try:
    from PIL import Image
except ImportError as error:
    tools.skip(f"{error}; install the package python3-pil")

# Software draws, so its commands need not cross to a process for graphics, which takes a fifth of a test's processor time.
FLAGS = (
    "--headless", "--no-sandbox", "--disable-gpu", "--in-process-gpu", "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader", "--disable-quic", "--no-first-run",
    "--disable-background-networking", "--disable-component-update", "--disable-sync",
    "--disable-extensions", "--hide-scrollbars", "--remote-debugging-pipe")
WAIT_SECONDS = 120  # for anything at all, on a busy machine
# Software draws every pixel here, so pages are drawn at half their size and without antialiasing,
# which is six times cheaper. Their layout stays the same.
SCALE = 0.5
WITHOUT_ANTIALIASING = """{
  const get = HTMLCanvasElement.prototype.getContext;
  HTMLCanvasElement.prototype.getContext = function(kind, options) {
    return get.call(this, kind, kind.startsWith('webgl') ? {...options, antialias: false} : options);
  };
}"""


def find_chromium():
    return shutil.which("chromium") or tools.skip("no chromium; install the package chromium")


def write_pair(path):
    """A pair as a .json file of Duet: a sample, and the same person who stands before it."""
    tools.duet("convert", tools.sample("kick"), "--out", path).check_returncode()
    motion = json.loads(path.read_text(encoding="utf-8"))
    motion["follower"] = [[(x, y, z + 1.2) for x, y, z in pose] for pose in motion["leader"]]
    path.write_text(json.dumps(motion), encoding="utf-8")
    return motion


class BrowserTest(tools.FolderTest):
    """Tests that share a browser, whose pages are closed after each test, and a temporary folder."""

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.browser = Browser()
        cls.addClassCleanup(cls.browser.close)

    def open_page(self, url, **size):
        page = self.browser.open(url, **size)
        self.addCleanup(page.close)
        return page


class Browser:
    """One browser process; every page is a new tab of it. Pages share storage until `forget`."""

    def __init__(self):
        self._context = None
        self._profile = tempfile.TemporaryDirectory(ignore_cleanup_errors=True)
        # Chromium reads commands from descriptor 3 and writes answers to 4, so ours are above 16.
        ours = [fcntl.fcntl(fd, fcntl.F_DUPFD, 16) for fd in os.pipe() + os.pipe()]
        theirs_in, self._commands, self._answers, theirs_out = ours

        def connect():
            os.dup2(theirs_in, 3)
            os.dup2(theirs_out, 4)

        self._process = subprocess.Popen(
            [find_chromium(), *FLAGS, f"--user-data-dir={self._profile.name}", "about:blank"],
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, preexec_fn=connect,
            pass_fds=(3, 4))
        os.close(theirs_in)
        os.close(theirs_out)
        self._buffer = b""
        self._last_id = 0
        self.events = []

    def close(self):
        with contextlib.suppress(AssertionError, OSError):
            self.call("Browser.close")
        try:
            self._process.wait(timeout=30)
        except subprocess.TimeoutExpired:
            self._process.kill()
        self._profile.cleanup()

    def call(self, method, session=None, **parameters):
        """Sends a command and returns its result. Stores events that arrive before it."""
        self._last_id += 1
        message = {"id": self._last_id, "method": method, "params": parameters}
        if session:
            message["sessionId"] = session
        os.write(self._commands, json.dumps(message).encode() + b"\0")
        deadline = time.monotonic() + WAIT_SECONDS
        while True:
            answer = self.read(deadline)
            if answer.get("id") == self._last_id:
                assert "error" not in answer, f"{method}: {answer['error']}"
                return answer["result"]
            self.events.append(answer)

    def read(self, deadline):
        """The next message, which must arrive by `deadline` (of time.monotonic)."""
        while b"\0" not in self._buffer:
            left = deadline - time.monotonic()
            ready = left > 0 and select.select([self._answers], [], [], left)[0]
            assert ready, f"chromium did not answer in {WAIT_SECONDS} s"
            data = os.read(self._answers, 1 << 20)
            assert data, "chromium ended"
            self._buffer += data
        message, self._buffer = self._buffer.split(b"\0", 1)
        return json.loads(message)

    def forget(self):
        """Closes all pages; pages opened later find nothing that these have stored."""
        if self._context:
            self.call("Target.disposeBrowserContext", browserContextId=self._context)
        self._context = self.call("Target.createBrowserContext")["browserContextId"]
        self.events.clear()

    def new_tab(self):
        """The session of a new tab."""
        within = {"browserContextId": self._context} if self._context else {}
        target = self.call("Target.createTarget", url="about:blank", **within)["targetId"]
        return self.call("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]

    def open(self, url, width=640, height=420, still=False, sharp=False):
        """Opens a tab. `still`: the visitor prefers reduced motion. `sharp`: drawn in full size, for people."""
        return Page(self, url, width, height, still, sharp)


class Page:
    """A tab that has opened a URL, and has drawn it once or failed."""

    def __init__(self, browser, url, width, height, still, sharp):
        self._browser = browser
        self._session = browser.new_tab()
        self.call("Emulation.setDeviceMetricsOverride", width=width, height=height,
                  deviceScaleFactor=1 if sharp else SCALE, mobile=False)
        for domain in ("Page", "Runtime", "Network"):
            self.call(f"{domain}.enable")
        if still:
            self.call("Emulation.setEmulatedMedia",
                      features=[{"name": "prefers-reduced-motion", "value": "reduce"}])
        if not sharp:
            self.call("Page.addScriptToEvaluateOnNewDocument", source=WITHOUT_ANTIALIASING)
        self._load("Page.navigate", url=url)

    def reload(self):
        """As the visitor's browser does it."""
        self._load("Page.reload")

    def _load(self, method, **parameters):
        loads = len(self.events("Page.loadEventFired")) + 1
        self.call(method, **parameters)
        # Before this event, a command may run in the page of before.
        deadline = time.monotonic() + WAIT_SECONDS
        while len(self.events("Page.loadEventFired")) < loads:
            self._browser.events.append(self._browser.read(deadline))
        self.wait_until("['ready', 'failed'].includes(document.documentElement.dataset.state)")

    def call(self, method, **parameters):
        return self._browser.call(method, session=self._session, **parameters)

    def close(self):
        self.call("Page.close")

    def evaluate(self, expression):
        """The value of a JavaScript expression, awaited if it is a promise."""
        result = self.call("Runtime.evaluate", expression=expression, awaitPromise=True,
                           returnByValue=True)
        assert "exceptionDetails" not in result, result["exceptionDetails"]
        return result["result"].get("value")

    def wait_until(self, condition):
        deadline = time.monotonic() + WAIT_SECONDS
        while not self.evaluate(f"Boolean({condition})"):
            assert time.monotonic() < deadline, f"{condition} did not come true: {self.state()}"
            self.next_frame()

    def next_frame(self):
        """Waits until the page may have drawn."""
        self.evaluate("new Promise((resolve) => requestAnimationFrame("
                      "() => requestAnimationFrame(() => resolve())))")

    def state(self):
        """The page's state: data-* attributes of its root element."""
        return self.evaluate("({...document.documentElement.dataset})")

    def text(self, selector):
        return self.evaluate(f"document.querySelector({json.dumps(selector)}).textContent")

    def events(self, method):
        return [event["params"] for event in self._browser.events
                if event.get("method") == method and event.get("sessionId") == self._session]

    def press(self, key):
        """A real key stroke."""
        for kind in ("keyDown", "keyUp"):
            text = key if len(key) == 1 and kind == "keyDown" else ""
            self.call("Input.dispatchKeyEvent", type=kind, key=key, text=text)
        self.next_frame()

    def mouse(self, kind, x, y, buttons=1):
        self.call("Input.dispatchMouseEvent", type=kind, x=x, y=y, button="left", buttons=buttons,
                  clickCount=1)

    def click(self, selector):
        """A real click in the middle of an element."""
        x, y = self.evaluate(
            f"(() => {{ const box = document.querySelector({json.dumps(selector)})"
            ".getBoundingClientRect();"
            " return [box.left + box.width / 2, box.top + box.height / 2]; })()")
        self.mouse("mousePressed", x, y)
        self.mouse("mouseReleased", x, y, buttons=0)
        self.next_frame()

    def drag(self, start, end):
        self.mouse("mousePressed", *start)
        self.mouse("mouseMoved", *end)
        self.mouse("mouseReleased", *end, buttons=0)
        self.next_frame()

    def picture(self):
        return Picture(base64.b64decode(self.call("Page.captureScreenshot", format="png")["data"]))


class Picture:
    """The pixels of a page."""

    def __init__(self, png):
        self._image = Image.open(io.BytesIO(png)).convert("RGB")

    def count(self, is_wanted, left=0.25, right=0.9, top=0.1, bottom=0.85):
        """Pixels of the stage (away from the panels) whose (red, green, blue) is wanted, in pixels of
        the layout."""
        width, height = self._image.size
        stage = self._image.crop([int(share) for share in (left * width, top * height, right * width, bottom * height)])
        return sum(is_wanted(*pixel) for pixel in stage.getdata()) / SCALE ** 2
