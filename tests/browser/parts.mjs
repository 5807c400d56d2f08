// Parts of the page that need no browser: bundled by esbuild and run here.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { join } from "node:path";
import { fileURLToPath, pathToFileURL } from "node:url";

const sources = fileURLToPath(new URL("../../page/source/", import.meta.url));
const loaded = new Map();

async function load(bench, name) {
  if (!loaded.has(name)) {
    const file = join(bench.folder, `${name}.mjs`);
    const made = spawnSync(
      "esbuild",
      ["--bundle", "--format=esm", `--outfile=${file}`, "--log-level=error", join(sources, `${name}.ts`)],
      { encoding: "utf8" },
    );
    assert.equal(made.status, 0, made.stderr);
    loaded.set(name, await import(pathToFileURL(file)));
  }
  return loaded.get(name);
}

const axis = (label, more = {}) => ({ label, unit: "", words: "", logarithmic: false, range: null, ...more });

function panelOf(series, labels = []) {
  return { title: "", x: axis("x"), y: axis("y"), marks: [], marks_title: "", notes: [], series, labels };
}

export const cases = [
  [
    "ticks are round numbers within the axis",
    async (bench) => {
      const { ticksOf } = await load(bench, "ticks");
      assert.deepEqual(ticksOf(0, 1, false, 5).texts, ["0.0", "0.2", "0.4", "0.6", "0.8", "1.0"]);
      assert.deepEqual(ticksOf(-2, 2, false, 4).texts, ["−2", "−1", "0", "1", "2"]);
      assert.deepEqual(ticksOf(1e-6, 1, true, 6).texts, ["10⁻⁶", "10⁻⁵", "10⁻⁴", "0.001", "0.01", "0.1", "1"]);
      const near = ticksOf(0.2013661, 0.2013662, false, 4);
      assert.ok(near.values.every((value) => value >= 0.2013661 - 1e-12 && value <= 0.2013662 + 1e-12));
      assert.equal(new Set(near.texts).size, near.texts.length);
    },
  ],
  [
    "an axis without extent, and one without positive values, can be drawn",
    async (bench) => {
      const { PreparedPanel } = await load(bench, "prepared_panel");
      const line = { title: "", style: "line", colour: 0, x: [3, 3, null], y: [-1, -1, 2] };
      const { x, y } = new PreparedPanel(panelOf([line]), false, false).wholeView();
      assert.ok(x.low < 3 && x.high > 3 && y.low < -1 && y.high > 2);
      const logarithmic = new PreparedPanel(panelOf([{ ...line, y: [-1, 0, -2] }]), false, true).wholeView();
      assert.ok(logarithmic.y.low > 0 && logarithmic.y.high > logarithmic.y.low);
    },
  ],
  [
    "only the points within view are looked at where x is in order",
    async (bench) => {
      const { PreparedPanel, indicesWithin } = await load(bench, "prepared_panel");
      const of = (x) =>
        new PreparedPanel(panelOf([{ title: "", style: "dots", colour: 0, x, y: x }]), false, false).drawn[0];
      assert.deepEqual(indicesWithin(of([1, 2, 2, 3, 4]), { low: 2, high: 3 }), [1, 4]);
      assert.deepEqual(indicesWithin(of([4, 3, 2, 2, 1]), { low: 2, high: 3 }), [1, 4]);
      assert.deepEqual(indicesWithin(of([4, 1, 3]), { low: 2, high: 3 }), [0, 3]);
      assert.deepEqual(indicesWithin(of([1, null, 3]), { low: 2, high: 3 }), [0, 3]);
    },
  ],
  [
    "the nearest point is found, between the points of a line too, and special points first",
    async (bench) => {
      const { PreparedPanel } = await load(bench, "prepared_panel");
      const { Frame } = await load(bench, "frame");
      const { nearestPoint } = await load(bench, "nearest");
      const line = { title: "", style: "line", colour: 0, x: [0, 10], y: [0, 0], run: "r", numbers: [4, 5] };
      const symbols = { title: "", style: "symbols", colour: 0, x: [10], y: [0.4], run: "r", numbers: [5] };
      const labels = [{ x: 10, y: 0.4, text: "GR1", colour: 0, rank: 0, owner: "", run: "r", number: 5 }];
      const prepared = new PreparedPanel(panelOf([line, symbols], labels), false, false);
      const frame = new Frame(0, 0, 100, 100, { x: { low: 0, high: 10 }, y: { low: -5, high: 5 } }, false, false);
      assert.equal(nearestPoint(prepared, frame, 30, 52, 10).number, 4);
      assert.equal(nearestPoint(prepared, frame, 98, 50, 10).label.text, "GR1");
      assert.equal(nearestPoint(prepared, frame, 30, 80, 10), null);
    },
  ],
  [
    "lines are smoothed through their points, without overshoot, and have corners",
    async (bench) => {
      const { smoothed } = await load(bench, "smoothing");
      const of = (...values) => Float64Array.from(values);
      const along = of(0, 1, 2, 3);
      const line = smoothed(of(0, 1, 2, 3), of(0, 0, 1, 1), along, []);
      assert.equal(line.x.length, 25);
      assert.deepEqual([line.y[0], line.y[8], line.y[16], line.y[24]], [0, 0, 1, 1]);
      assert.ok([...line.y].every((value, i) => value >= 0 && value <= 1 && (i === 0 || value >= line.y[i - 1])));
      const parabola = smoothed(of(0, 1, 2), of(0, 1, 4), of(0, 1, 2), []);
      assert.ok(Math.abs(parabola.y[12] - 2.25) < 0.1);
      const bent = smoothed(of(0, 1, 2, 3), of(0, 1, 0, 1), along, [1, 2]);
      assert.equal(bent.y[4], 0.5); // straight between corners
      const interrupted = smoothed(of(0, NaN, 2, 3), of(0, 1, 0, 1), along, []);
      assert.ok(Number.isNaN(interrupted.x[1]));
    },
  ],
  [
    "labels neither overlap nor leave the frame",
    async (bench) => {
      const { PreparedPanel } = await load(bench, "prepared_panel");
      const { Frame } = await load(bench, "frame");
      const { placeLabels } = await load(bench, "label_places");
      const labels = [];
      for (let i = 0; i < 60; ++i)
        labels.push({ x: (i * 37) % 100, y: (i * 53) % 100, text: `PD${i}`, colour: 0, rank: 0, owner: "" });
      const frame = new Frame(0, 0, 400, 300, { x: { low: 0, high: 100 }, y: { low: 0, high: 100 } }, false, false);
      const placed = placeLabels(
        new PreparedPanel(panelOf([], labels), false, false),
        frame,
        12,
        1,
        (text) => 7 * text.length,
      );
      assert.ok(placed.length > 20);
      const boxes = placed.map(({ x, y, text }) => [x, y - 6.9, x + 7 * text.length, y + 6.9]);
      for (const [i, a] of boxes.entries()) {
        assert.ok(a[0] >= 0 && a[1] >= 0 && a[2] <= 400 && a[3] <= 300);
        for (const b of boxes.slice(i + 1)) assert.ok(a[0] >= b[2] || b[0] >= a[2] || a[1] >= b[3] || b[1] >= a[3]);
      }
    },
  ],
  [
    "each kind of special point has a symbol of its own",
    async (bench) => {
      const { glyphOf } = await load(bench, "symbols");
      const types =
        "SN PD NS BP SB GR DG DZ EE GU CP GF GT R1 R2 R3 R4 VS DF DP ZA FP FT PT CH HB BE BT ZH HH GH HC HT EX UZ".split(
          " ",
        );
      const looks = types.map((type) => JSON.stringify(glyphOf(undefined, type)));
      assert.equal(new Set(looks).size, types.length);
    },
  ],
  [
    "a motion is interpolated within arcs and at no contact",
    async (bench) => {
      const { valuesAt, motionPanel } = await load(bench, "motion_rows");
      const column = (name, period = null) => ({ name, unit: "", period });
      const motion = {
        columns: [column("t"), column("v"), column("phase", 1)],
        values: [
          [0, 1, 1, 2],
          [0, 2, -2, 0],
          [0.8, 0.9, 0.9, 0.1],
        ],
        begins: [2],
        contacts: [1, 2],
        complete: true,
        ending: "end_time",
      };
      assert.equal(valuesAt(motion, 0.5).values[1], 1);
      assert.equal(valuesAt(motion, 1.5).values[1], -1);
      assert.equal(valuesAt(motion, 1.5).values[2], 0.9);
      const [line, contacts] = motionPanel(motion, 0, 1).series;
      assert.deepEqual(line.y, [0, 2, null, -2, 0]);
      assert.deepEqual(contacts.y, [2, -2]);
    },
  ],
  [
    "a place in a text of TOML is understood",
    async (bench) => {
      const { tomlPlace, namesBelow } = await load(bench, "toml_place");
      const text =
        'name = "s"\n[runs.first]\nkind = "sweep"\n\n[runs."second run"]\nkind = "continue"\nstart = { run = "first" }\nal';
      const place = tomlPlace(text, text.length);
      assert.deepEqual(place, { section: ["runs", "second run"], key: "al", inValue: false, kind: "continue" });
      assert.deepEqual(namesBelow(text, "runs"), ["first", "second run"]);
      assert.equal(tomlPlace(text, text.indexOf('"sweep')).inValue, true);
    },
  ],
  [
    "keys depend on the kind of a run",
    async (bench) => {
      const { keysAt } = await load(bench, "schema_keys");
      const schema = {
        properties: {
          runs: {
            additionalProperties: {
              properties: { kind: { enum: ["sweep", "orbit"] } },
              allOf: [
                {
                  if: { properties: { kind: { const: "sweep" } } },
                  then: { properties: { vary: { description: "what varies" } } },
                },
                { if: { properties: { kind: { const: "orbit" } } }, then: { properties: { cycles: {} } } },
              ],
            },
          },
        },
      };
      const names = (kind) =>
        keysAt(schema, { section: ["runs", "a"], key: "", inValue: false, kind }).map(({ name }) => name);
      assert.deepEqual(names("sweep"), ["kind", "vary"]);
      assert.deepEqual(names("orbit"), ["kind", "cycles"]);
    },
  ],
  [
    "texts of pictures are quoted",
    async (bench) => {
      const { pictureText } = await load(bench, "picture_text");
      assert.equal(
        pictureText('a "b"', { runs: ['x"\n[runs.evil]'], x_range: [0, 1] }),
        '[pictures."a \\"b\\""]\nruns = ["x\\"\\n[runs.evil]"]\nx_range = [0.0, 1.0]\n',
      );
    },
  ],
  [
    "events are read from pieces",
    async (bench) => {
      const { readEvents } = await load(bench, "event_reader");
      const pieces = ["event: job\nda", 'ta: {"id":1}\n', "\n: comment\n\nevent: end\ndata: {}\n\n"].map((text) =>
        new TextEncoder().encode(text),
      );
      const stream = new ReadableStream({
        start: (control) => (pieces.forEach((piece) => control.enqueue(piece)), control.close()),
      });
      const got = [];
      await readEvents(stream, (event, data) => got.push([event, data]));
      assert.deepEqual(got, [
        ["job", { id: 1 }],
        ["end", {}],
      ]);
    },
  ],
  [
    "figures of several runs are put together where their axes agree",
    async (bench) => {
      const { mergedFigure } = await load(bench, "merged_figure");
      const series = (run, colour, more = {}) => ({ title: "", style: "line", colour, x: [0], y: [0], run, ...more });
      const stable = series(undefined, 0, { title: "stable", only_in_legend: true });
      const label = { x: 0, y: 0, text: "GR1", colour: "black", rank: 0, owner: "" };
      const one = { title: "one", columns: 1, symbols: [], panels: [panelOf([series("a", 0), stable], [label])] };
      const other = { ...one, panels: [panelOf([series("b", 0), stable], [label]), { ...panelOf([]), y: axis("z") }] };
      const merged = mergedFigure([
        { run: "a", figure: one },
        { run: "b", figure: other },
      ]);
      assert.equal(merged.panels.length, 1);
      const shown = merged.panels[0].series.map(({ title, run, colour }) => [title, run, colour]);
      assert.deepEqual(shown, [
        ["", "a", 0],
        ["", "b", 1],
        ["a", undefined, 0],
        ["b", undefined, 1],
        ["stable", undefined, "black"],
      ]);
      assert.deepEqual(
        merged.panels[0].labels.map(({ colour }) => colour),
        [0, 1],
      );
      const foreign = { ...one, panels: [{ ...panelOf([]), x: axis("omega") }] };
      assert.equal(
        mergedFigure([
          { run: "a", figure: one },
          { run: "c", figure: foreign },
        ]),
        null,
      );
    },
  ],
  [
    "branches are drawn over the dots of a sweep, where their values belong to those of the sweep",
    async (bench) => {
      const { drawnOver } = await load(bench, "merged_figure");
      const { haveSameAxes, partsOf } = await load(bench, "joined_figure");
      const { Workspace } = await load(bench, "workspace");
      const quantity = (name) => ({ name, unit: "", words: "" });
      const run = (name, is_branch, coordinates, values, kind = "") => ({
        ...{ name, kind, is_branch, coordinates: coordinates.map(quantity), values: values.map(quantity) },
      });
      const sweep = run("sweep", false, ["V"], ["x", "v"]),
        branch = run("branch", true, ["V", "k"], ["max_x", "period"]),
        other = run("other", true, ["k", "V"], ["max_x"]),
        curve = run("curve", true, ["V", "k"], ["max_x"], "curve");
      assert.ok(haveSameAxes(sweep, branch));
      assert.ok(!haveSameAxes(sweep, other) && !haveSameAxes(branch, curve));
      assert.ok(!haveSameAxes(branch, run("orbit", true, ["V", "k"], ["max_x"], "orbit")));
      assert.ok(!haveSameAxes(sweep, run("poor", true, ["V"], ["size"])));
      const workspace = Object.assign(new Workspace(null, null), { runs: [sweep, branch] });
      const parts = partsOf(workspace, { runs: ["branch", "sweep"] });
      assert.deepEqual([parts.others.y, parts.branches.y], [["x"], ["max_x"]]);
      assert.equal(partsOf(workspace, { runs: ["sweep"] }), null);

      const dots = { title: "", style: "dots", colour: 0, x: [0], y: [0], run: "sweep" };
      const line = { title: "", style: "line", colour: 0, x: [1], y: [1], run: "branch" };
      const figure = (series, label) => ({
        ...{ title: "", columns: 1, symbols: [] },
        panels: [{ ...panelOf(series), x: axis("V", { range: [0, 0.5] }), y: axis(label) }],
      });
      const belongs = (value, ofBranch) => ofBranch === `max_${value}`;
      const both = drawnOver(figure([dots], "x"), figure([line], "max_x"), "branch", belongs);
      const [panel] = both.panels;
      assert.deepEqual(
        panel.series.map(({ title, colour }) => [title, colour]),
        [
          ["", 0],
          ["", 1],
          ["branch", 1],
        ],
      );
      assert.equal(panel.x.range, null); // the branch may go farther
      assert.equal(panel.y.label, "x (dots), max_x (lines)");
      assert.match(panel.notes.join(), /greatest x along the orbit/);
      const typed = partsOf(workspace, { runs: ["branch", "sweep"], y: ["x*q"] });
      assert.deepEqual([typed.others.y, typed.branches.y], [["x*q"], ["x*q"]]); // the server says what is wrong with it
      assert.equal(drawnOver(figure([dots], "x"), figure([line], "period"), "branch", belongs), null);
    },
  ],
  [
    "what a logarithmic axis hides is told, and no range is asked for that it cannot show",
    async (bench) => {
      const { PreparedPanel, hiddenPoints } = await load(bench, "prepared_panel");
      const line = { title: "", style: "line", colour: 0, x: [1, 2, 3], y: [-1, 2, null] };
      const panel = { ...panelOf([line]), y: axis("y", { range: [-5, 5] }) };
      const logarithmic = new PreparedPanel(panel, false, true);
      assert.ok(logarithmic.wholeView().y.low > 0);
      assert.match(hiddenPoints(logarithmic), /^1 of 2 points are not shown: there y is not positive/);
      assert.equal(hiddenPoints(new PreparedPanel(panel, false, false)), "");
      const never = new PreparedPanel(panelOf([{ ...line, y: [-1, 0, -2] }]), false, true);
      assert.match(hiddenPoints(never), /^Nothing is shown: y is nowhere positive/);
    },
  ],
  [
    "a stored page gives the nearest orbit, and says so",
    async (bench) => {
      const { StoredSource } = await load(bench, "stored_source");
      const point = (number) => ({ run: "a", number, label: "", coordinates: [] });
      const source = new StoredSource({
        session: {},
        runs: [],
        pictures: [],
        figures: [
          { key: { runs: ["a", "b"] }, answer: "both" },
          { key: "named", answer: "named" },
        ],
        points: { "a/1": point(1), "a/9": point(9), "b/3": point(3) },
        motions: {},
        models: {},
      });
      assert.equal((await source.point("a", 9)).note, "");
      const near = await source.point("a", 7);
      assert.equal(near.point.number, 9);
      assert.match(near.note, /no orbit of point 7/);
      assert.equal(await source.figure({ name: "named" }), "named");
      await assert.rejects(source.figure({ runs: ["c"] }), /no such picture/);
    },
  ],
  [
    "a run is taken out of the text of a study, and no other",
    async (bench) => {
      const { withoutRun } = await load(bench, "study_text");
      const before = 'name = "s"\n\n[runs.one]\nat = [\n  [0, 1],\n  [2, 3]\n]\n[runs.one.set] # its own\nk = 1\n';
      const after = '[runs.one-more]\nkind = "orbit"\n[pictures.one]\nrun = "one-more"\n';
      assert.equal(withoutRun(before + after, "one"), 'name = "s"\n\n' + after);
      assert.equal(withoutRun(before + after, "none"), before + after);
    },
  ],
  [
    "two names of one quantity are no portrait",
    async (bench) => {
      const { areProportional } = await load(bench, "motion_rows");
      assert.ok(areProportional([1, 2, null, 4], [-2, -4, 3, -8]));
      assert.ok(!areProportional([1, 2, 3, 4], [1, 2, 3, 5]));
      assert.ok(!areProportional([1, 2, 3], [1, 1, 1]));
    },
  ],
];
