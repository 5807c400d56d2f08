// A file from a stranger shows as text; other pages get nothing.
import assert from "node:assert/strict";
import { writeFileSync } from "node:fs";
import { join } from "node:path";

const bait = "<img src=x onerror=window.bitten=1>";

const model = `name = "${bait}"
text = "${bait} <script>window.bitten=1</script>"

[states]
x = { text = "${bait}", initial = 0.5 }
v = { initial = 0 }

[parameters]
k = { value = 1, text = "${bait}" }

[modes.free]
rates = { x = "v", v = "-k*x" }
`;

export const cases = [
  [
    "a hostile model shows as text",
    async (bench) => {
      const file = join(bench.folder, "hostile.toml");
      writeFileSync(file, model);
      const server = await bench.serve(file);
      const page = await bench.open(server.address);
      await page.locator(".slider").first().waitFor();
      await page.getByRole("tab", { name: "Model" }).click();
      await page.getByLabel("Text of the model").getByText(bait).first().waitFor();
      assert.ok(await page.getByText(bait).first().isVisible());
      assert.equal(await page.evaluate(() => window.bitten), undefined);
      assert.equal(await page.locator("img").count(), 0);
      await bench.shoot(page, "hostile-model");
      await bench.stop(server);
    },
  ],
  [
    "a wrong token opens nothing",
    async (bench) => {
      const { address } = await bench.lookingServer();
      const page = await bench.open(address.replace(/token=.*/, "token=0123456789abcdef0123456789abcdef"), {
        allowed: ["401", "403"],
      });
      assert.equal(await page.locator(".diagram").count(), 0);
      assert.match(await page.locator("body").textContent(), /token/);
    },
  ],
];
