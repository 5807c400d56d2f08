// Tests of the page in a real browser against a real `graze view`:
//
//   node tests/browser/run.mjs --graze PROGRAM --tools FOLDER [--screenshots FOLDER] [--only WORD] [--page HTML]
//
// FOLDER of the tools has node_modules with playwright-core and axe-core, as the target page_tools makes it. HTML is a
// page to be tried instead of the one in the program.
import { mkdirSync, mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import { parseArgs } from "node:util";
import { Bench } from "./bench.mjs";
import { cases as doing } from "./doing.mjs";
import { cases as forms } from "./forms.mjs";
import { cases as journey } from "./journey.mjs";
import { cases as looking } from "./looking.mjs";
import { cases as partsOfPage } from "./parts.mjs";
import { cases as pictures } from "./pictures.mjs";
import { cases as safety } from "./safety.mjs";

const { values: options } = parseArgs({
  options: {
    graze: { type: "string" },
    tools: { type: "string" },
    screenshots: { type: "string" },
    only: { type: "string" },
    browser: { type: "string", default: "/usr/bin/chromium" },
    page: { type: "string" },
  },
});
if (!options.graze || !options.tools) throw new Error("--graze and --tools are needed");

const folder = mkdtempSync(join(tmpdir(), "graze-browser-"));
const screenshots = resolve(options.screenshots ?? join(folder, "screenshots"));
mkdirSync(screenshots, { recursive: true });
const bench = new Bench({
  graze: resolve(options.graze),
  tools: resolve(options.tools),
  browser: options.browser,
  folder,
  screenshots,
  html: options.page,
});
let failed = 0;
try {
  await bench.prepare();
  for (const [name, test] of [...partsOfPage, ...looking, ...pictures, ...doing, ...forms, ...journey, ...safety]) {
    if (options.only && !name.includes(options.only)) continue;
    const begin = performance.now();
    let problem = null;
    try {
      await test(bench);
    } catch (error) {
      problem = error;
    }
    const wrong = bench.takeComplaints();
    problem ??= wrong.length > 0 ? new Error(`the browser complains: ${wrong.join("; ")}`) : null;
    const seconds = ((performance.now() - begin) / 1000).toFixed(1);
    console.log(`${problem ? "FAILED" : "passed"}  ${seconds} s  ${name}`);
    if (problem) console.log(problem.stack ?? problem);
    if (problem) await bench.shootFailure(name);
    await bench.closePages();
    failed += problem ? 1 : 0;
  }
} finally {
  await bench.end();
  rmSync(folder, { recursive: true, force: true });
}
process.exit(failed > 0 ? 1 : 0);
