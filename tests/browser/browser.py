"""A headless Chromium, driven through chromedriver's own protocol (W3C WebDriver): needs nothing but both programs."""

import base64
import json
import shutil
import subprocess
import tempfile
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

    def open(self, path, width=1200, media="screen", dark=False):
        """Opens a file, as a double click on it does."""
        self.devtools("Emulation.setDeviceMetricsOverride", width=width, height=900, deviceScaleFactor=1, mobile=width < 600)
        features = [{"name": "prefers-color-scheme", "value": "dark" if dark else "light"}]
        self.devtools("Emulation.setEmulatedMedia", media=media, features=features)
        self.ask("/url", {"url": path.as_uri()})

    def run(self, script, *arguments):
        """The value of an expression on the page, in which `arguments` may be used."""
        return self.ask("/execute/sync", {"script": f"return ({script})", "args": list(arguments)})

    def console(self):
        """What the page wrote to the console since the last look."""
        return [entry["message"] for entry in self.ask("/se/log", {"type": "browser"})]

    def pdf(self):
        """The page as it is printed."""
        return base64.b64decode(self.devtools("Page.printToPDF", preferCSSPageSize=True)["data"])
