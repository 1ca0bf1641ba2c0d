"""A client of the language server over stdio, as an editor is one. Python's strings count code points, the protocol counts
UTF-16: the conversion here shares no code with the server."""

import json
import os
import queue
import subprocess
import threading

RSC = os.environ.get("ROBOSYNC_RSC", "build/host/rsc")
PATIENCE = 60  # seconds for one answer, on a loaded machine


def utf16(text):
    """UTF-16 units of a text."""
    return len(text.encode("utf-16-le")) // 2


def position(text, offset):
    """The position of a code point, as the protocol writes it."""
    before = text[:offset]
    line = before.count("\n")
    return {"line": line, "character": utf16(before[before.rfind("\n") + 1:])}


def range_of(text, begin, end):
    return {"start": position(text, begin), "end": position(text, end)}


def offset_of(text, place):
    """The code point at a position."""
    start = 0
    for _ in range(place["line"]):
        start = text.index("\n", start) + 1
    units = 0
    while units < place["character"]:
        units += utf16(text[start])
        start += 1
    return start


def uri(path):
    return "file://" + str(path)


class Server:
    """rsc lsp, and what it has said."""

    def __init__(self, initialize=True, capabilities=None, command=None):
        self.process = subprocess.Popen(command or [RSC, "lsp"], stdin=subprocess.PIPE, stdout=subprocess.PIPE)
        self.answers, self.notes, self.ids = {}, queue.Queue(), 0
        self.come = threading.Condition()
        self.ended = False
        self.listener = threading.Thread(target=self._listen, daemon=True)
        self.listener.start()
        if initialize:
            self.capabilities = self.ask("initialize", processId=None, rootUri=None,
                                         capabilities=capabilities or {})["capabilities"]
            self.tell("initialized")

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.kill()
        self.process.wait()
        self.listener.join(PATIENCE)
        try:
            self.process.stdin.close()
        except BrokenPipeError:
            pass
        self.process.stdout.close()

    def _listen(self):
        stream = self.process.stdout
        while header := stream.readline():
            length = int(header.split(b":")[1])
            assert stream.readline() == b"\r\n"
            message = json.loads(stream.read(length))
            with self.come:
                if "method" in message:
                    self.notes.put(message)
                else:
                    self.answers[message["id"]] = message
                self.come.notify_all()
        with self.come:
            self.ended = True
            self.come.notify_all()

    def write(self, data):
        self.process.stdin.write(data)
        self.process.stdin.flush()

    def send(self, message):
        body = json.dumps({"jsonrpc": "2.0", **message}).encode()
        self.write(b"Content-Length: %d\r\n\r\n" % len(body) + body)

    def tell(self, method, **params):
        self.send({"method": method, "params": params})

    def request(self, method, **params):
        """Asks, and gives the id to wait for."""
        self.ids += 1
        self.send({"id": self.ids, "method": method, "params": params})
        return self.ids

    def wait(self, number):
        with self.come:
            assert self.come.wait_for(lambda: number in self.answers or self.ended, PATIENCE), "no answer"
            return self.answers.pop(number)

    def ask(self, method, **params):
        answer = self.wait(self.request(method, **params))
        assert "error" not in answer, answer
        return answer["result"]

    def refused(self, method, **params):
        return self.wait(self.request(method, **params))["error"]

    def note(self, method):
        """The next notification of this kind."""
        while True:
            message = self.notes.get(timeout=PATIENCE)
            if message["method"] == method:
                return message["params"]

    def diagnostics(self, path, version=None):
        """What is said of a file, of this version if it matters."""
        while True:
            said = self.note("textDocument/publishDiagnostics")
            if said["uri"] == uri(path) and version in (None, said.get("version")):
                return said["diagnostics"]

    def open(self, path, text, version=1):
        self.tell("textDocument/didOpen",
                  textDocument={"uri": uri(path), "languageId": "rsl", "version": version, "text": text})

    def change(self, path, version, *changes):
        self.tell("textDocument/didChange", textDocument={"uri": uri(path), "version": version},
                  contentChanges=list(changes))

    def at(self, method, path, place, **more):
        return self.ask("textDocument/" + method, textDocument={"uri": uri(path)}, position=place, **more)

    def end(self):
        """Its exit code, when it is asked to end."""
        self.ask("shutdown")
        self.send({"method": "exit"})
        return self.process.wait(PATIENCE)
