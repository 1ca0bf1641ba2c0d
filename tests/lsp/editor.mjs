// What an editor is made of, against what we have: the client library of Visual Studio Code talks to `rsc lsp`, and its
// highlighter reads every example. Run by scripts/editor, which has their packages.
//   node tests/lsp/editor.mjs FOLDER_WITH_node_modules RSC
import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import fs from "node:fs";
import { createRequire } from "node:module";
import os from "node:os";
import path from "node:path";
import { fileURLToPath, pathToFileURL } from "node:url";

const [packages, rsc] = process.argv.slice(2);
const require = createRequire(pathToFileURL(path.resolve(packages, "package.json")));
const lsp = require("vscode-languageserver-protocol/node");
const root = path.resolve(path.dirname(fileURLToPath(import.meta.url)), "../..");
const checks = [];
const check = (name, run) => checks.push({ name, run });

const ROBOT = JSON.stringify({
  sensors: [{ name: "touch", type: "VIRTUAL", channels: { LEVEL: { range: [0, 10] } } }],
  actuators: [{ name: "arm", type: "VIRTUAL", device: "joint", range: ["-60deg", "60deg"] }],
});
const RIGHT = "% ä🤖\nWHEN touch LEVEL > 3 DO LOG \"🤖\", touch LEVEL\nEND\n";

class Session {
  constructor() {
    this.folder = fs.mkdtempSync(path.join(os.tmpdir(), "rsl-"));
    fs.writeFileSync(path.join(this.folder, "robot.json"), ROBOT);
    this.uri = pathToFileURL(path.join(this.folder, "robot.rsl")).toString();
    this.process = spawn(rsc, ["lsp"], { stdio: ["pipe", "pipe", "inherit"] });
    this.exited = new Promise((done) => this.process.on("exit", done));
    this.line = lsp.createProtocolConnection(new lsp.StreamMessageReader(this.process.stdout),
                                             new lsp.StreamMessageWriter(this.process.stdin));
    this.shown = [];
    this.waiting = [];
    this.line.onNotification(lsp.PublishDiagnosticsNotification.type, (said) => {
      this.shown.push(said);
      this.waiting.splice(0).forEach((look) => look());
    });
    this.line.listen();
  }
  async begin(textDocument = {}) {
    const started = await this.line.sendRequest(lsp.InitializeRequest.type, {
      processId: process.pid, rootUri: null, workspaceFolders: null,
      capabilities: { general: { positionEncodings: ["utf-16"] }, textDocument } });
    await this.line.sendNotification(lsp.InitializedNotification.type, {});
    return started;
  }
  async open(text) {
    await this.line.sendNotification(lsp.DidOpenTextDocumentNotification.type, {
      textDocument: { uri: this.uri, languageId: "rsl", version: 1, text } });
  }
  async change(version, ...contentChanges) {
    await this.line.sendNotification(lsp.DidChangeTextDocumentNotification.type, {
      textDocument: { uri: this.uri, version }, contentChanges });
  }
  async diagnostics(version) {
    for (;;) {
      const said = this.shown.find((one) => one.uri === this.uri && one.version === version);
      if (said) return said.diagnostics;
      await new Promise((look) => this.waiting.push(look));
    }
  }
  async openRobot(text) {
    this.robot = pathToFileURL(path.join(this.folder, "robot.json")).toString();
    await this.line.sendNotification(lsp.DidOpenTextDocumentNotification.type, {
      textDocument: { uri: this.robot, languageId: "json", version: 1, text } });
  }
  // About the place of a word in a robot.json of one line.
  askRobot(type, text, word) {
    return this.line.sendRequest(type, {
      textDocument: { uri: this.robot }, position: { line: 0, character: text.indexOf(word) } });
  }
  ask(type, line, character, more = {}) {
    return this.line.sendRequest(type, { textDocument: { uri: this.uri }, position: { line, character }, ...more });
  }
  async end() {
    await this.line.sendRequest(lsp.ShutdownRequest.type);
    await this.line.sendNotification(lsp.ExitNotification.type);
    assert.equal(await this.exited, 0);
    fs.rmSync(this.folder, { recursive: true });
  }
}

check("a session: diagnostics, completion, hover, definition, rename, formatting, symbols", async () => {
  const session = new Session();
  const started = await session.begin();
  assert.equal(started.capabilities.positionEncoding, "utf-16");
  await session.open(RIGHT);
  assert.deepEqual(await session.diagnostics(1), []);
  // Behind a character outside of the basic plane, which JavaScript counts twice, as the protocol does.
  const line = RIGHT.split("\n")[1];
  const at = line.lastIndexOf("LEVEL");
  await session.change(2, { range: { start: { line: 1, character: at + 3 }, end: { line: 1, character: at + 4 } }, text: "" });
  const [wrong] = await session.diagnostics(2);
  assert.deepEqual(wrong.range, { start: { line: 1, character: at }, end: { line: 1, character: at + 4 } });
  const offered = await session.ask(lsp.CompletionRequest.type, 1, at);
  assert.ok(offered.items.some((item) => item.label === "LEVEL"));
  const actions = await session.line.sendRequest(lsp.CodeActionRequest.type, {
    textDocument: { uri: session.uri }, range: wrong.range, context: { diagnostics: [wrong] } });
  const fix = actions.find((action) => action.isPreferred);
  const [edit] = fix.edit.changes[session.uri];
  await session.change(3, { range: edit.range, text: edit.newText });
  assert.deepEqual(await session.diagnostics(3), []);
  assert.match((await session.ask(lsp.HoverRequest.type, 1, at + 1)).contents.value, /a channel of the sensor/);
  assert.match((await session.ask(lsp.DefinitionRequest.type, 1, at + 1)).uri, /robot\.json$/);
  await assert.rejects(session.ask(lsp.RenameRequest.type, 1, at + 1, { newName: "when" }), /is a word of RSL/);
  const edits = await session.line.sendRequest(lsp.DocumentFormattingRequest.type, {
    textDocument: { uri: session.uri }, options: { tabSize: 2, insertSpaces: true } });
  assert.ok(Array.isArray(edits));
  const symbols = await session.line.sendRequest(lsp.DocumentSymbolRequest.type, { textDocument: { uri: session.uri } });
  assert.equal(symbols[0].name, "WHEN touch LEVEL > 3 DO LOG \"🤖\", touch LEVEL");
  await session.end();
});

check("robot.json: completion, hover and outline, while it is no JSON yet", async () => {
  const session = new Session();
  await session.begin({ documentSymbol: { hierarchicalDocumentSymbolSupport: true } });
  await session.open(RIGHT);
  const text = '{"name": "🤖", "sensors": [{"name": "touch", "device": "hc-sr04", "trig';
  await session.openRobot(text);
  const ranged = (word, size) => ({ start: { line: 0, character: text.indexOf(word) },
                                    end: { line: 0, character: text.indexOf(word) + size } });
  const device = await session.askRobot(lsp.HoverRequest.type, text, "hc-sr04");
  assert.match(device.contents.value, /an ultrasonic distance sensor[^]*`trigger` and `echo`[^]*from 2cm to 400cm/);
  assert.deepEqual(device.range, ranged('"hc-sr04"', 9));
  const key = await session.askRobot(lsp.HoverRequest.type, text, '"device"');
  assert.match(key.contents.value, /a key of `sensor`/);
  const offered = await session.line.sendRequest(lsp.CompletionRequest.type, {
    textDocument: { uri: session.robot }, position: { line: 0, character: text.length } });
  assert.deepEqual(offered.items.find((item) => item.label === "trigger").textEdit.range, ranged('"trig', 5));
  const [section] = await session.line.sendRequest(lsp.DocumentSymbolRequest.type, { textDocument: { uri: session.robot } });
  assert.equal(section.name, "sensors");
  const [touch] = section.children;
  assert.equal(touch.kind, lsp.SymbolKind.Object);
  assert.deepEqual(touch.selectionRange, ranged("touch", 5));
  assert.deepEqual(touch.range.start, ranged('{"name": "touch"', 0).start);
  assert.equal(touch.range.end.character, text.length);
  await session.end();
});

check("a name of robot.json: its places and its new name, from both files", async () => {
  const session = new Session();
  await session.begin();
  const robot = JSON.stringify({ ...JSON.parse(ROBOT), groups: { arms: ["arm"] } });
  fs.writeFileSync(path.join(session.folder, "robot.json"), robot);
  const other = path.join(session.folder, "other.rsl");
  fs.writeFileSync(other, "% 🤖\nWHEN touch LEVEL > 3 DO MOVE arm TO 9deg\nEND\n");
  await session.open("% 🤖\nWHEN touch LEVEL > 5 DO MOVE arm TO 30deg\nEND\n");
  await session.openRobot(robot);
  const spot = (uri, line, character) => ({ textDocument: { uri }, position: { line, character } });
  const inGroup = spot(session.robot, 0, robot.lastIndexOf("arm"));
  const inProgram = spot(session.uri, 1, "WHEN touch LEVEL > 5 DO MOVE ".length);
  for (const place of [inGroup, inProgram]) {
    const found = await session.line.sendRequest(lsp.ReferencesRequest.type, { ...place, context: { includeDeclaration: true } });
    assert.deepEqual(found.map((one) => path.basename(one.uri)).sort(), ["other.rsl", "robot.json", "robot.json", "robot.rsl"]);
    const { changes } = await session.line.sendRequest(lsp.RenameRequest.type, { ...place, newName: "paw" });
    assert.deepEqual(Object.values(changes).map((edits) => edits.length).sort(), [1, 1, 2]);
    assert.ok(changes[pathToFileURL(other).toString()].every((edit) => edit.newText === "paw" && edit.range.start.line === 1));
    await assert.rejects(session.line.sendRequest(lsp.RenameRequest.type, { ...place, newName: "touch" }), /already/);
  }
  assert.equal((await session.line.sendRequest(lsp.DefinitionRequest.type, inGroup)).uri, session.robot);
  const prepared = await session.line.sendRequest(lsp.PrepareRenameRequest.type, inGroup);
  assert.deepEqual(prepared, { placeholder: "arm", range: {
    start: inGroup.position, end: { line: 0, character: inGroup.position.character + 3 } } });
  const shown = await session.line.sendRequest(lsp.DocumentHighlightRequest.type, inGroup);
  assert.deepEqual(shown.map((one) => one.kind), [lsp.DocumentHighlightKind.Write, lsp.DocumentHighlightKind.Read]);
  await session.end();
});

check("a request that is cancelled is answered once, and the next one too", async () => {
  const session = new Session();
  await session.begin();
  await session.open(RIGHT.repeat(400));
  const source = new lsp.CancellationTokenSource();
  const params = { textDocument: { uri: session.uri }, position: { line: 1, character: 6 } };
  const first = session.line.sendRequest(lsp.HoverRequest.type, params, source.token).catch((error) => error);
  source.cancel();
  const answer = await first;
  assert.ok(answer.code === lsp.LSPErrorCodes.RequestCancelled || answer.contents);
  assert.ok((await session.ask(lsp.HoverRequest.type, 1, 6)).contents);
  await session.end();
});

check("every word of every example has its colour", async () => {
  const oniguruma = require("vscode-oniguruma");
  const textmate = require("vscode-textmate");
  const wasm = require.resolve("vscode-oniguruma/release/onig.wasm");
  await oniguruma.loadWASM(fs.readFileSync(wasm).buffer);
  const file = path.join(root, "grammar/rsl.tmLanguage.json");
  const registry = new textmate.Registry({
    onigLib: Promise.resolve({ createOnigScanner: (patterns) => new oniguruma.OnigScanner(patterns),
                               createOnigString: (text) => new oniguruma.OnigString(text) }),
    loadGrammar: async () => textmate.parseRawGrammar(fs.readFileSync(file, "utf-8"), file) });
  const grammar = await registry.loadGrammar("source.rsl");
  const scopeAt = (line, at) => grammar.tokenizeLine(line, textmate.INITIAL).tokens
    .find((token) => token.startIndex <= at && at < token.endIndex).scopes.at(-1);
  assert.equal(scopeAt("  WHEN joy > 40% % and more", 15), "constant.numeric.rsl");
  assert.equal(scopeAt("  WHEN joy > 40% % and more", 20), "comment.line.rsl");
  assert.equal(scopeAt("DEFINE wave WITH how", 8), "entity.name.rsl");
  assert.equal(scopeAt("when touch LEVEL > 3", 1), "keyword.control.rsl");
  let lines = 0;
  for (const name of fs.readdirSync(path.join(root, "examples"))) {
    const text = fs.readFileSync(path.join(root, "examples", name, "robot.rsl"), "utf-8");
    let state = textmate.INITIAL;
    for (const line of text.split(/\r?\n/)) {
      const read = grammar.tokenizeLine(line, state);
      state = read.ruleStack;
      ++lines;
      for (const token of read.tokens) {
        const word = line.slice(token.startIndex, token.endIndex);
        const scope = token.scopes.at(-1);
        if (/^\s*[%#]/.test(line) && word.trim()) assert.equal(scope, "comment.line.rsl", line);
        if (scope === "source.rsl") assert.doesNotMatch(word, /["0-9]$|\b(WHEN|DO|END|THEN|AND|WITHIN)\b/, line);
      }
    }
  }
  assert.ok(lines > 300);
});

let failed = 0;
for (const { name, run } of checks) {
  try {
    await run();
    console.log(`ok    ${name}`);
  } catch (error) {
    ++failed;
    console.log(`FAIL  ${name}\n${error.stack}`);
  }
}
console.log(`${checks.length - failed} passed, ${failed} failed`);
process.exit(failed ? 1 : 0);
