/** Where in a TOML text a position is. */
export interface TomlPlace {
  section: string[]; // names in the brackets above
  key: string; // on the line of the position; empty at its beginning
  inValue: boolean;
  kind: string; // the value of `kind` in the section
}

/** Reads only what completion needs: brackets, keys and kinds, line by line. */
export function tomlPlace(text: string, position: number): TomlPlace {
  const before = text.slice(0, position),
    lines = before.split("\n");
  const line = lines[lines.length - 1];
  let section: string[] = [],
    start = 0;
  lines.forEach((one, index) => {
    const heading = /^\s*\[{1,2}([^\]]+)\]{1,2}\s*(#.*)?$/.exec(one);
    if (!heading || index === lines.length - 1) return;
    section = heading[1].split(".").map((part) => part.trim().replace(/^["']|["']$/g, ""));
    start = index + 1;
  });
  const equals = line.indexOf("=");
  const key = /^\s*([A-Za-z0-9_-]*)/.exec(line)?.[1] ?? "";
  const rest = text.split("\n").slice(start);
  const end = rest.findIndex((one) => /^\s*\[/.test(one));
  const own = end < 0 ? rest : rest.slice(0, end);
  const kind =
    own.map((one) => /^\s*kind\s*=\s*["']([^"']*)/.exec(one)?.[1]).find((value) => value !== undefined) ?? "";
  return { section, key, inValue: equals >= 0, kind };
}

/** Names of all sections below this one, such as those of runs. */
export function namesBelow(text: string, section: string): string[] {
  const names = new Set<string>();
  const pattern = new RegExp(`^\\s*\\[${section}\\.("[^"]+"|[A-Za-z0-9_-]+)`, "gm");
  for (const match of text.matchAll(pattern)) names.add(match[1].replace(/"/g, ""));
  return [...names];
}
