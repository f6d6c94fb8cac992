/**
 * Draws models and paints with the page's materials for paint.e2e.ts and reading.e2e.ts: without light, and with an
 * orthographic camera.
 */
import { OrthographicCamera, Scene, Vector3, WebGLRenderer } from 'three';
import { modelOf } from '../src/engine/model';
import { centreOf } from '../src/model/mesh';
import type { Vec3 } from '../src/model/pose';
import type { PaintLayer } from '../src/paint/layer';
import { readPicture, type Paint } from '../src/paint/paint';
import { PaintedObject } from '../src/paint/painted_object';

export interface Drawing {
  /** The mesh as `inspect` returns it (model.glb), base64. */
  mesh: string;
  base_colour?: string;
  /** `picture`: a PNG, base64. Without layers, the model is drawn in its own colours. */
  layers?: { layer: PaintLayer; picture?: string; colour?: string }[];
  pixels: number;
  half_mm: number;
  direction: Vec3;
  up: Vec3;
}

const bytesOf = (base64: string) => Uint8Array.from(atob(base64), (c) => c.charCodeAt(0));

function base64Of(bytes: Uint8Array): string {
  let text = '';
  for (let i = 0; i < bytes.length; i += 8192)
    text += String.fromCharCode(...bytes.subarray(i, i + 8192));
  return btoa(text);
}

function cameraOf({ half_mm: h, direction, up }: Drawing, middle: Vector3): OrthographicCamera {
  const camera = new OrthographicCamera(-h, h, h, -h, 0, 20 * h);
  const ahead = new Vector3(...direction).normalize();
  camera.up.set(...up);
  camera.position.copy(middle).addScaledVector(ahead, -10 * h);
  camera.lookAt(middle);
  return camera;
}

async function paintOf({ layers, base_colour }: Drawing): Promise<Paint | undefined> {
  const withPictures = layers?.map(async ({ layer, picture, colour }) => ({
    layer,
    colour,
    picture: picture ? await readPicture(new Blob([bytesOf(picture)])) : undefined,
  }));
  return withPictures && { base_colour, layers: await Promise.all(withPictures) };
}

/** Returns the pixels, red, green, blue, alpha, from the upper left; base64. Alpha is 0 where nothing is seen. */
async function draw(drawing: Drawing): Promise<string> {
  const { pixels } = drawing;
  const renderer = new WebGLRenderer({ alpha: true, preserveDrawingBuffer: true });
  renderer.setSize(pixels, pixels);
  const painted = new PaintedObject(renderer, () => {}, false);
  const read = await modelOf(bytesOf(drawing.mesh).buffer);
  if (!read.ok) throw new Error(read.failure.what);
  const { mesh, box } = read.value;
  painted.setMesh(mesh, box, 1);
  painted.setPaint(await paintOf(drawing));
  await painted.settled();
  const scene = new Scene();
  scene.add(painted.object);
  renderer.render(scene, cameraOf(drawing, new Vector3(...centreOf(box))));
  const out = pixelsOf(renderer, pixels);
  painted.dispose();
  renderer.dispose();
  renderer.forceContextLoss();
  return base64Of(out);
}

function pixelsOf(renderer: WebGLRenderer, pixels: number): Uint8Array {
  const gl = renderer.getContext();
  const upward = new Uint8Array(4 * pixels * pixels);
  gl.readPixels(0, 0, pixels, pixels, gl.RGBA, gl.UNSIGNED_BYTE, upward);
  const out = new Uint8Array(upward.length);
  const row = 4 * pixels;
  for (let y = 0; y < pixels; y += 1)
    out.set(upward.subarray((pixels - 1 - y) * row, (pixels - y) * row), y * row);
  return out;
}

/** Returns the pixels of a PNG (base64), as those of draw(). */
async function read(png: string): Promise<string> {
  const picture = await createImageBitmap(new Blob([bytesOf(png)]));
  const canvas = new OffscreenCanvas(picture.width, picture.height);
  const context = canvas.getContext('2d')!;
  context.drawImage(picture, 0, 0);
  const { data } = context.getImageData(0, 0, picture.width, picture.height);
  return base64Of(new Uint8Array(data.buffer));
}

declare global {
  interface Window {
    drawPaint: typeof draw;
    readPng: typeof read;
  }
}
window.drawPaint = draw;
window.readPng = read;
