import type { Mistake, Model } from "./contract.js";
import { withUnit } from "./numbers.js";
import { keysAt, meaningAt, valuesAt, wordsIn, type KnownWord } from "./schema_keys.js";
import type { Workshop } from "./source.js";
import type { EditorHelp } from "./text_editor.js";
import { namesBelow, tomlPlace } from "./toml_place.js";

/** Names of the model with units and values, for completion and hovering. */
export function namesOfModel(model: Model | null): KnownWord[] {
  if (!model) return [];
  const parameters = model.parameters.map(({ name, unit, value, words, text }) => ({
    name,
    words: `${text || words || "parameter"} (${withUnit(value, unit)})`,
  }));
  const states = model.states.map(({ name, unit, words, text, initial }) => ({
    name,
    words: `${text || words || "state"} (initially ${withUnit(initial, unit)})`,
  }));
  const quantities = (model.quantities ?? []).map(({ name, unit, words }) => ({
    name,
    words: `${words} ${unit}`.trim(),
  }));
  return [...parameters, ...states, ...quantities];
}

/** What an editor of a study knows: keys of the schema, names of runs, and names of the model. */
export async function studyHelp(
  workshop: Workshop,
  model: () => Model | null,
  changed: (text: string) => void,
): Promise<EditorHelp> {
  const schema = await workshop.schema().catch(() => null);
  return {
    name: "Text of the study",
    check: async (text) => (await workshop.check("study", text)).errors,
    words: (text, position) => {
      const place = tomlPlace(text, position);
      if (!place.inValue) return keysAt(schema, place);
      const runs = ["run", "runs", "start", "over"].includes(place.key) ? namesBelow(text, "runs") : [];
      return [...valuesAt(schema, place), ...runs.map((name) => ({ name, words: "a run" })), ...namesOfModel(model())];
    },
    meaning: (text, position, word) =>
      meaningAt(schema, tomlPlace(text, position), word) ||
      (namesOfModel(model()).find(({ name }) => name === word)?.words ?? ""),
    changed,
  };
}

/** What an editor of a model knows: functions and keys, and the names that the model has so far. */
export async function modelHelp(
  workshop: Workshop,
  model: () => Model | null,
  changed: (text: string) => void,
  checked: (mistakes: Mistake[]) => void,
): Promise<EditorHelp> {
  const words = wordsIn(await workshop.words().catch(() => []));
  const all = () => [...words, ...namesOfModel(model())];
  return {
    name: "Text of the model",
    check: async (text) => (await workshop.check("model", text)).errors,
    words: () => all(),
    meaning: (_, __, word) => all().find(({ name }) => name === word)?.words ?? "",
    changed,
    checked,
  };
}
