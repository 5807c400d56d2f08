// The journey of docs/page.md: from a model to its orbits, their doubled orbits, the flip in two parameters, and a picture.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { fileURLToPath } from "node:url";
import { isComplete, until } from "./bench.mjs";

const documented = readFileSync(fileURLToPath(new URL("../../docs/page.md", import.meta.url)), "utf8");

/** Clicks what computes the text that the form proposes, once it is there. */
async function compute(page, run) {
  const form = page.locator(".action-form");
  await until(page, (name) => document.querySelector(".action-form textarea")?.value.startsWith(`[runs.${name}]`), run);
  await form.getByRole("button", { name: "Compute" }).click();
  await isComplete(page, run);
}

export const cases = [
  [
    "goes from a model to a flip, its doubled orbits and its curve in as many steps as documented",
    async (bench) => {
      const folder = join(bench.folder, `journey${++bench.copies}`);
      const server = await bench.serve("impact-microactuator", "--model", "--output", folder);
      const page = await bench.open(server.address, { width: 1440, height: 900 });
      let steps = 1; // to open the model
      const step = async (work) => {
        ++steps;
        return work();
      };
      const action = (name) => page.getByRole("button", { name, exact: true }).first().click();
      const special = (run, label) =>
        page
          .locator("details.special")
          .getByRole("button", { name: new RegExp(`^${label} of ${run}\\b`) })
          .first()
          .click();

      const voltage = page.getByRole("spinbutton", { name: /^V\b/ }).first();
      await voltage.waitFor();
      await step(() => voltage.fill("0.2"));
      await step(() => action("Find the orbit"));
      await step(() => compute(page, "orbit"));

      await step(() =>
        page
          .getByRole("button", { name: /^Follow/ })
          .first()
          .click(),
      );
      const form = page.locator(".action-form");
      await step(() => form.getByLabel("along").selectOption("V"));
      await step(() => form.getByLabel("to", { exact: true }).fill("0.7"));
      await step(() => compute(page, "orbit-follow-V"));

      await step(() => special("orbit-follow-V", "PD1"));
      await step(() => action("Double the period"));
      await step(() => compute(page, "orbit-follow-V-PD1-double"));

      await step(() => special("orbit-follow-V", "PD1"));
      await step(() => action("Curve of such points"));
      await step(() => compute(page, "orbit-follow-V-PD1-curve"));
      await bench.shoot(page, "journey");

      await step(() => page.getByText("Export").first().click());
      const download = page.waitForEvent("download");
      await step(() => page.getByRole("button", { name: "SVG" }).first().click());
      assert.match((await download).suggestedFilename(), /\.svg$/);
      assert.match(documented, new RegExp(`\\*\\*steps\\*\\* \\| \\*\\*${steps}\\*\\*`), `${steps} steps`);
      await bench.stop(server);
    },
  ],
];
