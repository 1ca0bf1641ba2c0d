// The buttons of the extension for Visual Studio Code, with an editor that only notes what it is asked for, and with our rsc.
// Run by scripts/editor.
//   node tests/lsp/commands.mjs RSC
import assert from "node:assert/strict";
import fs from "node:fs";
import Module, { createRequire } from "node:module";
import os from "node:os";
import path from "node:path";
import { fileURLToPath } from "node:url";

const rsc = path.resolve(process.argv[2]);
const root = path.resolve(path.dirname(fileURLToPath(import.meta.url)), "../..");
const folder = fs.mkdtempSync(path.join(os.tmpdir(), "rsl-"));
for (const name of ["robot.rsl", "robot.json", "touches.json"])
  fs.copyFileSync(path.join(root, "examples/touch_companion", name), path.join(folder, name));
const file = path.join(folder, "robot.rsl");

const settings = { rsc };
const noted = { tasks: [], errors: [], saved: 0, panels: [], picks: [] };
const document = { languageId: "rsl", isUntitled: false, uri: { fsPath: file }, save: async () => { noted.saved += 1; } };
const vscode = {
  workspace: { getConfiguration: () => ({ get: (name) => settings[name] }) },
  window: {
    activeTextEditor: { document },
    showErrorMessage: (text) => noted.errors.push(text),
    showQuickPick: async (all) => { noted.picks.push(all); return all[0]; },
    showInputBox: async () => "tcp:localhost:1",
    createWebviewPanel: (type, title) => {
      const panel = { webview: {}, title, onDidDispose: (gone) => { panel.dispose = gone; }, reveal: () => {} };
      noted.panels.push(panel);
      return panel;
    },
  },
  tasks: { executeTask: async (task) => { noted.tasks.push(task); } },
  ProcessExecution: class { constructor(process, args, how) { Object.assign(this, { process, args, ...how }); } },
  Task: class { constructor(kind, scope, name, source, execution) { Object.assign(this, { kind, name, execution }); } },
  TaskScope: { Workspace: 2 }, TaskRevealKind: { Always: 1 }, ViewColumn: { Beside: -2 },
};
const load = Module._load;
Module._load = (request, ...rest) => request === "vscode" ? vscode : load(request, ...rest);
const { commands } = createRequire(import.meta.url)(path.join(root, "editors/vscode/src/commands.js"));

async function asked(name) {
  noted.tasks.length = 0;
  await commands[name]();
  assert.equal(noted.tasks.length, 1, `${name}: ${noted.errors}`);
  assert.equal(noted.tasks[0].execution.process, rsc);
  return noted.tasks[0].execution.args;
}

const checks = {
  "every command has its button, and every button its command": async () => {
    const { contributes } = JSON.parse(fs.readFileSync(path.join(root, "editors/vscode/package.json"), "utf8"));
    const declared = contributes.commands.map((one) => one.command).filter((name) => name !== "rsl.restart");
    assert.deepEqual(declared, ["rsl.check", "rsl.run", "rsl.test", "rsl.timeline", "rsl.upload", "rsl.stop"]);
    assert.deepEqual(Object.keys(commands).sort(), [...declared].sort());
    assert.deepEqual(contributes.menus["editor/title"].map((one) => one.command), declared);
  },
  "check, test and run call rsc with the saved program": async () => {
    assert.deepEqual(await asked("rsl.check"), ["check", file]);
    assert.equal(noted.saved, 1);
    assert.deepEqual(await asked("rsl.test"), ["test", file]);
    assert.deepEqual(await asked("rsl.run"), ["run", file, "--scenario", path.join(folder, "touches.json")]);
  },
  "of several scenarios one is asked for": async () => {
    fs.copyFileSync(path.join(folder, "touches.json"), path.join(folder, "more.json"));
    assert.deepEqual(await asked("rsl.run"), ["run", file, "--scenario", path.join(folder, "more.json")]);
    assert.deepEqual(noted.picks.pop(), ["more.json", "touches.json"]);
    fs.rmSync(path.join(folder, "more.json"));
  },
  "upload and stop go to the port of the setting, or to the one that is asked for": async () => {
    assert.deepEqual(await asked("rsl.stop"), ["stop", "--port", "tcp:localhost:1"]);
    settings.port = "unix:/tmp/robot";
    assert.deepEqual(await asked("rsl.upload"), ["upload", file, "--port", "unix:/tmp/robot"]);
    assert.deepEqual(await asked("rsl.stop"), ["stop", "--port", "unix:/tmp/robot"]);
  },
  "the time line of a run is a page in one panel": async () => {
    await commands["rsl.timeline"]();
    await commands["rsl.timeline"]();
    assert.deepEqual(noted.errors, []);
    assert.equal(noted.panels.length, 1);
    assert.match(noted.panels[0].webview.html, /<!doctype html>[\s\S]*left_arm/i);
    noted.panels[0].dispose();
  },
  "a wrong program has no time line, and says why": async () => {
    fs.appendFileSync(file, "WHEN tuoch > 3 DO\n");
    await commands["rsl.timeline"]();
    assert.equal(noted.panels.length, 1);
    assert.match(noted.errors.pop(), /there is no run to show. error/);
  },
  "without a program nothing is called": async () => {
    noted.tasks.length = 0;
    vscode.window.activeTextEditor = undefined;
    for (const name of ["rsl.check", "rsl.run", "rsl.upload", "rsl.timeline"]) await commands[name]();
    assert.equal(noted.tasks.length, 0);
    assert.equal(noted.errors.splice(0).length, 4);
  },
};

let failed = 0;
for (const [name, run] of Object.entries(checks)) {
  try {
    await run();
  } catch (error) {
    failed += 1;
    console.error(`${name}: ${error.stack}`);
  }
}
fs.rmSync(folder, { recursive: true, force: true });
console.log(`${Object.keys(checks).length - failed} passed, ${failed} failed`);
process.exit(failed ? 1 : 0);
