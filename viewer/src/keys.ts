import type { Camera } from "./camera";
import { ENTRIES, toggle } from "./controls";
import { go, togglePlay } from "./timeline";
import type { Store } from "./store";

export interface Actions {
  camera: Camera;
  find: () => void;
  theme: () => void;
  information: () => void;
  help: () => void;
}

/** Keys of the whole page; in a report only those pressed inside the viewer. */
export function listenToKeys(target: HTMLElement | Document, store: Store, actions: Actions): void {
  target.addEventListener("keydown", (event) => {
    const { key, ctrlKey, altKey, metaKey, defaultPrevented } = event as KeyboardEvent;
    if (ctrlKey || altKey || metaKey || defaultPrevented || takesKeys(event.target as HTMLElement, key)) return;
    if (act(key, store, actions)) event.preventDefault();
  });
}

/** Whether the element with the focus has its own use for a key. */
function takesKeys(element: HTMLElement, key: string): boolean {
  if (element.closest?.("dialog")) return true;
  if (element instanceof HTMLSelectElement || element instanceof HTMLTextAreaElement) return true;
  if (element instanceof HTMLInputElement) {
    if (element.type === "checkbox") return key === " ";
    return element.type !== "range" || key.startsWith("Arrow") || ["Home", "End"].includes(key);
  }
  return (element instanceof HTMLButtonElement || element.tagName === "SUMMARY") && (key === " " || key === "Enter");
}

function act(key: string, store: Store, actions: Actions): boolean {
  const { camera } = actions;
  const count = store.state.run.recorded.length;
  const keys: Record<string, () => void> = {
    " ": () => togglePlay(store),
    ",": () => go(store, -1), ".": () => go(store, 1), ArrowLeft: () => go(store, -1), ArrowRight: () => go(store, 1),
    Home: () => go(store, -count), End: () => go(store, count),
    "+": () => camera.zoom(1.25), "=": () => camera.zoom(1.25), "-": () => camera.zoom(0.8), "0": () => camera.fit(),
    Escape: () => store.set({ selection: null }),
    "/": actions.find, t: actions.theme, i: actions.information, "?": actions.help,
  };
  for (const { key: own, layer } of ENTRIES) keys[own] = () => toggle(store, layer);
  keys[key]?.();
  return key in keys;
}
