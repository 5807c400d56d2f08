/** The text of a study without the tables of a run: [runs.NAME] and those below it. */
export function withoutRun(text: string, name: string): string {
  const parts = text.split(/^(?=[ \t]*\[[^,\n]*\][ \t]*(?:#.*)?$)/m); // each begins with the header of a table
  const key = name.replace(/[.*+?^${}()|[\]\\]/g, "\\$&");
  const own = new RegExp(`^[ \\t]*\\[\\[?[ \\t]*runs[ \\t]*\\.[ \\t]*(?:${key}|"${key}"|'${key}')[ \\t]*[.\\]]`);
  return parts.filter((part) => !own.test(part)).join("");
}
