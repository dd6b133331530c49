type Child = Node | string | null;
type Attributes = Record<string, string | number | boolean | ((event: never) => void)>;

/** An element with attributes; functions among them are listeners. */
export function element<K extends keyof HTMLElementTagNameMap>(
  tag: K,
  attributes: Attributes = {},
  ...children: Child[]
): HTMLElementTagNameMap[K] {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (typeof value === "function") made.addEventListener(name, value as EventListener);
    else if (value === true) made.setAttribute(name, "");
    else if (value !== false) made.setAttribute(name, String(value));
  }
  made.append(...children.filter((child) => child !== null));
  return made;
}

export function svg(tag: string, attributes: Record<string, string | number> = {}): SVGElement {
  const made = document.createElementNS("http://www.w3.org/2000/svg", tag);
  for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, String(value));
  return made;
}

/** A list of choices; `groups` maps headings to [value, text]. */
export function choices(label: string, groups: Map<string, [string, string][]>, chosen: string, pick: (value: string) => void): HTMLSelectElement {
  const made = element("select", { "aria-label": label, change: () => pick(made.value) });
  for (const [heading, list] of groups) {
    const options = list.map(([value, text]) => element("option", { value, selected: value === chosen }, text));
    made.append(...(heading === "" ? options : [element("optgroup", { label: heading }, ...options)]));
  }
  return made;
}
