"""Drives a headless Chromium over the DevTools protocol, through pipes: no port and no package but Chromium itself."""
import json
import os
import select
import shutil
import subprocess
import sys
import tempfile
import time

NAMES = ("chromium", "chromium-browser", "google-chrome")
MISSING = ("Chromium is not installed: on Debian install the package chromium, on Ubuntu, which has it as a snap only, "
           "run `sudo snap install chromium`")


class Browser:
    """One page. Collects what goes wrong in it: errors on the console, exceptions, requests to a network."""

    def __init__(self, width=1200, height=900):
        program = next((path for path in map(shutil.which, NAMES) if path), None)
        if program is None:
            sys.exit(MISSING)
        self.profile = tempfile.TemporaryDirectory(ignore_cleanup_errors=True)
        self.errors = []
        self.events = []
        self.buffer = b""
        self.number = 0
        to_read, self.to = os.pipe()
        self.back, from_write = os.pipe()

        def pipes():  # Chromium reads descriptor 3 and writes descriptor 4
            high_read, high_write = os.dup(to_read), os.dup(from_write)
            spare_read, spare_write = os.dup(high_read), os.dup(high_write)
            os.dup2(spare_read, 3)
            os.dup2(spare_write, 4)

        self.process = subprocess.Popen(
            [program, "--headless", "--no-sandbox", "--disable-gpu", "--hide-scrollbars", "--no-first-run",
             "--disable-dev-shm-usage", "--remote-debugging-pipe", f"--window-size={width},{height}",
             f"--user-data-dir={self.profile.name}"],
            stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, close_fds=False,
            preexec_fn=pipes)
        os.close(to_read)
        os.close(from_write)
        self.session = None
        target = self.call("Target.createTarget", url="about:blank")["targetId"]
        self.session = self.call("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        for domain in ("Page", "Runtime", "Log", "Network"):
            self.call(domain + ".enable")

    def close(self):
        try:
            self.session = None
            self.call("Browser.close")
            self.process.wait(20)
        finally:
            self.process.kill()
            self.process.wait()
            self.profile.cleanup()

    def _next(self, deadline):
        while b"\0" not in self.buffer:
            ready, _, _ = select.select([self.back], [], [], max(0.0, deadline - time.monotonic()))
            if not ready:
                raise TimeoutError("Chromium did not answer in time")
            data = os.read(self.back, 1 << 20)
            if not data:
                raise RuntimeError("Chromium ended")
            self.buffer += data
        message, self.buffer = self.buffer.split(b"\0", 1)
        return json.loads(message)

    def _note(self, message):
        method, params = message.get("method"), message.get("params", {})
        if method == "Runtime.exceptionThrown":
            self.errors.append(f"exception: {params['exceptionDetails']}")
        elif method == "Runtime.consoleAPICalled" and params["type"] in ("error", "warning", "assert"):
            self.errors.append(f"console: {params['args']}")
        elif method == "Log.entryAdded" and params["entry"]["level"] in ("error", "warning"):
            self.errors.append(f"log: {params['entry']}")
        elif method == "Network.requestWillBeSent" and not params["request"]["url"].startswith(("file:", "data:")):
            self.errors.append(f"request: {params['request']['url']}")
        self.events.append(method)

    def call(self, method, **params):
        self.number += 1
        message = {"id": self.number, "method": method, "params": params}
        if self.session:
            message["sessionId"] = self.session
        os.write(self.to, json.dumps(message).encode() + b"\0")
        deadline = time.monotonic() + 60
        while True:
            answer = self._next(deadline)
            if answer.get("id") != self.number:
                self._note(answer)
            elif "error" in answer:
                raise RuntimeError(f"{method}: {answer['error']}")
            else:
                return answer["result"]

    def open(self, path):
        self.call("Page.navigate", url="file://" + path)
        deadline = time.monotonic() + 60
        while "Page.loadEventFired" not in self.events:
            self._note(self._next(deadline))

    def value(self, expression):
        result = self.call("Runtime.evaluate", expression=expression, returnByValue=True, awaitPromise=True)
        if "exceptionDetails" in result:
            raise RuntimeError(f"{expression}: {result['exceptionDetails']}")
        return result["result"].get("value")

    def mouse(self, kind, x, y, held):
        self.call("Input.dispatchMouseEvent", type=kind, x=x, y=y, button="left" if held else "none",
                  buttons=1 if held and kind != "mouseReleased" else 0, clickCount=1 if held else 0)

    def key(self, name):
        for kind in ("keyDown", "keyUp"):
            self.call("Input.dispatchKeyEvent", type=kind, key=name, code=name)

    def screenshot(self, clip=None, whole=False):
        """The PNG in base64: what is seen, a part of it, or the whole page."""
        options = {"captureBeyondViewport": whole}
        if clip:
            options["clip"] = dict(clip, scale=1)
        return self.call("Page.captureScreenshot", **options)["data"]
