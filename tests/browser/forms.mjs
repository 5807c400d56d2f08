// Forms: proposals that follow their fields, sliders with what they propose, mistakes in texts, and names of files.
import assert from "node:assert/strict";
import { mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { placeOfSpecial, until } from "./bench.mjs";

const formText = (page) => page.locator(".action-form textarea");

/** Waits until the proposed text has something. */
async function textWith(page, pattern) {
  await until(
    page,
    (source) => new RegExp(source).test(document.querySelector(".action-form textarea")?.value ?? ""),
    pattern.source,
  );
  return formText(page).inputValue();
}

async function setField(field, value) {
  await field.fill(value);
  await field.press("Tab");
}

async function openModel(bench, name) {
  const server = await bench.serve(name, "--model", "--output", join(bench.folder, `model${++bench.copies}`));
  const page = await bench.open(server.address);
  await page.getByText(/^The motion was computed in/).waitFor();
  return { server, page };
}

const ballText = (gravity) => `name = "ball"

[parameters]
g = { value = ${gravity} }

[states]
y = { initial = 1 }
v = { initial = 0 }

[modes.flight]
rates = { y = "v", v = "-g" }
`;

export const cases = [
  [
    "the text of a proposal follows its fields, and wrong ones are told",
    async (bench) => {
      const { server, page } = await bench.openOwn();
      await placeOfSpecial(page, "no_impact", "GR1");
      await page.getByRole("button", { name: "Beyond the grazing" }).click();
      await textWith(page, /along = \{ V = \[0\.01, 0\.4\] \}/);
      const form = page.locator(".action-form");
      await form.getByLabel("to", { exact: true }).fill("0.1");
      await form.getByText("leave out its present value").waitFor();
      assert.ok(await form.getByRole("button", { name: "Compute" }).isDisabled());
      await form.getByLabel("to", { exact: true }).fill("0.35");
      await textWith(page, /V = \[0\.01, 0\.35\]/);
      assert.equal(await form.getByText("leave out its present value").count(), 0);
      await form.getByLabel("name of the run").fill("free");
      await form.getByText("There is a run free already").waitFor();
      await form.getByLabel("name of the run").fill("beyond");
      assert.match(await formText(page).inputValue(), /^\[runs\.beyond\]/);
      await form.getByRole("button", { name: "Compute" }).click();
      await form.getByText("The run beyond is complete.").waitFor();
      await page.getByRole("button", { name: "Curve of such points" }).click();
      await textWith(page, /kind = "curve"/);
      const along = form.getByLabel("along");
      await along.nth(1).selectOption(await along.nth(0).inputValue());
      await form.getByText("Choose two different parameters.").waitFor();
      await bench.stop(server);
    },
  ],
  [
    "sliders propose runs with their values, and their orbit is chosen when it is found",
    async (bench) => {
      const { server, page } = await openModel(bench, "impact-oscillator");
      await setField(page.getByLabel("omega, value"), "4");
      await page.locator(".simulation summary", { hasText: "Initial state" }).click();
      await setField(page.getByLabel("x, value"), "-0.07");
      await page.getByRole("button", { name: "Sweep", exact: true }).click();
      await page.locator(".action-form").getByLabel("points").fill("31");
      await page.locator(".action-form").getByLabel("direction").selectOption("both");
      assert.match(await textWith(page, /points = 31(.*\n)*direction/), /from = \{ x = -0\.07 \}/);
      await page.getByRole("button", { name: "Find the orbit" }).click();
      await textWith(page, /set = \{ omega = 4 \}/);
      await setField(page.getByLabel("omega, value"), "4.1");
      await textWith(page, /set = \{ omega = 4\.1 \}/);
      await page.locator(".action-form").getByRole("button", { name: "Compute" }).click();
      await page.getByRole("heading", { name: "orbit: the orbit" }).waitFor();
      const title = await page.title();
      await page.reload();
      await page.getByRole("tab", { name: "Simulate" }).click();
      await until(page, () => document.querySelector('[aria-label="omega, value"]')?.value === "4.1");
      assert.equal(await page.title(), title);
      await page.getByRole("button", { name: "From the model's initial state" }).click();
      await page.getByRole("button", { name: "Find the orbit" }).click();
      assert.doesNotMatch(await textWith(page, /omega = 4\.1/), /from/);
      await page.getByRole("tab", { name: "Study" }).click();
      await page.getByLabel("Text of the study").click();
      await page.keyboard.press("Control+Home");
      await page.keyboard.type("set = { e = 0.5 }\n");
      await page.getByRole("textbox", { name: "file" }).fill(`common${bench.copies}`);
      await page.getByRole("button", { name: "Save", exact: true }).click();
      await page.getByText(`Saved in common${bench.copies}.toml`).waitFor();
      await page.getByRole("tab", { name: "Simulate" }).click();
      await page.getByRole("button", { name: "Find the orbit" }).click();
      await textWith(page, /set = \{.* e = 0\.8, omega = 4\.1/); // not that of all runs
      await bench.stop(server);
    },
  ],
  [
    "a motion that arrives while a value is typed leaves what is typed",
    async (bench) => {
      const { server, page } = await openModel(bench, "impact-oscillator");
      await page.locator(".simulation summary", { hasText: "Initial state" }).click();
      let arrive;
      const typed = new Promise((done) => (arrive = done));
      await page.route("**/api/simulate", async (route) => {
        await typed;
        await route.continue();
      });
      await setField(page.getByLabel("omega, value"), "4");
      const x = page.getByLabel("x, value");
      await x.fill("-0.07");
      const answered = page.waitForResponse("**/api/simulate");
      arrive();
      await (await answered).finished();
      await page.getByText(/^The motion was computed in/).waitFor();
      await x.press("Tab");
      await page.getByText("From the initial state that the sliders have.").waitFor();
      assert.equal(await x.inputValue(), "-0.07");
      await bench.stop(server);
    },
  ],
  [
    "a motion that fails, or ends early, is told of, and what was chosen stays",
    async (bench) => {
      const { server, page } = await openModel(bench, "impact-oscillator");
      const duration = page.getByLabel("duration, value");
      await setField(duration, "-5");
      await page.getByText("The duration needs a positive number.").waitFor();
      await setField(duration, "1e9");
      await page.getByText(/The motion ends early, at t = .*choose a shorter duration/).waitFor();
      await setField(duration, "20");
      await page.locator(".simulation summary", { hasText: "Initial state" }).click();
      const x = page.getByLabel("x, value");
      const before = await x.inputValue();
      await setField(x, "5");
      await page.getByText(/There is no motion: .*wall/).waitFor();
      assert.ok(await page.locator(".simulation .portrait-place").isHidden());
      await setField(x, before);
      await page.locator(".simulation .portrait-place canvas").waitFor();
      const names = await page
        .locator(".simulation .histories .diagram")
        .evaluateAll((all) => all.map((one) => one.getAttribute("aria-label")));
      assert.equal(names.length, 2);
      assert.match(names[0], /History of x/);
      await bench.stop(server);
    },
  ],
  [
    "saving tells where, names mistakes, and takes no file that is there",
    async (bench) => {
      const folder = bench.ownResults();
      const server = await bench.serve(folder);
      const page = await bench.open(server.address, { allowed: ["409"] });
      await page.getByRole("tab", { name: "Study" }).click();
      const content = page.getByLabel("Text of the study");
      await content.click();
      await page.keyboard.press("Control+End");
      await page.keyboard.type('\n[runs.more]\nkind = "sweep"\n');
      await page.keyboard.type("vary = { Vx = [0.1, 0.2] }\n");
      writeFileSync(join(folder, "taken.toml"), ""); // new files are beside the results
      await page.getByRole("textbox", { name: "file" }).fill("taken");
      await page.getByRole("button", { name: "Save", exact: true }).click();
      await page.locator(".text-view .problem", { hasText: "taken.toml" }).first().waitFor();
      await page.getByRole("textbox", { name: "file" }).fill(`new${bench.copies}`);
      await page.getByRole("button", { name: "Save and compute" }).click();
      await page.getByText(`Saved in new${bench.copies}.toml, but nothing is computed`).waitFor();
      const place = page.getByRole("button", { name: /^line \d+$/ });
      await place.press("Enter");
      await page.keyboard.press("Control+a");
      await page.keyboard.press("Delete");
      await page.keyboard.insertText(
        'name = "mems-switch"\nmodel = "mems-switch"\n\n[runs.more]\nkind = "orbit"\nset = { V = 0.05 }\n',
      );
      await page.getByRole("button", { name: "Save and compute" }).click();
      await page.getByText(/computed: more/).waitFor();
      await bench.stop(server);
    },
  ],
  [
    "a run whose text was changed is computed again, and its point is shown anew",
    async (bench) => {
      const { server, page } = await openModel(bench, "impact-oscillator");
      await setField(page.getByLabel("omega, value"), "4");
      await page.getByRole("button", { name: "Find the orbit" }).click();
      await textWith(page, /set = \{ omega = 4 \}/);
      await page.locator(".action-form").getByRole("button", { name: "Compute" }).click();
      await page.getByText(/period = 1\.5708$/).waitFor();
      await page.getByRole("tab", { name: "Study" }).click();
      await page.getByLabel("Text of the study").getByText("4", { exact: true }).dblclick();
      await page.keyboard.type("5");
      await page.getByRole("textbox", { name: "file" }).fill(`again${bench.copies}`);
      await page.getByRole("button", { name: "Save and compute" }).click();
      await page.getByText(/computed: orbit/).waitFor();
      await page.getByRole("tab", { name: "Point" }).click();
      await page.getByText(/period = 3\.76991$/).waitFor();
      await bench.stop(server);
    },
  ],
  [
    "edits of a model stay after a reload",
    async (bench) => {
      const { server, page } = await openModel(bench, "impact-oscillator");
      await page.getByRole("tab", { name: "Model" }).click();
      await page.getByText("A copy of the model that was opened.").waitFor();
      await page.getByLabel("Text of the model").click();
      await page.keyboard.press("Control+End");
      await page.keyboard.type("# mine");
      await page.keyboard.press("Control+Home");
      await page.getByLabel("Text of the model").getByText("omega", { exact: true }).first().click();
      // Twice, for a line that is wrapped.
      for (const key of ["Home", "Home", "Shift+End", "Shift+End"]) await page.keyboard.press(key);
      await page.keyboard.type("omega = { value = 3.25 }");
      await page.getByText("You have changed this text").waitFor();
      await page.getByRole("button", { name: "Simulate this model" }).click();
      await until(page, () => document.querySelector('[aria-label="omega, value"]')?.value === "3.25");
      await page.getByText("is not saved").waitFor();
      assert.ok(await page.getByRole("button", { name: "Find the orbit" }).isDisabled());
      await page.getByRole("tab", { name: "Model" }).click();
      await page.reload();
      await page.getByRole("tab", { name: "Model" }).click();
      await page.getByRole("button", { name: "Back to the stored text" }).click();
      await page.getByText("A copy of the model that was opened.").waitFor();
      await bench.stop(server);
    },
  ],
  [
    "a model of a file is mended, tried and saved, and the simulation goes along",
    async (bench) => {
      const folder = join(bench.folder, `ball${++bench.copies}`);
      mkdirSync(folder);
      const file = join(folder, "ball.toml");
      writeFileSync(file, ballText("9.81"));
      const server = await bench.serve(file, "--output", join(folder, "out"));
      const page = await bench.open(server.address);
      await page.getByText(/^The motion was computed in/).waitFor();
      await page.getByText("From the initial state of the model.").waitFor();
      await page.getByRole("button", { name: "Go on from where it ends" }).click();
      await page.getByText("From where the motion before ended.").waitFor();
      await page.getByRole("tab", { name: "Model" }).click();
      const content = page.getByLabel("Text of the model");
      const type = async (text) => {
        await content.click();
        await page.keyboard.press("Control+a");
        await page.keyboard.insertText(text);
      };
      await type(ballText('"gravy"'));
      await page.getByRole("list", { name: "Mistakes" }).getByText("gravy").waitFor();
      assert.ok(await page.getByRole("button", { name: "Simulate this model" }).isDisabled());
      await bench.shoot(page, "model-mistakes");
      await page.getByRole("button", { name: "Back to the stored text" }).click();
      assert.equal(await page.getByRole("list", { name: "Mistakes" }).count(), 0);
      await type(ballText("3.5"));
      await page.getByRole("button", { name: "Simulate this model" }).click();
      await until(page, () => document.querySelector('[aria-label="g, value"]')?.value === "3.5");
      await page.getByRole("tab", { name: "Model" }).click();
      await page.getByRole("button", { name: "Save", exact: true }).click();
      await page.getByText("Saved in ball.toml.").waitFor();
      assert.equal(readFileSync(file, "utf8"), ballText("3.5"));
      await page.getByRole("tab", { name: "Simulate" }).click();
      await page.getByRole("button", { name: "Simulate", exact: true }).waitFor();
      assert.ok(await page.getByRole("button", { name: "Simulate", exact: true }).isEnabled());
      assert.equal(await page.getByText("is not saved").count(), 0);
      await bench.shoot(page, "model-saved");
      await bench.stop(server);
    },
  ],
  [
    "a new server at the same address is gone on with",
    async (bench) => {
      const folder = bench.ownResults();
      const first = await bench.serve(folder);
      const page = await bench.open(first.address, { allowed: ["ERR_", "Failed to load"] });
      await page.waitForSelector(".diagram .u-over");
      await bench.stop(first, { keepPages: true });
      await page.getByText("The server does not answer").waitFor();
      const second = await bench.serve(folder, "--port", new URL(first.address).port);
      await page.getByLabel("Address of the new server").fill(second.address);
      await page.getByRole("button", { name: "Go on there" }).click();
      await until(page, () => document.querySelector(".banner")?.hidden === true);
      await page.waitForSelector(".diagram .u-over");
      assert.ok(!page.url().includes("token"));
      await bench.stop(second);
    },
  ],
];
