import type { TomlPlace } from "./toml_place.js";

/** A word that can be written at a place, and what it means. */
export interface KnownWord {
  name: string;
  words: string;
}

interface Schema {
  type?: string | string[];
  description?: string;
  enum?: unknown[];
  properties?: Record<string, Schema>;
  additionalProperties?: Schema | boolean;
  allOf?: { if?: { properties?: Record<string, { const?: unknown }> }; then?: Schema }[];
}

/** The keys of several schemas; what one says of a key adds to what others say. */
function merged(schemas: Schema[]): Record<string, Schema> {
  const keys: Record<string, Schema> = {};
  for (const { properties = {} } of schemas)
    for (const [name, one] of Object.entries(properties)) keys[name] = { ...keys[name], ...one };
  return keys;
}

/** The part of the schema that describes a section, with the keys that its kind has. */
function schemaAt(root: Schema, place: TomlPlace): Schema | null {
  let schema: Schema | undefined = root;
  for (const name of place.section) {
    const known: Schema | undefined = schema.properties?.[name];
    const other: Schema | undefined =
      typeof schema.additionalProperties === "object" ? schema.additionalProperties : undefined;
    schema = known ?? other;
    if (!schema) return null;
    const chosen: Schema | undefined = schema.allOf?.find(
      (one) => one.if?.properties?.kind?.const === place.kind,
    )?.then;
    // As long as the kind is not said, every key may be meant.
    const every: Schema[] = place.kind === "" ? (schema.allOf ?? []).flatMap((one) => one.then ?? []) : [];
    schema = { ...schema, properties: merged([schema, ...(chosen ? [chosen] : every)]) };
  }
  return schema;
}

export function keysAt(schema: unknown, place: TomlPlace): KnownWord[] {
  const found = schemaAt((schema ?? {}) as Schema, place);
  return Object.entries(found?.properties ?? {}).map(([name, one]) => ({ name, words: one.description ?? "" }));
}

/** Values of a key that has only a few. */
export function valuesAt(schema: unknown, place: TomlPlace): KnownWord[] {
  const found = schemaAt((schema ?? {}) as Schema, place)?.properties?.[place.key];
  if (found?.enum) return found.enum.map((value) => ({ name: String(value), words: "" }));
  return found?.type === "boolean" ? ["true", "false"].map((name) => ({ name, words: "" })) : [];
}

export function meaningAt(schema: unknown, place: TomlPlace, word: string): string {
  return keysAt(schema, place).find(({ name }) => name === word)?.words ?? "";
}

/** All words in an answer of names: texts, and objects that have a name. */
export function wordsIn(answer: unknown): KnownWord[] {
  const known = new Map<string, string>();
  const visit = (value: unknown): void => {
    if (typeof value === "string") known.set(value, known.get(value) ?? "");
    else if (Array.isArray(value)) value.forEach(visit);
    else if (value && typeof value === "object") {
      const { name, words, text } = value as { name?: unknown; words?: unknown; text?: unknown };
      if (typeof name === "string") known.set(name, String(words ?? text ?? ""));
      else Object.values(value).forEach(visit);
    }
  };
  visit(answer);
  return [...known].map(([name, words]) => ({ name, words }));
}
