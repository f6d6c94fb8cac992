/** Zoom and position of a picture in a window; x and y are its upper left corner. */
export interface View {
  /** Screen pixels per pixel of the picture. */
  zoom: number;
  x: number;
  y: number;
}

export interface Size {
  width: number;
  height: number;
}

export const kMostZoom = 64;

/** Shows the whole picture, centred. */
export function fit(picture: Size, window: Size): View {
  const zoom = Math.min(window.width / picture.width, window.height / picture.height);
  return {
    zoom,
    x: (window.width - zoom * picture.width) / 2,
    y: (window.height - zoom * picture.height) / 2,
  };
}

/** Zooms about the point (x, y), which stays fixed. */
export function zoomAt(view: View, factor: number, x: number, y: number, least: number): View {
  const zoom = Math.max(least, Math.min(kMostZoom, view.zoom * factor));
  const share = zoom / view.zoom;
  return { zoom, x: x - share * (x - view.x), y: y - share * (y - view.y) };
}

/** Moves the picture, but keeps a part of it in the window. */
export function pan(view: View, dx: number, dy: number, picture: Size, window: Size): View {
  const keep = (at: number, size: number, room: number) =>
    Math.max(Math.min(at, 0.8 * room), 0.2 * room - size);
  return {
    zoom: view.zoom,
    x: keep(view.x + dx, view.zoom * picture.width, window.width),
    y: keep(view.y + dy, view.zoom * picture.height, window.height),
  };
}

/** Returns the picture's pixel at a point of the window; undefined outside the picture. */
export function pixelAt(
  view: View,
  x: number,
  y: number,
  picture: Size,
): [number, number] | undefined {
  const i = Math.floor((x - view.x) / view.zoom);
  const j = Math.floor((y - view.y) / view.zoom);
  return i >= 0 && j >= 0 && i < picture.width && j < picture.height ? [i, j] : undefined;
}
