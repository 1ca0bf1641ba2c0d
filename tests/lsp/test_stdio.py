"""`rsc lsp` as an editor starts it: over its two pipes, from the first message to its exit code."""

import json
import random
import re
import subprocess
import tempfile
import unittest
from pathlib import Path

from client import PATIENCE, RSC, Server, offset_of, position, range_of, uri
from programs import ROBOT, large

PROGRAM = "% \u00e4\U0001F916\nWHEN touch LEVEL > 3\nDO MOVE arms TO 30deg OVER 1s\nEND\n"


def message(body):
    data = json.dumps(body).encode()
    return b"Content-Length: %d\r\n\r\n" % len(data) + data


class Session(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.program = Path(folder.name) / "robot.rsl"
        (Path(folder.name) / "robot.json").write_text(ROBOT)

    def server(self, **how):
        server = Server(**how)
        self.addCleanup(server.__exit__)
        return server

    def test_a_session(self):
        server = self.server()
        server.open(self.program, PROGRAM)
        self.assertEqual(server.diagnostics(self.program), [])
        wrong = PROGRAM.replace("LEVEL", "LEVL")
        server.change(self.program, 2, {"text": wrong})
        shown = server.diagnostics(self.program, 2)
        at = wrong.index("LEVL")
        self.assertEqual([one["range"] for one in shown], [range_of(wrong, at, at + 4)])
        items = server.at("completion", self.program, position(wrong, at))["items"]
        self.assertIn("LEVEL", [item["label"] for item in items])
        server.change(self.program, 3, {"range": range_of(wrong, at, at + 4), "text": "LEVEL"})
        self.assertEqual(server.diagnostics(self.program, 3), [])
        place = server.at("definition", self.program, position(PROGRAM, PROGRAM.index("arms")))
        self.assertEqual(offset_of(ROBOT, place["range"]["start"]), ROBOT.index("arms"))
        self.assertEqual(server.end(), 0)

    def test_robot_json_while_it_is_no_json(self):
        server = self.server(capabilities={"textDocument": {"documentSymbol": {"hierarchicalDocumentSymbolSupport": True}}})
        robot = self.program.with_name("robot.json")
        text = '{"name": "\U0001F916", "sensors": [{"name": "eye", "device": "hc-sr04", "trig'
        server.open(robot, text)
        at = text.index('"hc-sr04"')
        said = server.at("hover", robot, position(text, at))
        self.assertIn("an ultrasonic distance sensor", said["contents"]["value"])
        self.assertEqual(said["range"], range_of(text, at, at + len('"hc-sr04"')))
        sections = server.ask("textDocument/documentSymbol", textDocument={"uri": uri(robot)})
        [eye] = sections[0]["children"]
        at = text.index("eye")
        self.assertEqual(eye["selectionRange"], range_of(text, at, at + 3))
        self.assertEqual(eye["range"], range_of(text, text.index('{"name": "eye"'), len(text)))

    def test_exit_codes(self):
        server = self.server()
        server.send({"method": "exit"})
        self.assertEqual(server.process.wait(PATIENCE), 1)
        server = self.server()
        server.process.stdin.close()
        self.assertEqual(server.process.wait(PATIENCE), 1)
        server = self.server(initialize=False)
        server.process.stdin.close()
        self.assertEqual(server.process.wait(PATIENCE), 0)
        server = self.server()
        server.ask("shutdown")
        server.process.stdin.close()
        self.assertEqual(server.process.wait(PATIENCE), 0)

    def test_what_came_before_the_end_of_the_line_is_answered(self):
        asked = [{"id": 1, "method": "initialize", "params": {"capabilities": {}}},
                 {"method": "textDocument/didOpen",
                  "params": {"textDocument": {"uri": uri(self.program), "version": 1, "text": PROGRAM}}},
                 {"id": 2, "method": "textDocument/hover", "params": {}},
                 {"id": 3, "method": "textDocument/foldingRange", "params": {"textDocument": {"uri": uri(self.program)}}}]
        ran = subprocess.run([RSC, "lsp"], input=b"".join(message({"jsonrpc": "2.0", **one}) for one in asked),
                             stdout=subprocess.PIPE, timeout=PATIENCE, check=False)
        said = [json.loads(body) for body in re.findall(rb"\r\n\r\n(\{.*?\})(?=Content-Length|$)", ran.stdout, re.S)]
        self.assertEqual([one["id"] for one in said if "id" in one], [1, 2, 3])
        self.assertEqual(said[1]["error"]["code"], -32602)
        self.assertNotIn("json", said[1]["error"]["message"])
        self.assertEqual([one["method"] for one in said if "method" in one], ["textDocument/publishDiagnostics"])
        self.assertEqual(ran.returncode, 1)

    def test_a_header_that_is_none_ends_it_with_an_error(self):
        server = self.server(initialize=False)
        server.write(b"WHEN touch LEVEL > 3\r\n\r\n")
        self.assertEqual(server.wait(None)["error"]["code"], -32700)
        self.assertEqual(server.process.wait(PATIENCE), 1)

    def test_a_message_may_come_in_pieces(self):
        server = self.server()
        for byte in message({"jsonrpc": "2.0", "id": 77, "method": "shutdown"}):
            server.write(bytes([byte]))
        self.assertIn("result", server.wait(77))

    def test_a_request_that_is_taken_back_at_once_is_not_begun(self):
        server = self.server()
        server.open(self.program, large())
        where = {"textDocument": {"uri": uri(self.program)}, "position": {"line": 1, "character": 4}}
        server.write(message({"jsonrpc": "2.0", "id": 70, "method": "textDocument/hover", "params": where}) +
                     message({"jsonrpc": "2.0", "id": 71, "method": "textDocument/hover", "params": where}) +
                     message({"jsonrpc": "2.0", "method": "$/cancelRequest", "params": {"id": 71}}))
        self.assertEqual(server.wait(71)["error"]["code"], -32800)
        self.assertIn("result", server.wait(70))

    def test_what_is_typed_at_once_is_looked_at_once(self):
        server = self.server()
        server.open(self.program, PROGRAM)
        server.diagnostics(self.program, 1)
        changes = b"".join(
            message({"jsonrpc": "2.0", "method": "textDocument/didChange",
                     "params": {"textDocument": {"uri": uri(self.program), "version": version},
                                "contentChanges": [{"range": range_of(PROGRAM, 0, 0), "text": "% x\n"}]}})
            for version in range(2, 202))
        server.write(changes)
        self.assertEqual(server.diagnostics(self.program, 201), [])
        self.assertEqual(server.end(), 0)
        published = 0
        while not server.notes.empty():
            published += server.notes.get()["method"] == "textDocument/publishDiagnostics"
        self.assertLess(published, 100)

    def test_random_bytes_end_it_in_order(self):
        draw = random.Random(5)
        pieces = [b"Content-Length: ", b"\r\n\r\n", b"\r\n", b"20", b"{}", b"\x00", b"\xff", b"7", b"-",
                  message({"id": 1, "method": "initialize", "params": {}}), b'{"id":1,"method":"x"}']
        for _ in range(40):
            server = self.server(initialize=False)
            try:
                for _ in range(draw.randrange(30)):
                    server.write(draw.choice(pieces))
                server.process.stdin.close()
            except BrokenPipeError:
                pass  # it has ended already
            self.assertIn(server.process.wait(PATIENCE), (0, 1))


if __name__ == "__main__":
    unittest.main()
