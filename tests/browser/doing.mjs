// Doing: going on from a point, moving parameters, texts, and a server that ends.
import assert from "node:assert/strict";
import { isComplete, placeOfSpecial, until, viewAfter, viewOf } from "./bench.mjs";

export const cases = [
  [
    "goes on from a grazing, and points arrive",
    async (bench) => {
      const { server, page } = await bench.openOwn();
      await placeOfSpecial(page, "no_impact", "GR1");
      const whole = await viewOf(page);
      await page.locator(".figure .diagram").first().press("+");
      const view = await viewAfter(page, whole);
      await page.getByRole("button", { name: "Beyond the grazing" }).click();
      const text = page.locator(".action-form textarea");
      await until(page, () => document.querySelector(".action-form textarea")?.value);
      assert.match(await text.inputValue(), /^\[runs\.[^\]]+\]\n(.*\n)*start = \{ run = "no_impact", point = "GR1"/);
      const name = /\[runs\.([^\]]+)\]/.exec(await text.inputValue())[1];
      await page.locator(".action-form").getByRole("button", { name: "Compute" }).click();
      await isComplete(page, name);
      await until(
        page,
        (run) => [...document.querySelectorAll(".special .row > span")].some((one) => one.textContent === run),
        name,
      );
      assert.deepEqual(await viewOf(page), view); // zoom is kept while points arrive
      await page.getByRole("tab", { name: "Jobs" }).click();
      assert.match(await page.locator(".jobs").textContent(), /complete/);
      await page.getByRole("tab", { name: "Study" }).click();
      await page.getByLabel("Text of the study").getByText(`[runs.${name}]`).waitFor();
      await bench.shoot(page, "followed");
      page.on("dialog", (dialog) => dialog.accept());
      await page.getByRole("button", { name: `Remove ${name}`, exact: true }).click();
      await page.getByRole("button", { name: `Remove ${name}`, exact: true }).waitFor({ state: "detached" });
      await page.getByLabel("Text of the study").getByText(`[runs.${name}]`).waitFor({ state: "detached" });
      await bench.stop(server);
    },
  ],
  [
    "a slider simulates as it moves",
    async (bench) => {
      const page = await bench.openResults({ width: 1920, height: 1080 });
      await placeOfSpecial(page, "impacting", "SN2");
      await page.getByRole("button", { name: "Simulate with sliders" }).click();
      const slider = page.getByRole("slider", { name: "V", exact: true });
      await slider.waitFor();
      const canvas = ".simulation .portrait-place canvas";
      await page.locator(canvas).waitFor();
      const computed = /^The motion was computed in ([\d.]+) ms\.$/;
      await page.getByText(computed).waitFor(); // the first motion is there
      const before = await page.evaluate((place) => document.querySelector(place).toDataURL(), canvas);
      let answers = 0;
      page.on("response", (response) => (answers += response.url().endsWith("/api/simulate") ? 1 : 0));
      await slider.focus();
      for (let i = 0; i < 6; ++i) await page.keyboard.press("ArrowRight");
      await until(page, ([place, old]) => document.querySelector(place).toDataURL() !== old, canvas, before);
      assert.ok(answers > 0);
      const milliseconds = Number(computed.exec(await page.locator(".simulation > .note").textContent())?.[1]);
      console.log(`        ${milliseconds} ms for a simulation with its transfer`);
      assert.ok(milliseconds < 1000); // also beside a build; alone it is below 50
      await bench.shoot(page, "sliders");
    },
  ],
  [
    "an editor shows mistakes at their places, and completes",
    async (bench) => {
      const { server, page } = await bench.openOwn();
      await page.getByRole("tab", { name: "Study" }).click();
      const content = page.getByLabel("Text of the study");
      await content.click();
      await page.keyboard.press("Control+End");
      await page.keyboard.type('\n[runs.more]\nkind = "continue"\nalon');
      await page.locator(".cm-tooltip-autocomplete").waitFor();
      assert.match(await page.locator(".cm-tooltip-autocomplete").textContent(), /along/);
      await page.keyboard.press("Escape");
      await page.locator(".cm-lintRange-error, .cm-lintPoint-error").first().waitFor({ state: "attached" });
      await page.getByLabel("Text of the study").getByText("kind").last().hover();
      await page.locator(".meaning").waitFor();
      assert.match(await page.locator(".meaning").textContent(), /what the run does/);
      await bench.shoot(page, "editor");
      await bench.stop(server);
    },
  ],
  [
    "a server that ends is told of, and its successor goes on",
    async (bench) => {
      const folder = bench.ownResults();
      const first = await bench.serve(folder);
      const page = await bench.open(first.address, { allowed: ["ERR_", "Failed to load"] });
      await page.waitForSelector(".diagram .u-over");
      await page.getByRole("button", { name: "Touches and folds by the distance of the stop" }).click();
      await page.getByRole("heading", { name: "Touches and folds by the distance of the stop" }).waitFor();
      await bench.stop(first, { keepPages: true });
      await page.getByText("The server does not answer").waitFor();
      assert.ok(await page.locator(".diagram canvas").first().isVisible());
      await bench.shoot(page, "server-lost");
      const second = await bench.serve(folder);
      await page.getByLabel("Address of the new server").fill(second.address);
      await page.getByRole("button", { name: "Go on there" }).click();
      await page.getByRole("heading", { name: "Touches and folds by the distance of the stop" }).waitFor();
      assert.ok(await page.locator(".banner").first().isHidden());
      assert.ok(!page.url().includes("token") && !page.url().includes("view="));
      await bench.stop(second);
    },
  ],
];
