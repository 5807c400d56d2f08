type Attribute = string | number | boolean | null | undefined | ((event: never) => void);
type Child = Node | string | null | undefined | false;

/**
 * Makes an element. Attributes whose value is a function listen to the event of that name. Texts become text nodes:
 * nothing that comes from a file is ever read as HTML.
 */
export function make<Tag extends keyof HTMLElementTagNameMap>(
  tag: Tag,
  attributes: Record<string, Attribute> = {},
  ...children: Child[]
): HTMLElementTagNameMap[Tag] {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (value === null || value === undefined || value === false) continue;
    if (typeof value === "function") element.addEventListener(name, value as EventListener);
    else element.setAttribute(name, value === true ? "" : String(value));
  }
  append(element, ...children);
  return element;
}

export function append(element: Element, ...children: Child[]): void {
  for (const child of children) if (child !== null && child !== undefined && child !== false) element.append(child);
}

export function fill(element: Element, ...children: Child[]): void {
  element.replaceChildren();
  append(element, ...children);
}

export function button(text: string, act: () => void, attributes: Record<string, Attribute> = {}): HTMLButtonElement {
  return make("button", { type: "button", click: act, ...attributes }, text);
}

/** What is wrong, which is also read out. */
export function problem(text: string): HTMLElement {
  return make("p", { class: "problem", role: "alert" }, text);
}

export function messageOf(error: unknown): string {
  return error instanceof Error ? error.message : String(error);
}

/** A field with its name beside it. */
export function labelled(
  name: string,
  field: HTMLElement,
  attributes: Record<string, Attribute> = {},
): HTMLLabelElement {
  return make("label", { class: "field", ...attributes }, make("span", {}, name), field);
}

export interface Option {
  value: string;
  text: string;
}

export function choice(
  options: (Option | string)[],
  chosen: string,
  act: (value: string) => void,
  attributes: Record<string, Attribute> = {},
): HTMLSelectElement {
  const select = make("select", { change: () => act(select.value), ...attributes });
  for (const option of options) {
    const { value, text } = typeof option === "string" ? { value: option, text: option } : option;
    const entry = make("option", { value }, text);
    entry.selected = value === chosen;
    select.append(entry);
  }
  return select;
}

export function checkbox(text: string, checked: boolean, act: (on: boolean) => void): HTMLLabelElement {
  const box = make("input", { type: "checkbox", change: () => act(box.checked) });
  box.checked = checked;
  return make("label", { class: "check" }, box, text);
}

const svgNamespace = "http://www.w3.org/2000/svg";

export function makeSvg(tag: string, attributes: Record<string, string | number>, ...children: Node[]): SVGElement {
  const element = document.createElementNS(svgNamespace, tag);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, String(value));
  element.append(...children);
  return element;
}

/** Offers a file for download. */
export function offer(name: string, content: Blob): void {
  const address = URL.createObjectURL(content);
  const link = make("a", { href: address, download: name });
  document.body.append(link);
  link.click();
  link.remove();
  setTimeout(() => URL.revokeObjectURL(address), 10000);
}
