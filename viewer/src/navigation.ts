import type { Camera } from "./camera";

interface Finger {
  x: number;
  y: number;
}

/** Mouse, wheel, touch and keys on the picture. */
export function navigate(canvas: HTMLCanvasElement, camera: Camera, click: (x: number, y: number) => void): void {
  const fingers = new Map<number, Finger>();
  let travelled = 0;
  const place = (event: PointerEvent | WheelEvent): Finger => {
    const box = canvas.getBoundingClientRect();
    return { x: event.clientX - box.left, y: event.clientY - box.top };
  };
  canvas.addEventListener("pointerdown", (event) => {
    if (event.button !== 0) return;
    canvas.setPointerCapture(event.pointerId);
    fingers.set(event.pointerId, place(event));
    if (fingers.size === 1) travelled = 0;
  });
  canvas.addEventListener("pointermove", (event) => {
    const before = fingers.get(event.pointerId);
    if (!before) return;
    const now = place(event);
    const other = [...fingers].find(([id]) => id !== event.pointerId)?.[1];
    travelled += Math.hypot(now.x - before.x, now.y - before.y);
    if (other) pinch(camera, before, now, other);
    else camera.pan(now.x - before.x, now.y - before.y);
    fingers.set(event.pointerId, now);
  });
  canvas.addEventListener("pointerup", (event) => {
    const at = place(event);
    if (fingers.delete(event.pointerId) && fingers.size === 0 && travelled < 5) click(at.x, at.y);
  });
  canvas.addEventListener("pointercancel", (event) => fingers.delete(event.pointerId));
  canvas.addEventListener("dblclick", (event) => camera.zoom(2, { x: event.offsetX, y: event.offsetY }));
  canvas.addEventListener("wheel", (event) => {
    event.preventDefault();
    const lines = event.deltaMode === WheelEvent.DOM_DELTA_PIXEL ? event.deltaY / 100 : event.deltaY / 3;
    camera.zoom(Math.pow(1.25, -Math.min(Math.max(lines, -4), 4)), place(event));
  }, { passive: false });
  canvas.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.altKey || event.metaKey) return;
    if (key(event.key, camera, click)) {
      event.preventDefault();
      event.stopPropagation();
    }
  });
}

function pinch(camera: Camera, before: Finger, now: Finger, other: Finger): void {
  const [old, new_] = [before, now].map((finger) => Math.hypot(finger.x - other.x, finger.y - other.y)) as [number, number];
  if (old > 0 && new_ > 0) camera.zoom(new_ / old, { x: (now.x + other.x) / 2, y: (now.y + other.y) / 2 });
  camera.pan((now.x - before.x) / 2, (now.y - before.y) / 2);
}

function key(name: string, camera: Camera, click: (x: number, y: number) => void): boolean {
  const step = 60;
  switch (name) {
    case "ArrowLeft": camera.pan(step, 0); return true;
    case "ArrowRight": camera.pan(-step, 0); return true;
    case "ArrowUp": camera.pan(0, step); return true;
    case "ArrowDown": camera.pan(0, -step); return true;
    case "Enter": click(camera.width / 2, camera.height / 2); return true;
    default: return false;
  }
}
