// What the buttons and commands do: each calls rsc with the program that is shown. A verb that prints runs as a task, in
// the terminal; the time line of a run is a page, shown beside the program.
"use strict";

const { execFile } = require("node:child_process");
const fs = require("node:fs");
const os = require("node:os");
const path = require("node:path");
const vscode = require("vscode");

const settings = () => vscode.workspace.getConfiguration("rsl");
const rsc = () => settings().get("rsc") || "rsc";

// The program that is shown, saved; nothing when none is.
async function program() {
  const editor = vscode.window.activeTextEditor;
  if (!editor || editor.document.languageId !== "rsl" || editor.document.isUntitled) {
    vscode.window.showErrorMessage("RSL: open a program (.rsl) first.");
    return undefined;
  }
  await editor.document.save();
  return editor.document.uri;
}

function task(title, args, cwd) {
  const call = new vscode.ProcessExecution(rsc(), args, { cwd });
  const made = new vscode.Task({ type: "rsl", verb: args[0] }, vscode.TaskScope.Workspace, title, "rsl", call);
  made.presentationOptions = { reveal: vscode.TaskRevealKind.Always, clear: true };
  return vscode.tasks.executeTask(made);
}

// Where a robot answers, by `rsc ports`: nobody should have to know the name of a serial line.
function ports() {
  return new Promise((done) => execFile(rsc(), ["ports", "--format", "json"], (error, out) => {
    done(error ? [] : JSON.parse(out).filter((seen) => seen.port && seen.board).map((seen) => seen.port));
  }));
}

async function port() {
  const said = settings().get("port");
  if (said) return said;
  const found = await ports();
  if (found.length === 1) return found[0];
  if (found.length > 1) return vscode.window.showQuickPick(found, { placeHolder: "At which port is the robot?" });
  return vscode.window.showInputBox({ prompt: "At which port is the robot?", placeHolder: "/dev/ttyACM0" });
}

function isScenario(file) {
  try {
    return Array.isArray(JSON.parse(fs.readFileSync(file, "utf8")).stimuli);
  } catch {
    return false;
  }
}

// What the sensors measure in a run: the scenario beside the program; which one, when there are several.
async function scenario(file) {
  const folder = path.dirname(file);
  const all = fs.readdirSync(folder).filter((name) => name.endsWith(".json") && isScenario(path.join(folder, name)));
  const one = all.length > 1 ? await vscode.window.showQuickPick(all, { placeHolder: "With which scenario?" }) : all[0];
  return one ? ["--scenario", path.join(folder, one)] : [];
}

async function onProgram(verb, more = async () => []) {
  const uri = await program();
  if (!uri) return;
  const file = uri.fsPath;
  await task(`${verb} ${path.basename(file)}`, [verb, file, ...await more(file)], path.dirname(file));
}

async function onRobot(verb, withProgram) {
  const uri = withProgram ? await program() : undefined;
  if (withProgram && !uri) return;
  const where = await port();
  if (!where) return;
  const file = uri ? [uri.fsPath] : [];
  await task(`${verb} at ${where}`, [verb, ...file, "--port", where], uri && path.dirname(uri.fsPath));
}

// One panel, which shows the latest run.
let panel;

function show(page, title) {
  if (!panel) {
    panel = vscode.window.createWebviewPanel("rsl.timeline", title, vscode.ViewColumn.Beside, {
      enableScripts: true, retainContextWhenHidden: true });
    panel.onDidDispose(() => { panel = undefined; });
  }
  panel.title = title;
  panel.webview.html = page;
  panel.reveal(undefined, true);
}

async function timeline() {
  const uri = await program();
  if (!uri) return;
  const file = uri.fsPath;
  const inputs = await scenario(file);
  const folder = fs.mkdtempSync(path.join(os.tmpdir(), "rsl-"));
  const page = path.join(folder, "run.html");
  const said = await new Promise((done) => execFile(
    rsc(), ["run", file, ...inputs, "--html", page], { cwd: path.dirname(file) },
    (error, out, err) => done(error ? err || error.message : "")));
  if (said) vscode.window.showErrorMessage(`RSL: there is no run to show. ${said.split("\n")[0]}`);
  else show(fs.readFileSync(page, "utf8"), `Run of ${path.basename(file)}`);
  fs.rmSync(folder, { recursive: true, force: true });
}

exports.commands = {
  "rsl.check": () => onProgram("check"),
  "rsl.run": () => onProgram("run", scenario),
  "rsl.test": () => onProgram("test"),
  "rsl.timeline": timeline,
  "rsl.upload": () => onRobot("upload", true),
  "rsl.stop": () => onRobot("stop", false),
};
