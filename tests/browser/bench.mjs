// What all tests use: results, servers, and pages of one browser.
import { spawn, spawnSync } from "node:child_process";
import { cpSync, readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { join } from "node:path";

const browserOptions = [
  "--no-sandbox",
  "--headless",
  "--disable-gpu",
  "--disable-quic",
  "--no-first-run",
  "--disable-background-networking",
  "--disable-component-update",
  "--disable-sync",
];

export class Bench {
  constructor(options) {
    Object.assign(this, options);
    this.servers = new Set();
    this.contexts = new Set();
    this.complaints = [];
    this.copies = 0;
  }

  async prepare() {
    const tools = createRequire(join(this.tools, "package.json"));
    const { chromium } = tools("playwright-core");
    this.axe = tools.resolve("axe-core/axe.min.js");
    this.results = join(this.folder, "switch");
    const made = spawnSync(this.graze, ["run", "mems-switch", "--output", this.results], { encoding: "utf8" });
    if (made.status !== 0) throw new Error(`graze run failed: ${made.stderr}`);
    this.browserProcess = await chromium.launch({ executablePath: this.browser, args: browserOptions });
  }

  /** A folder with results of its own, which a test may change. */
  ownResults() {
    const folder = join(this.folder, `copy${++this.copies}`);
    cpSync(this.results, folder, { recursive: true });
    return folder;
  }

  /** Starts `graze view`; the result has the address that it prints. */
  async serve(...given) {
    const server = spawn(this.graze, ["view", ...given], { cwd: this.folder, stdio: ["ignore", "pipe", "pipe"] });
    this.servers.add(server);
    let said = "";
    server.address = await new Promise((done, failed) => {
      const look = (data) => {
        said += data;
        const address = /http:\/\/127\.0\.0\.1:\d+\/\?token=[0-9a-f]+/.exec(said);
        if (address) done(address[0]);
      };
      server.stdout.on("data", look);
      server.stderr.on("data", (data) => (said += data));
      server.on("exit", () => failed(new Error(`graze view ended: ${said}`)));
    });
    server.ended = new Promise((done) => server.on("exit", done));
    return server;
  }

  /** @param keepPages otherwise pages are closed first, which would complain */
  async stop(server, { keepPages = false } = {}) {
    if (!keepPages) await this.closePages();
    this.servers.delete(server);
    server.kill("SIGINT");
    await server.ended;
  }

  /** The server of the results, which tests only look at. */
  async lookingServer() {
    this.common ??= await this.serve(this.results);
    return this.common;
  }

  async open(address, { width = 1366, height = 768, dark = false, allowed = [] } = {}) {
    const context = await this.browserProcess.newContext({
      viewport: { width, height },
      colorScheme: dark ? "dark" : "light",
      acceptDownloads: true,
    });
    this.contexts.add(context);
    if (this.html)
      await context.route(
        (url) => url.pathname === "/",
        (route) => this.answerWithOtherPage(route),
      );
    const page = await context.newPage();
    page.setDefaultTimeout(30000);
    page.on("pageerror", (error) => this.complaints.push(`${error.message}`));
    page.on("console", (message) => {
      const text = message.text();
      if (message.type() === "error" && !allowed.some((word) => text.includes(word)))
        this.complaints.push(`${text} ${message.location().url}`);
    });
    await page.goto(address);
    return page;
  }

  async answerWithOtherPage(route) {
    const response = await route.fetch();
    const headers = { ...response.headers() };
    delete headers["content-security-policy"]; // it names the script of the page that is built in; each page has its own
    await route.fulfill({ status: response.status(), headers, body: readFileSync(this.html, "utf8") });
  }

  /** The page of the results, with its first diagram drawn. */
  async openResults(options) {
    const page = await this.open((await this.lookingServer()).address, options);
    await page.waitForSelector(".diagram .u-over");
    return page;
  }

  /** The page of results that the test may change, and its server. */
  async openOwn(options) {
    const server = await this.serve(this.ownResults());
    const page = await this.open(server.address, options);
    await page.waitForSelector(".diagram .u-over");
    return { server, page };
  }

  takeComplaints() {
    return this.complaints.splice(0);
  }

  async shoot(page, name) {
    await page.screenshot({ path: join(this.screenshots, `${name}.png`) });
  }

  async shootFailure(name) {
    for (const context of this.contexts)
      for (const page of context.pages())
        await page
          .screenshot({ path: join(this.screenshots, `failed-${name.replace(/\W+/g, "-")}.png`) })
          .catch(() => undefined);
  }

  async closePages() {
    for (const context of this.contexts) await context.close();
    this.contexts.clear();
  }

  async end() {
    await this.closePages();
    await this.browserProcess?.close();
    for (const server of [...this.servers]) await this.stop(server);
  }
}

/** Waits until a condition in the page holds. */
export async function until(page, condition, ...given) {
  await page.waitForFunction(condition, given.length === 1 ? given[0] : given, { timeout: 30000 });
}

/** Waits until a run is computed. */
export async function isComplete(page, run) {
  await until(
    page,
    (name) => [...document.querySelectorAll(".runs .run.complete .name")].some((one) => one.textContent === name),
    run,
  );
}

/** The ranges of the axes of a diagram. */
export async function viewOf(page, index = 0) {
  const text = await page.locator(".figure .diagram").nth(index).getAttribute("data-view");
  const [left, right, low, high] = text.split(" ").map(Number);
  return { x: [left, right], y: [low, high] };
}

/** The ranges of the axes of the first diagram after they have changed. */
export async function viewAfter(page, before) {
  const text = [...before.x, ...before.y].join(" ");
  await until(page, (old) => document.querySelector(".figure .diagram").dataset.view !== old, text);
  return viewOf(page);
}

/** Where a labelled point of a run lies on the screen: its place is asked from the page as a user finds it, by its mark. */
export async function placeOfSpecial(page, run, label) {
  const list = page.locator("details.special").first();
  if (!(await list.evaluate((element) => element.open))) await list.locator("summary").click();
  await list.getByRole("button", { name: new RegExp(`^${label} of ${run}\\b`) }).click();
  const mark = page.locator(".diagram .marker.selected").first();
  await mark.waitFor({ state: "attached" });
  return mark.evaluate((element) => {
    const box = element.getBoundingClientRect();
    return { x: box.left, y: box.top };
  });
}
