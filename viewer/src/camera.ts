export interface Box {
  left: number;
  right: number;
  bottom: number;
  top: number;
}

/** Where a point of the plane stands in the picture; y goes up in the plane and down in the picture. */
export class Camera {
  x = 0;
  y = 0;
  /** Pixels of the style sheet for a unit of length. */
  scale = 1;
  width = 1;
  height = 1;
  private home: Box = { left: 0, right: 1, bottom: 0, top: 1 };
  private fitted = true;

  constructor(private readonly changed: () => void) {}

  resize(width: number, height: number): void {
    this.width = Math.max(width, 1);
    this.height = Math.max(height, 1);
    if (this.fitted) this.fit();
    this.changed();
  }

  /** What `fit` shows. */
  setHome(box: Box): void {
    this.home = box;
    if (this.fitted) this.fit();
  }

  fit(): void {
    const { left, right, bottom, top } = this.home;
    const margin = 28;
    this.scale = Math.min(
      Math.max(this.width - 2 * margin, 1) / Math.max(right - left, 1e-300),
      Math.max(this.height - 2 * margin, 1) / Math.max(top - bottom, 1e-300),
    );
    this.x = (left + right) / 2;
    this.y = (bottom + top) / 2;
    this.fitted = true;
    this.changed();
  }

  pan(right: number, down: number): void {
    this.x -= right / this.scale;
    this.y += down / this.scale;
    this.fitted = false;
    this.changed();
  }

  /** Zooms about a point of the picture, by default its middle. */
  zoom(times: number, at = { x: this.width / 2, y: this.height / 2 }): void {
    const held = this.toPlane(at.x, at.y);
    const size = Math.max(this.home.right - this.home.left, this.home.top - this.home.bottom);
    const scale = this.scale * times;
    this.scale = Math.min(Math.max(scale, (0.05 * this.width) / size), (1e6 * this.width) / size);
    const moved = this.toPlane(at.x, at.y);
    this.x += held.x - moved.x;
    this.y += held.y - moved.y;
    this.fitted = false;
    this.changed();
  }

  moveTo(x: number, y: number, scale: number): void {
    Object.assign(this, { x, y, scale });
    this.fitted = false;
    this.changed();
  }

  toPlane(x: number, y: number): { x: number; y: number } {
    return { x: this.x + (x - this.width / 2) / this.scale, y: this.y - (y - this.height / 2) / this.scale };
  }

  toPicture(x: number, y: number): { x: number; y: number } {
    return { x: this.width / 2 + (x - this.x) * this.scale, y: this.height / 2 - (y - this.y) * this.scale };
  }
}
