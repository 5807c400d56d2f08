// Looking at results: diagrams, zoom, hovering, orbits, exports, keys, contrast.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { pathToFileURL } from "node:url";
import { isComplete, placeOfSpecial, until, viewAfter, viewOf } from "./bench.mjs";

/** Share of the pixels of the first diagram that have a colour. */
const coloured = (page) =>
  page.evaluate(() => {
    const canvas = document.querySelector(".diagram canvas");
    const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
    let count = 0;
    for (let i = 0; i < data.length; i += 4) if (data[i + 3] > 0 && Math.abs(data[i] - data[i + 2]) > 60) ++count;
    return count;
  });

/** Frames a second while the diagram in a box is moved. */
async function panned(page, box) {
  await page.evaluate(() => {
    window.frames_ = [];
    let before = performance.now();
    const look = () => {
      const now = performance.now();
      window.frames_.push(now - before);
      before = now;
      window.request_ = requestAnimationFrame(look);
    };
    requestAnimationFrame(look);
  });
  await page.keyboard.down("Shift");
  await page.mouse.move(box.x + 300, box.y + 200);
  await page.mouse.down();
  for (let i = 0; i < 60; ++i) await page.mouse.move(box.x + 300 + 2 * i, box.y + 200 + 20 * Math.sin(i / 5));
  await page.mouse.up();
  await page.keyboard.up("Shift");
  const frames = await page.evaluate(() => {
    cancelAnimationFrame(window.request_);
    return window.frames_;
  });
  return (1000 * frames.length) / frames.reduce((sum, one) => sum + one, 0);
}

/** Where something is once what arrives later, such as notes above it, moves it no more. */
async function placeAtRest(page, locator) {
  for (let before = await locator.boundingBox(); ; ) {
    await page.waitForTimeout(200);
    const now = await locator.boundingBox();
    if (JSON.stringify(now) === JSON.stringify(before)) return now;
    before = now;
  }
}

export const cases = [
  [
    "opens, shows a diagram, and hides the token",
    async (bench) => {
      const page = await bench.openResults();
      await until(page, () => document.querySelectorAll(".runs .run").length >= 9);
      assert.ok((await coloured(page)) > 300);
      assert.ok(!page.url().includes("token"));
      assert.match(await page.title(), /graze/);
      assert.ok(await page.getByText("with an impact", { exact: true }).first().isVisible());
      await bench.shoot(page, "diagram-light-1366");
    },
  ],
  [
    "zooms into a box, with the wheel, and back",
    async (bench) => {
      const page = await bench.openResults();
      const box = await placeAtRest(page, page.locator(".u-over").first());
      const whole = await viewOf(page);
      await page.mouse.move(box.x + 0.4 * box.width, box.y + 0.3 * box.height);
      await page.mouse.down();
      await page.mouse.move(box.x + 0.9 * box.width, box.y + 0.7 * box.height, { steps: 4 });
      await page.mouse.up();
      const zoomed = await viewAfter(page, whole);
      const part = ([low, high], [wholeLow, wholeHigh]) =>
        [low, high].map((value) => (value - wholeLow) / (wholeHigh - wholeLow));
      const near = (got, expected) => got.forEach((value, i) => assert.ok(Math.abs(value - expected[i]) < 0.01));
      near(part(zoomed.x, whole.x), [0.4, 0.9]);
      near(part(zoomed.y, whole.y), [0.3, 0.7]);
      // The other panel has the same horizontal axis, and goes along.
      assert.deepEqual((await viewOf(page, 1)).x, zoomed.x);
      await page.mouse.wheel(0, -400);
      const closer = await viewAfter(page, zoomed);
      assert.ok(closer.x[1] - closer.x[0] < 0.6 * (zoomed.x[1] - zoomed.x[0]));
      await page.mouse.dblclick(box.x + 0.5 * box.width, box.y + 0.9 * box.height);
      assert.deepEqual(await viewAfter(page, closer), whole);
    },
  ],
  [
    "tells what is under the pointer",
    async (bench) => {
      const page = await bench.openResults();
      const place = await placeOfSpecial(page, "no_impact", "GR1");
      await page.mouse.move(place.x - 2, place.y + 2);
      const tip = page.locator(".tooltip");
      await tip.waitFor();
      const text = await tip.textContent();
      assert.match(text, /no_impact, point \d+/);
      assert.match(text, /GR1/);
      assert.match(text, /V = 0\.2013/);
    },
  ],
  [
    "a click on a grazing shows its orbit and multipliers",
    async (bench) => {
      const page = await bench.openResults({ width: 1920, height: 1080 });
      const place = await placeOfSpecial(page, "no_impact", "GR1");
      await placeOfSpecial(page, "impacting", "SN2");
      await page.getByRole("heading", { name: "impacting: SN2" }).waitFor();
      await page.mouse.click(place.x, place.y);
      await page.getByRole("heading", { name: "no_impact: GR1" }).waitFor();
      await page.locator(".portrait-place canvas").waitFor();
      await page.locator(".multipliers canvas").waitFor();
      assert.ok((await page.locator(".multipliers .numbers li").count()) >= 1);
      assert.match(await page.locator(".point").textContent(), /grazing/);
      await page.getByText("Certificate and tables").click();
      assert.ok(await page.getByText("segments", { exact: true }).isVisible());
      await page.getByRole("button", { name: "▶ Play" }).click();
      const clock = page.locator(".point .player output");
      const before = await clock.textContent();
      await until(page, (text) => document.querySelector(".point .player output").textContent !== text, before);
      await page.getByRole("button", { name: "⏸ Pause" }).click();
      await bench.shoot(page, "orbit-light-1920");
    },
  ],
  [
    "an equilibrium shows its eigenvalues, and the cycles that begin there can be followed",
    async (bench) => {
      const results = join(bench.folder, "equilibria"),
        model = join(bench.folder, "brusselator.toml"),
        study = join(bench.folder, "equilibria.toml");
      writeFileSync(
        model,
        'name = "brusselator"\n[parameters]\na = 1\nb = 1\n[states]\nx = 1\ny = 1\n[modes.free]\n' +
          'rates = { x = "1 - (b + 1)*x + a*x^2*y", y = "b*x - a*x^2*y" }\n',
      );
      writeFileSync(
        study,
        'name = "equilibria"\nmodel = "./brusselator.toml"\n' +
          '[runs.rest]\nkind = "equilibrium"\nwithin = { x = [0, 10], y = [0, 10] }\n' +
          '[runs.branch]\nkind = "continue"\nstart = { run = "rest" }\nalong = { b = [0.5, 3] }\n',
      );
      const made = spawnSync(bench.graze, ["run", study, "--output", results], { encoding: "utf8" });
      assert.equal(made.status, 0, made.stderr);
      const server = await bench.serve(results);
      const page = await bench.open(server.address, { width: 1920, height: 1080 });
      await page.waitForSelector(".diagram .u-over");
      await placeOfSpecial(page, "branch", "HB1");
      await page.getByRole("heading", { name: "branch: HB1" }).waitFor();
      const values = page.getByRole("list", { name: "Eigenvalues" }).getByRole("listitem");
      await until(page, () => document.querySelectorAll(".eigenvalues li").length === 2);
      assert.equal(await values.first().textContent(), "0 + 1i, period 6.2832");
      assert.ok(!(await page.getByRole("heading", { name: "Multipliers" }).isVisible()));
      await page.locator(".portrait-place canvas").waitFor();
      assert.ok(!(await page.getByRole("button", { name: "▶ Play" }).isVisible()));
      assert.ok(await page.getByRole("button", { name: "Curve of such points" }).isVisible());
      await bench.shoot(page, "equilibrium");
      await page.getByRole("button", { name: "The cycles" }).click();
      await page.locator(".action-form").getByRole("button", { name: "Compute" }).click();
      await isComplete(page, "branch-HB1-switch");
      await bench.shoot(page, "cycles");
      await bench.stop(server);
    },
  ],
  [
    "is reached by the keyboard alone",
    async (bench) => {
      const page = await bench.openResults();
      await page.keyboard.press("Tab");
      assert.equal(await page.evaluate(() => document.activeElement.textContent), "To the pictures");
      await page.keyboard.press("Enter");
      assert.ok(await page.evaluate(() => document.activeElement.classList.contains("diagram")));
      await page.keyboard.press("ArrowRight");
      await page.keyboard.press("ArrowUp");
      await page.getByRole("heading", { name: "no_impact: GR1" }).waitFor();
      assert.match(await page.locator(".unseen[role=status]").textContent(), /no_impact point \d+, GR1/);
      await page.keyboard.press("ArrowLeft");
      await page.getByRole("heading", { name: /no_impact: point \d+/ }).waitFor();
      const outline = await page.evaluate(() => getComputedStyle(document.activeElement).outlineStyle);
      assert.equal(outline, "solid");
      await page.keyboard.press("ArrowRight");
      await page.keyboard.press("Enter");
      await until(page, () => document.activeElement.closest(".actions") !== null);
    },
  ],
  [
    "exports what is seen",
    async (bench) => {
      const page = await bench.openResults();
      const get = async (what) => {
        await page.locator("details.menu summary").first().click();
        const [file] = await Promise.all([
          page.waitForEvent("download"),
          page.getByRole("button", { name: what, exact: true }).click(),
        ]);
        return readFileSync(await file.path());
      };
      assert.equal((await get("PNG")).subarray(1, 4).toString(), "PNG");
      const svg = (await get("SVG")).toString();
      assert.match(svg, /<svg [^>]*>/);
      assert.match(svg, />GR1</);
      const csv = (await get("CSV")).toString().split("\n");
      assert.equal(csv[0], "panel,series,style,run,number,label,x,y");
      assert.ok(csv.some((line) => line.includes(",no_impact,") && line.includes(",GR1,0.2013")));
      const text = (await get("Study text")).toString();
      assert.match(text, /^\[pictures\.orbits-without-and-with-an-impact\]/);
      assert.match(text, /runs = \["no_impact", "impacting"\]/);
      assert.match(text, /y = \["max_q", "max_v"\]/);
    },
  ],
  [
    "shows quantities that are chosen, and logarithmic axes",
    async (bench) => {
      const page = await bench.openResults({ allowed: ["400"] });
      await page.getByRole("button", { name: "Choose…" }).click();
      await page.locator('.chooser-form label:has(> span:text-is("y")) select').selectOption("period");
      await page.getByRole("button", { name: "Leave out max_v" }).click();
      await until(page, () => document.querySelectorAll(".figure .diagram").length === 1);
      const own = page.getByPlaceholder(/expression for y/);
      const use = page.getByRole("button", { name: "Use", exact: true });
      await own.fill("period*nothing");
      await use.click();
      await page.getByText(/The picture stays as it was: .*nothing/).waitFor();
      assert.equal(await page.locator(".figure .diagram canvas").count(), 1);
      await own.fill("");
      await use.click();
      await page.getByText(/The picture stays as it was/).waitFor({ state: "detached" });
      await page.getByLabel("log x").check();
      await page.waitForTimeout(100);
      assert.ok((await coloured(page)) > 100);
      await page.getByRole("button", { name: "Add a picture" }).click();
      await until(page, () => document.querySelectorAll(".figure").length === 2);
      await bench.shoot(page, "two-pictures");
    },
  ],
  [
    "a picture that arrives after an axis was made logarithmic leaves it so",
    async (bench) => {
      const page = await bench.openResults();
      await page.getByRole("button", { name: "Choose…" }).click();
      const y = page.locator('.chooser-form label:has(> span:text-is("y")) select');
      await y.selectOption("period");
      await page.getByRole("button", { name: "Leave out max_v" }).click();
      await until(page, () => document.querySelectorAll(".figure .diagram").length === 1);
      let arrive;
      const chosen = new Promise((done) => (arrive = done));
      await page.route("**/api/figure*", async (route) => {
        await chosen;
        await route.continue();
      });
      await y.selectOption("");
      await page.getByLabel("log x").check();
      arrive();
      await until(page, () => document.querySelectorAll(".figure .diagram").length === 2);
      assert.ok(await page.getByLabel("log x").isChecked());
    },
  ],
  [
    "shows the same after it was loaded again",
    async (bench) => {
      const page = await bench.openResults();
      await page.getByRole("button", { name: "Touches and folds by the frequency of the force" }).click();
      await page.getByRole("heading", { name: "Touches and folds by the frequency of the force" }).waitFor();
      await placeOfSpecial(page, "touches_frequency", "DG1");
      await page.getByRole("heading", { name: "touches_frequency: DG1" }).waitFor();
      await page.reload();
      await page.getByRole("heading", { name: "touches_frequency: DG1" }).waitFor();
      await page.getByRole("heading", { name: "Touches and folds by the frequency of the force" }).waitFor();
      await bench.shoot(page, "curves-light-1366");
    },
  ],
  [
    "has contrast, roles and names, light and dark",
    async (bench) => {
      for (const dark of [false, true]) {
        const page = await bench.openResults({ dark });
        await placeOfSpecial(page, "impacting", "SN2");
        await page.locator(".multipliers canvas").waitFor();
        await page.getByRole("button", { name: "Choose…" }).click();
        await page.addScriptTag({ path: bench.axe }).catch(async () => page.evaluate(readFileSync(bench.axe, "utf8")));
        const { violations, passes } = await page.evaluate(() =>
          axe.run(document, { runOnly: ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa", "best-practice"] }),
        );
        assert.ok(passes.length > 10);
        assert.deepEqual(
          violations.map(({ id, nodes }) => `${id}: ${nodes[0].html.slice(0, 120)}`),
          [],
        );
        await bench.shoot(page, `point-${dark ? "dark" : "light"}-1366`);
        bench.takeComplaints(); // the policy of the page refuses the script tag of axe, as it should
      }
    },
  ],
  [
    "a file of its own shows diagrams and orbits without a server",
    async (bench) => {
      const file = join(bench.folder, "alone.html");
      const made = spawnSync(bench.graze, ["plot", bench.results, "--run", "impacting", "--output", file], {
        encoding: "utf8",
      });
      assert.equal(made.status, 0, made.stderr);
      const page = await bench.open(pathToFileURL(file).href);
      await page.waitForSelector(".diagram .u-over");
      await placeOfSpecial(page, "impacting", "SN2");
      await page.getByRole("heading", { name: "impacting: SN2" }).waitFor();
      await page.locator(".portrait-place canvas").waitFor();
      assert.equal(await page.getByRole("tab", { name: "Jobs" }).count(), 0);
      await bench.shoot(page, "file-alone");
    },
  ],
  [
    "pans over two hundred thousand points with thirty frames a second",
    async (bench) => {
      const page = await bench.open("about:blank");
      await page.route("**/api/figure", async (route) => {
        const x = [],
          y = [],
          numbers = [];
        for (let i = 0, z = 0.3; i < 200000; ++i) {
          const a = 2.8 + (1.2 * Math.floor(i / 400)) / 500;
          z = a * z * (1 - z);
          x.push(a);
          y.push(z);
          numbers.push(Math.floor(i / 400));
        }
        const axis = (label) => ({ label, unit: "", words: "", logarithmic: false, range: null });
        const series = [{ title: "", style: "dots", colour: 0, symbol: 7, x, y, cells: [], run: "trip", numbers }];
        const panels = [
          { title: "", x: axis("V"), y: axis("v"), rows: 1, marks: [], marks_title: "", notes: [], series, labels: [] },
        ];
        await route.fulfill({ json: { figure: { title: "many", columns: 1, symbols: [], panels }, table: null } });
      });
      await page.goto((await bench.lookingServer()).address);
      await page.getByRole("heading", { name: "many" }).waitFor();
      const box = await page.locator(".u-over").first().boundingBox();
      // Where other work runs beside, as in CI, frames are lost that the page has no part in.
      const least = process.env.CI ? 10 : 30;
      let rate = 0;
      for (let attempt = 0; attempt < 4 && rate < least; ++attempt) rate = Math.max(rate, await panned(page, box));
      console.log(`        ${rate.toFixed(1)} frames a second`);
      assert.ok(rate >= least, `${rate.toFixed(1)} frames a second`);
      await bench.shoot(page, "many-points");
    },
  ],
];
