"""A headless Chromium, driven through chromedriver's own protocol (W3C WebDriver): needs nothing but both programs."""

import base64
import json
import shutil
import subprocess
import tempfile
import time
import urllib.request

FLAGS = [
    "--headless",
    "--no-sandbox",  # root has none, as in a container
    "--disable-gpu",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--disable-dev-shm-usage",
]
KEYS = {"left": "\ue012", "up": "\ue013", "right": "\ue014", "down": "\ue015", "tab": "\ue004", "escape": "\ue00c"}
PATIENCE = 60  # s


class Browser:
    """A browser with one window; `with` ends it."""

    def __init__(self):
        self.profile = tempfile.mkdtemp()
        self.driver = subprocess.Popen(["chromedriver", "--port=0"], stdout=subprocess.PIPE, text=True)
        self.address = f"http://127.0.0.1:{self._port()}"
        options = {
            "browserName": "chrome",
            "goog:loggingPrefs": {"browser": "ALL"},
            "goog:chromeOptions": {"args": [*FLAGS, f"--user-data-dir={self.profile}"]},
        }
        answer = self._ask("POST", "/session", {"capabilities": {"alwaysMatch": options}})
        self.session = "/session/" + answer["sessionId"]

    def _port(self):
        for line in self.driver.stdout:
            if "successfully on port" in line:
                return int(line.rstrip(".\n").rsplit(" ", 1)[1])
        raise RuntimeError("chromedriver did not start")

    def __enter__(self):
        return self

    def __exit__(self, *_):
        try:
            self._ask("DELETE", self.session)
        finally:
            self.driver.terminate()
            self.driver.wait()
            shutil.rmtree(self.profile, ignore_errors=True)

    def _ask(self, method, path, body=None):
        data = None if body is None else json.dumps(body).encode()
        request = urllib.request.Request(self.address + path, data, {"Content-Type": "application/json"}, method=method)
        try:
            # The machine's proxy is not for this address.
            opener = urllib.request.build_opener(urllib.request.ProxyHandler({}))
            with opener.open(request, timeout=PATIENCE) as answer:
                return json.load(answer)["value"]
        except urllib.error.HTTPError as error:
            raise RuntimeError(f"{path}: {error.read().decode()}") from None

    def ask(self, path, body=None):
        """What the session answers to a command of the protocol."""
        return self._ask("POST", self.session + path, body or {})

    def devtools(self, command, **parameters):
        """A command of Chromium's own protocol."""
        return self.ask("/goog/cdp/execute", {"cmd": command, "params": parameters})

    def open(self, path, width=1200, height=900, phone=False, dark=False):
        """Opens a file, as a double click on it does, and waits until it is drawn."""
        self.devtools("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=phone)
        features = [{"name": "prefers-color-scheme", "value": "dark" if dark else "light"}]
        self.devtools("Emulation.setEmulatedMedia", features=features)
        self.ask("/url", {"url": path.as_uri()})
        self.wait("document.documentElement.dataset.ready === 'yes'")

    def run(self, script, *arguments):
        """The value of an expression on the page, in which `arguments` may be used; promises are waited for."""
        return self.ask("/execute/sync", {"script": f"return ({script})", "args": list(arguments)})

    def wait(self, condition):
        """Waits until an expression on the page is true."""
        end = time.monotonic() + PATIENCE
        while not self.run(condition):
            if time.monotonic() > end:
                raise AssertionError(f"never true: {condition}; {self.console()}")
            time.sleep(0.02)

    def console(self):
        """What the page wrote to the console since the last look."""
        return [entry["message"] for entry in self.ask("/se/log", {"type": "browser"})]

    def hover(self, selector, across=0.5, down=0.5):
        """Moves the mouse to a place within the first element of a selector, scrolled into view."""
        place = self.run(
            "(() => { const e = document.querySelector(arguments[0]); e.scrollIntoView({block: 'center', behavior: 'instant'});"
            " const b = e.getBoundingClientRect();"
            " return [b.left + arguments[1] * b.width, b.top + arguments[2] * b.height]; })()",
            selector, across, down,
        )
        self._mouse([self._move(*place)])
        return place

    def drag(self, selector, begin, end):
        """Drags the mouse across an element, from one part of its width to another."""
        start = self.hover(selector, begin)
        stop = self.run("document.querySelector(arguments[0]).getBoundingClientRect().left"
                        " + arguments[1] * document.querySelector(arguments[0]).clientWidth", selector, end)
        down, up = ({"type": kind, "button": 0} for kind in ("pointerDown", "pointerUp"))
        self._mouse([down, self._move((start[0] + stop) / 2, start[1]), self._move(stop, start[1]), up])

    def drag_down(self, selector, begin, end):
        """Drags the mouse along an element, from one part of its height to another."""
        x, start = self.hover(selector, 0.5, begin)
        height = self.run("document.querySelector(arguments[0]).getBoundingClientRect().height", selector)
        down, up = ({"type": kind, "button": 0} for kind in ("pointerDown", "pointerUp"))
        self._mouse([down, self._move(x, start + (end - begin) * height), up])

    def move(self, x, y):
        """Moves the mouse to a place of the window."""
        self._mouse([self._move(x, y)])

    @staticmethod
    def _move(x, y):
        return {"type": "pointerMove", "x": round(x), "y": round(y), "duration": 20}

    def _mouse(self, actions):
        self.ask("/actions", {"actions": [{"type": "pointer", "id": "mouse", "actions": actions}]})

    def press(self, *keys):
        """Presses keys, one after the other, wherever the focus is."""
        keys = [KEYS.get(key, key) for key in keys]
        actions = [{"type": kind, "value": key} for key in keys for kind in ("keyDown", "keyUp")]
        self.ask("/actions", {"actions": [{"type": "key", "id": "keyboard", "actions": actions}]})

    def screenshot(self, path):
        """Writes a picture of the whole page."""
        size = self.run("[document.documentElement.scrollWidth, document.documentElement.scrollHeight]")
        clip = {"x": 0, "y": 0, "width": size[0], "height": min(size[1], 16000), "scale": 1}
        shot = self.devtools("Page.captureScreenshot", format="png", captureBeyondViewport=True, clip=clip)
        path.write_bytes(base64.b64decode(shot["data"]))
