"""A Chromium driven through the W3C WebDriver protocol, with the standard library alone."""

import base64
import json
import shutil
import socket
import subprocess
import tempfile
import time
import urllib.error
import urllib.request

ELEMENT = "element-6066-11e4-a52e-4f735466cecf"  # the protocol's name for a reference to an element
KEYS = {
    "tab": "\ue004", "escape": "\ue00c", "space": " ", "home": "\ue011", "shift": "\ue008",
    "left": "\ue012", "up": "\ue013", "right": "\ue014", "down": "\ue015",
}


class BrowserError(RuntimeError):
    """What chromedriver answered in place of a result."""


def available():
    """Whether chromedriver and a Chromium for it to drive are installed."""
    return bool(shutil.which("chromedriver") and shutil.which("chromium"))


def _free_port():
    with socket.socket() as s:
        s.bind(("127.0.0.1", 0))
        return s.getsockname()[1]


class Browser:
    """A headless Chromium; used in a with statement, which ends driver, browser and profile whatever happens."""

    def __init__(self, width=1280, height=1000):
        self._size = (width, height)
        self._driver = None
        self._session = None
        self._profile = None

    def __enter__(self):
        self._profile = tempfile.TemporaryDirectory(prefix="actformer-browser-", ignore_cleanup_errors=True)
        try:
            self._start_driver()
            self._open_session()
        except BaseException:
            self.__exit__()
            raise
        return self

    def __exit__(self, *_):
        try:
            if self._session:
                self._ask("DELETE", "")
        except (OSError, BrowserError):
            pass  # a browser that is gone already needs no closing
        finally:
            if self._driver:
                self._driver.terminate()
                try:
                    self._driver.wait(timeout=10)
                except subprocess.TimeoutExpired:
                    self._driver.kill()
                    self._driver.wait()
            self._profile.cleanup()

    def _start_driver(self):
        port = _free_port()
        self._base = f"http://127.0.0.1:{port}"
        self._driver = subprocess.Popen(["chromedriver", f"--port={port}"], stdout=subprocess.DEVNULL,
                                        stderr=subprocess.DEVNULL)
        end = time.monotonic() + 30
        while time.monotonic() < end and self._driver.poll() is None:
            try:
                if self._send("GET", "/status")["ready"]:
                    return
            except OSError:
                time.sleep(0.1)
        raise BrowserError("chromedriver did not start within 30 s")

    def _open_session(self):
        width, height = self._size
        arguments = ["--headless=new", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run",
                     "--disable-background-networking", "--disable-component-update", "--disable-sync",
                     f"--user-data-dir={self._profile.name}", f"--window-size={width},{height}"]
        wanted = {"goog:chromeOptions": {"args": arguments},
                  "goog:loggingPrefs": {"browser": "ALL", "performance": "ALL"}}
        answer = self._send("POST", "/session", {"capabilities": {"alwaysMatch": wanted}})
        self._session = answer["sessionId"]

    def _send(self, method, path, body=None):
        data = None if body is None else json.dumps(body).encode()
        request = urllib.request.Request(self._base + path, data, {"Content-Type": "application/json"},
                                         method=method)
        # No proxy: the driver is on this machine whatever the environment says.
        opener = urllib.request.build_opener(urllib.request.ProxyHandler({}))
        try:
            with opener.open(request, timeout=120) as response:
                return json.load(response)["value"]
        except urllib.error.HTTPError as e:
            value = json.load(e)["value"]
            raise BrowserError(f"{value['error']}: {value['message'].splitlines()[0]}") from None

    def _ask(self, method, path, body=None):
        return self._send(method, f"/session/{self._session}{path}", body)

    def open(self, url):
        self._ask("POST", "/url", {"url": url})

    def run(self, script, *arguments):
        """The value that `script`, the body of a function, returns."""
        return self._ask("POST", "/execute/sync", {"script": script, "args": list(arguments)})

    def wait(self, script, *arguments, seconds=10):
        """Waits until `script` returns something true and gives that; None when it never did."""
        end = time.monotonic() + seconds
        while True:
            value = self.run(script, *arguments)
            if value or time.monotonic() > end:
                return value or None
            time.sleep(0.05)

    def find(self, selector):
        return self._ask("POST", "/element", {"using": "css selector", "value": selector})[ELEMENT]

    def click(self, selector):
        self._ask("POST", f"/element/{self.find(selector)}/click", {})

    def press(self, *keys, held=None):
        """Presses keys of KEYS or characters, one after the other, `held` down all the while."""
        actions = [{"type": "keyDown", "value": KEYS[held]}] if held else []
        for key in keys:
            value = KEYS.get(key, key)
            actions += [{"type": "keyDown", "value": value}, {"type": "keyUp", "value": value}]
        if held:
            actions.append({"type": "keyUp", "value": KEYS[held]})
        self._ask("POST", "/actions", {"actions": [{"type": "key", "id": "keyboard", "actions": actions}]})

    def drag(self, selector, dx, dy):
        """Drags from the middle of an element."""
        element = {ELEMENT: self.find(selector)}
        actions = [{"type": "pointerMove", "origin": element, "x": 0, "y": 0},
                   {"type": "pointerDown", "button": 0},
                   {"type": "pointerMove", "origin": element, "x": dx, "y": dy, "duration": 100},
                   {"type": "pointerUp", "button": 0}]
        pointer = {"type": "pointer", "id": "mouse", "parameters": {"pointerType": "mouse"}, "actions": actions}
        self._ask("POST", "/actions", {"actions": [pointer]})

    def resize(self, width, height):
        """Gives the page a viewport of exactly this size, below the least width of a window too."""
        self.command("Emulation.setDeviceMetricsOverride",
                     {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": False})

    def command(self, name, parameters):
        """A command of the Chrome DevTools protocol."""
        return self._ask("POST", "/goog/cdp/execute", {"cmd": name, "params": parameters})

    def log(self, kind):
        """Entries of the "browser" or "performance" log since it was last asked for."""
        return self._ask("POST", "/se/log", {"type": kind})

    def screenshot(self, selector=None):
        """A PNG of the window, or of one element."""
        path = f"/element/{self.find(selector)}/screenshot" if selector else "/screenshot"
        return base64.b64decode(self._ask("GET", path))

    def whole_page(self):
        """A PNG of the page from top to bottom."""
        # From the top: what is sticky belongs there. With the scroll bar's width: the picture has none.
        width, height = self.run("scrollTo(0, 0); return [innerWidth, document.documentElement.scrollHeight]")
        shot = self.command("Page.captureScreenshot", {
            "captureBeyondViewport": True, "clip": {"x": 0, "y": 0, "width": width, "height": height, "scale": 1}})
        return base64.b64decode(shot["data"])

    def print_pdf(self):
        return base64.b64decode(self._ask("POST", "/print", {"background": True}))
