/** Follows fingers and the wheel on the object, and changes the picture's layer. Independent of the DOM. */
import type { PaintLayer } from '../../../paint/layer';
import type { Placement } from '../../../paint/placement';
import type { Quaternion } from '../../../model/pose';
import type { SurfacePoint } from '../../../view3d/pose_view';
import type { LayerChoices } from './choices';
import { moved, scaled, turned, twisted, type Grip } from './move';

export interface PlacedLayer {
  layer: PaintLayer;
  placement: Placement;
  rotation_FO: Quaternion;
}

/** What gestures need of the page. */
export interface Surroundings {
  /** The point of the object at a place on the screen. */
  hit(x: number, y: number): SurfacePoint | undefined;
  /** The layer as it is now; undefined if no picture can be moved. */
  current(): PlacedLayer | undefined;
  change(part: LayerChoices): void;
}

export interface Finger {
  id: number;
  x: number;
  y: number;
}

interface Pinch {
  grip: Grip;
  distance: number;
  /** Counter-clockwise. */
  angle: number;
}

const kThreshold_px = 3;
const kPerWheelPixel = 0.001;

export class PictureGestures {
  private readonly fingers = new Map<number, Finger>();
  private grip: Grip | undefined;
  private pinch: Pinch | undefined;
  private start: Finger | undefined;
  private isTurning = false;
  private isMoving = false;

  constructor(private readonly page: Surroundings) {}

  /** Begins or extends a gesture; false if the finger does not touch the object. */
  down(finger: Finger, isTurning: boolean): boolean {
    if (this.fingers.size >= 2) return true;
    if (this.fingers.size === 0 && !this.gripAt(finger)) return false;
    this.fingers.set(finger.id, finger);
    this.begin(isTurning);
    return true;
  }

  move(finger: Finger, isTurning: boolean): void {
    if (!this.fingers.has(finger.id)) return;
    this.fingers.set(finger.id, finger);
    if (this.pinch) return this.movePinch(this.pinch);
    if (isTurning !== this.isTurning) this.begin(isTurning);
    if (!this.hasMoved(finger)) return;
    this.grip ??= this.gripAt(finger);
    const to = this.grip && this.page.hit(finger.x, finger.y);
    if (!this.grip || !to) return;
    this.page.change(this.isTurning ? turned(this.grip, to) : moved(this.grip, to));
  }

  up(id: number): void {
    if (this.fingers.delete(id)) this.begin(false);
  }

  /** Scales the picture under the pointer; false if the object is not there. */
  wheel(x: number, y: number, pixels: number): boolean {
    const now = this.page.current();
    if (!now || !this.page.hit(x, y)) return false;
    const factor = Math.exp(-kPerWheelPixel * pixels);
    this.page.change(scaled(now.layer, now.placement, factor));
    return true;
  }

  get isActive(): boolean {
    return this.fingers.size > 0;
  }

  /** Starts again from the fingers that are down and the layer as it is now. */
  private begin(isTurning: boolean): void {
    const [first, second] = [...this.fingers.values()];
    this.isTurning = isTurning;
    this.isMoving = false;
    this.start = first;
    this.pinch = first && second && this.pinchOf(first, second);
    this.grip = first && !second ? this.gripAt(first) : undefined;
  }

  /** A touch that does not move changes nothing. */
  private hasMoved({ x, y }: Finger): boolean {
    const { start } = this;
    this.isMoving ||= start !== undefined && Math.hypot(x - start.x, y - start.y) >= kThreshold_px;
    return this.isMoving;
  }

  private gripAt({ x, y }: Finger): Grip | undefined {
    const at = this.page.hit(x, y);
    const now = at && this.page.current();
    return now && { ...now, at };
  }

  private pinchOf(a: Finger, b: Finger): Pinch | undefined {
    const grip = this.gripAt(a) ?? this.gripAt(b);
    return grip && { grip, ...between(a, b) };
  }

  private movePinch({ grip, distance, angle }: Pinch): void {
    const [a, b] = [...this.fingers.values()];
    if (!a || !b) return;
    const now = between(a, b);
    const degrees = ((now.angle - angle) * 180) / Math.PI;
    const factor = now.distance / Math.max(1, distance);
    this.page.change({ ...scaled(grip.layer, grip.placement, factor), ...twisted(grip, degrees) });
  }
}

/** Distance and direction of two fingers; y points down on the screen. */
const between = (a: Finger, b: Finger) => ({
  distance: Math.hypot(b.x - a.x, b.y - a.y),
  angle: Math.atan2(a.y - b.y, b.x - a.x),
});
