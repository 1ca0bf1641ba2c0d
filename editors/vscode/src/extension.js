// The client: starts `rsc lsp` and hands the editor's texts to it. Everything else is the server's, but for the buttons
// (commands.js).
"use strict";

const vscode = require("vscode");
const { LanguageClient } = require("vscode-languageclient/node");
const { commands } = require("./commands");

let client;

function makeClient() {
  const command = vscode.workspace.getConfiguration("rsl").get("rsc") || "rsc";
  const server = { command, args: ["lsp"] };
  const texts = {
    // robot.json, and STEM.json beside STEM.rsl: the server knows which of them belong to a program.
    documentSelector: [{ language: "rsl" }, { scheme: "file", language: "json" }],
  };
  return new LanguageClient("rsl", "RSL", server, texts);
}

async function start() {
  client = makeClient();
  try {
    await client.start();
  } catch (error) {
    vscode.window.showErrorMessage(
      `RSL: the language server does not start (${error.message}). Say in the setting rsl.rsc where rsc is.`);
  }
}

async function stop() {
  const old = client;
  client = undefined;
  if (old && old.isRunning()) await old.stop();
}

exports.activate = async (context) => {
  for (const [name, run] of Object.entries(commands))
    context.subscriptions.push(vscode.commands.registerCommand(name, run));
  context.subscriptions.push(
    vscode.commands.registerCommand("rsl.restart", async () => {
      await stop();
      await start();
    }));
  await start();
};

exports.deactivate = stop;
