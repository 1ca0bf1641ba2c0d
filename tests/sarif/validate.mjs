// Reads paths of SARIF logs, one a line, and prints what the official schema of SARIF 2.1.0 says against them: a JSON object,
// {path: [where and what]}.
//   node tests/sarif/validate.mjs FOLDER_WITH_node_modules
import fs from "node:fs";
import { createRequire } from "node:module";
import path from "node:path";
import { pathToFileURL } from "node:url";

const require = createRequire(pathToFileURL(path.resolve(process.argv[2], "package.json")));
const Ajv = require("ajv");
const read = file => JSON.parse(fs.readFileSync(file, "utf8"));

// The schema is written in draft 4.
const ajv = new Ajv({ schemaId: "id", meta: false, format: "full", allErrors: true, jsonPointers: true });
ajv.addMetaSchema(require("ajv/lib/refs/json-schema-draft-04.json"));
const validate = ajv.compile(require("@microsoft/jest-sarif/lib/schemas/sarif-2.1.0-rtm.5.json"));

const found = {};
for (const file of fs.readFileSync(0, "utf8").split("\n").filter(Boolean))
  found[file] = validate(read(file)) ? [] : validate.errors.map(error => `${error.dataPath} ${error.message}`);
console.log(JSON.stringify(found));
