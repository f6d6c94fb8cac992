/** Passes the pointer events of the 3D view to the picture's gestures, before the camera sees them. */
import { PictureGestures, type Finger, type Surroundings } from './gestures';

const kPixelsPerLine = 16;
const kPixelsPerPage = 400;

const fingerOf = (event: PointerEvent): Finger => ({
  id: event.pointerId,
  x: event.clientX,
  y: event.clientY,
});

const pixelsOf = ({ deltaY, deltaMode }: WheelEvent): number =>
  deltaY * ([1, kPixelsPerLine, kPixelsPerPage][deltaMode] ?? 1);

/** Listens until the returned function is called. Touches beside the object are left to the camera. */
export function listen(host: HTMLElement, page: Surroundings): () => void {
  const gestures = new PictureGestures(page);
  const ofCamera = new Set<number>();
  const take = (event: Event) => {
    event.preventDefault();
    event.stopPropagation();
  };
  const down = (event: PointerEvent) => {
    const isOurs = event.button === 0 && ofCamera.size === 0;
    if (!isOurs || !gestures.down(fingerOf(event), event.shiftKey))
      return void ofCamera.add(event.pointerId);
    take(event);
    host.setPointerCapture(event.pointerId);
  };
  const move = (event: PointerEvent) => {
    if (!gestures.isActive) return;
    take(event);
    gestures.move(fingerOf(event), event.shiftKey);
  };
  const up = (event: PointerEvent) => {
    ofCamera.delete(event.pointerId);
    gestures.up(event.pointerId);
  };
  const wheel = (event: WheelEvent) => {
    if (gestures.wheel(event.clientX, event.clientY, pixelsOf(event))) take(event);
  };
  const ends = [
    on(host, 'pointerdown', down),
    on(host, 'pointermove', move),
    on(host, 'wheel', wheel),
    on(window, 'pointerup', up),
    on(window, 'pointercancel', up),
  ];
  host.style.touchAction = 'none';
  return () => {
    ends.forEach((end) => end());
    host.style.touchAction = '';
  };
}

function on<K extends keyof HTMLElementEventMap>(
  target: HTMLElement | Window,
  name: K,
  listener: (event: HTMLElementEventMap[K]) => void,
): () => void {
  const options = { capture: true, passive: false };
  target.addEventListener(name, listener as EventListener, options);
  return () => target.removeEventListener(name, listener as EventListener, options);
}
