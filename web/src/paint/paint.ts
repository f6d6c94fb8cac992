/** The paint of an object as the 3D view draws it. */
import type { PaintLayer } from './layer';

/** A layer with its picture or colour. */
export interface PaintedLayer {
  layer: PaintLayer;
  /** From readPicture. */
  picture?: ImageBitmap | undefined;
  /** A plain colour instead of a picture, in sRGB: "#1f4fa8". */
  colour?: string | undefined;
}

/**
 * A base colour ("#1f4fa8"; default: white), and layers above it, the lowest first. As in the API, a 'uv' layer without
 * picture and colour shows the model's own colours; other layers without both are white.
 */
export interface Paint {
  base_colour?: string | undefined;
  layers: PaintedLayer[];
}

/**
 * Decodes a picture for a layer; undefined if the browser cannot (TIFF). The colours of transparent pixels stay as they
 * are in the file, and the file's colour profile is ignored, as in the worker.
 */
export async function readPicture(file: Blob): Promise<ImageBitmap | undefined> {
  const options: ImageBitmapOptions = { premultiplyAlpha: 'none' };
  return createImageBitmap(file, options).catch(() => undefined);
}
