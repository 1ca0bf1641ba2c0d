"""Headless Chromium, told what to do by the protocol of its developer tools, over pipes."""

import base64
import contextlib
import json
import os
import subprocess
import tempfile

SECONDS_TO_END = 20


class Browser:
    """One tab. To use in a `with` statement."""

    def __init__(self):
        self.profile = tempfile.TemporaryDirectory()
        self.last = 0
        self.events = []  # the names of those since the last page
        self.errors = []  # of its script

    def __enter__(self):
        to_browser, write = os.pipe()
        read, from_browser = os.pipe()
        command = ["chromium", "--headless", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage",
                   f"--user-data-dir={self.profile.name}", "--remote-debugging-pipe", "about:blank"]
        # It reads its orders from descriptor 3 and answers on 4.
        placed = ["sh", "-c", f'exec "$@" 3<&{to_browser} 4>&{from_browser}', "sh", *command]
        self.process = subprocess.Popen(placed, pass_fds=(to_browser, from_browser),
                                        stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        os.close(to_browser)
        os.close(from_browser)
        self.orders, self.answers = os.fdopen(write, "wb"), os.fdopen(read, "rb")
        self.session = None
        tab = self.call("Target.createTarget", url="about:blank")["targetId"]
        self.session = self.call("Target.attachToTarget", targetId=tab, flatten=True)["sessionId"]
        self.call("Page.enable")
        self.call("Runtime.enable")
        return self

    def __exit__(self, *_):
        self.session = None
        # It ends its other processes first. Killed, it would leave them, and they write to its profile for a moment.
        with contextlib.suppress(RuntimeError, OSError):
            self.call("Browser.close")
        try:
            self.process.wait(SECONDS_TO_END)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()
        self.orders.close()
        self.answers.close()
        self.profile.cleanup()

    def received(self):
        message = bytearray()
        while (byte := self.answers.read(1)) != b"\0":
            if not byte:
                raise RuntimeError("the browser has ended")
            message += byte
        return json.loads(message)

    def call(self, method, **parameters):
        self.last += 1
        order = {"id": self.last, "method": method, "params": parameters}
        if self.session:
            order["sessionId"] = self.session
        self.orders.write(json.dumps(order).encode() + b"\0")
        self.orders.flush()
        while (answer := self.received()).get("id") != self.last:
            self.note(answer)
        if "error" in answer:
            raise RuntimeError(f"{method}: {answer['error']['message']}")
        return answer["result"]

    def note(self, event):
        self.events.append(event.get("method"))
        if event.get("method") == "Runtime.exceptionThrown":
            details = event["params"]["exceptionDetails"]
            self.errors.append(details.get("exception", {}).get("description", details["text"]))

    def show(self, page, width=1300, height=1200):
        """`page`: a file. Returns when it is loaded and its script has run."""
        self.resize(width, height)
        self.events.clear()
        self.errors.clear()
        self.call("Page.navigate", url=page.as_uri())
        while "Page.loadEventFired" not in self.events:
            self.note(self.received())

    def resize(self, width, height=1200):
        self.call("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=False)

    def evaluate(self, expression):
        answer = self.call("Runtime.evaluate", expression=expression, returnByValue=True, awaitPromise=True)
        if "exceptionDetails" in answer:
            raise RuntimeError(answer["exceptionDetails"]["exception"]["description"])
        return answer["result"].get("value")

    def media(self, name):
        """"print", or "screen"."""
        self.call("Emulation.setEmulatedMedia", media=name)

    def vision(self, kind):
        """"protanopia", "achromatopsia", …, or "none"."""
        self.call("Emulation.setEmulatedVisionDeficiency", type=kind)

    def picture(self, place):
        """What is to be seen in a rectangle, as PNG."""
        return base64.b64decode(self.call("Page.captureScreenshot", clip={**place, "scale": 1})["data"])

    # What a person does with a mouse and a keyboard.

    def mouse(self, kind, x, y, **more):
        self.call("Input.dispatchMouseEvent", type=kind, x=x, y=y, **more)

    def point(self, x, y):
        self.mouse("mouseMoved", x, y)

    def drag(self, x, y, to_x, to_y):
        self.point(x, y)
        self.mouse("mousePressed", x, y, button="left", buttons=1, clickCount=1)
        for share in (0.5, 1):
            self.mouse("mouseMoved", x + (to_x - x) * share, y + (to_y - y) * share, button="left", buttons=1)
        self.mouse("mouseReleased", to_x, to_y, button="left", clickCount=1)

    def click(self, x, y):
        self.drag(x, y, x, y)

    def wheel(self, x, y, turned):
        self.mouse("mouseWheel", x, y, deltaX=0, deltaY=turned)

    def key(self, key):
        for kind in ("keyDown", "keyUp"):
            self.call("Input.dispatchKeyEvent", type=kind, key=key)
