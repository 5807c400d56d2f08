// Pictures and the list of runs: what a click replaces, what fits together, what is computed, narrow windows.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { placeOfSpecial, until } from "./bench.mjs";

const shownRuns = (page) =>
  page.evaluate(() =>
    [...document.querySelectorAll(".figure")].map((figure) =>
      [...figure.querySelectorAll(".shown-runs button")].map((one) => one.textContent.replace(" ✕", "")).join(),
    ),
  );

export const cases = [
  [
    "a click on a run shows its own picture and leaves a composed one; what was shown before comes back",
    async (bench) => {
      const page = await bench.openResults();
      const run = (name) => page.locator(".runs .run").getByRole("button", { name, exact: true });
      const title = (name) => page.getByRole("heading", { name, exact: true }).waitFor();
      await page.getByRole("button", { name: "Hide impacting" }).click();
      await until(page, () => document.querySelector(".shown-runs").hidden);
      await page.getByRole("button", { name: "Show what this picture showed before" }).click();
      await title("Orbits without and with an impact");
      await run("no_impact").click();
      await until(page, () => document.querySelector(".shown-runs").hidden);
      await page.getByRole("button", { name: "Add impacting to the picture" }).click();
      await until(page, () => !document.querySelector(".shown-runs").hidden);
      await run("impacting").click();
      await until(page, () => document.querySelectorAll(".figure").length === 2);
      assert.deepEqual(await shownRuns(page), ["no_impact,impacting", ""]);
      await run("impacting").click(); // it is there already
      // A curve in other parameters is drawn in its own axes.
      await page.getByRole("button", { name: "Add touches_frequency to the picture" }).click();
      await until(page, () => document.querySelectorAll(".figure").length === 3);
      // However many pictures there are, each column scrolls by itself.
      assert.ok(await page.evaluate(() => document.documentElement.scrollHeight <= innerHeight));
      assert.ok(await page.locator(".figures").evaluate((one) => one.scrollHeight > one.clientHeight));
      assert.ok(await page.locator(".page-header").isVisible());
    },
  ],
  [
    "a narrow window shows the chosen point beside the pictures, or instead of them",
    async (bench) => {
      const page = await bench.openResults({ width: 1024, height: 700 });
      assert.ok(await page.locator(".runs").isVisible());
      assert.ok(!(await page.locator(".side").isVisible()));
      const place = await placeOfSpecial(page, "impacting", "SN2");
      assert.ok(place.x > 0);
      await page.getByRole("heading", { name: "impacting: SN2" }).waitFor();
      assert.ok((await page.locator(".side").boundingBox()).width > 400);
      assert.ok((await page.locator(".diagram").first().boundingBox()).width > 200);
      await bench.shoot(page, "narrow-point");
      await page.setViewportSize({ width: 683, height: 384 });
      assert.ok((await page.locator(".side").boundingBox()).width > 650);
      await page.getByRole("button", { name: "Runs", exact: true }).click();
      assert.ok(await page.locator(".diagram").first().isVisible());
      await page.getByRole("button", { name: "Point and tools" }).click();
      await page.getByRole("heading", { name: "impacting: SN2" }).waitFor();
    },
  ],
  [
    "runs of a study are computed one by one, and outdated ones anew",
    async (bench) => {
      const server = await bench.serve("mems-switch", "--output", join(bench.folder, `copy${++bench.copies}`));
      const page = await bench.open(server.address);
      await page.getByRole("button", { name: "Compute all that is missing (9 runs)" }).waitFor();
      await page.getByText("Nothing is computed yet").waitFor();
      await bench.shoot(page, "nothing-computed");
      await page.getByRole("button", { name: "Compute free", exact: true }).click();
      await page.getByRole("button", { name: "Compute all that is missing (8 runs)" }).waitFor();
      await page.locator(".diagram .u-over").first().waitFor();
      await page.route("**/api/runs", async (route) => {
        const runs = await (await route.fetch()).json();
        runs.find((run) => run.name === "free").status = "outdated";
        await route.fulfill({ json: runs });
      });
      await page.route("**/api/jobs", async (route) => {
        if (route.request().method() !== "POST") return route.fallback();
        await route.fulfill({ json: { id: 99, runs: ["free"] } });
      });
      await page.reload();
      await page.getByText("out of date, 1 point").waitFor();
      const request = page.waitForRequest((one) => one.method() === "POST" && one.url().endsWith("/api/jobs"));
      await page.getByRole("button", { name: "Compute anew free" }).click();
      assert.deepEqual((await request).postDataJSON(), { runs: ["free"] });
      await page.unrouteAll({ behavior: "ignoreErrors" });
      await bench.stop(server);
    },
  ],
  [
    "what cannot be drawn is not offered, and what a logarithmic axis hides is told",
    async (bench) => {
      const page = await bench.openResults();
      await page.getByRole("button", { name: "Choose…" }).click();
      const kinds = await page
        .locator('.chooser-form label:has(> span:text-is("kind")) option')
        .evaluateAll((options) => options.map((one) => one.value));
      assert.deepEqual(kinds, ["", "branch", "portrait", "history", "scatter"]);
      assert.ok(await page.locator(".chooser-form").getByLabel("touches_frequency").isDisabled());
      assert.ok(await page.locator(".chooser-form").getByLabel("impacting").isEnabled());
      await page.getByPlaceholder("expression for y").fill("0.2 - V");
      await page.getByRole("button", { name: "Use", exact: true }).click();
      await until(page, () => document.querySelectorAll(".figure .diagram").length === 1);
      await page.getByLabel("log y").check();
      await page.getByText(/points are not shown: there .* is not positive/).waitFor();
    },
  ],
  [
    "pictures are exported finer than the screen",
    async (bench) => {
      const page = await bench.openResults({ dark: true });
      await page.locator("details.menu summary").first().click();
      const [file] = await Promise.all([
        page.waitForEvent("download"),
        page.getByRole("button", { name: "PNG", exact: true }).click(),
      ]);
      assert.equal(file.suggestedFilename(), "orbits-without-and-with-an-impact.png");
      const width = readFileSync(await file.path()).readUInt32BE(16);
      const box = await page.locator(".diagrams").first().boundingBox();
      assert.ok(width > 2 * box.width, `${width} pixels for ${box.width}`);
    },
  ],
];
