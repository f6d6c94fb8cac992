/** The texture of the draft as the browser decodes it. It cannot decode TIFF. */
import { computed, effect, signal } from '@preact/signals';
import type { Arrangement } from '../../../model/arrangement';
import { readPicture } from '../../../paint/paint';
import { arrangement } from '../intake';

export interface Decoded {
  /** The arrangement of files to which the picture belongs. */
  of: Arrangement<File> | undefined;
  picture?: ImageBitmap | undefined;
}

export const decoded = signal<Decoded>({ of: undefined });

const known = new WeakMap<File, Promise<ImageBitmap | undefined>>();

function read(file: File): Promise<ImageBitmap | undefined> {
  const picture = known.get(file) ?? readPicture(file);
  known.set(file, picture);
  return picture;
}

/** Keeps the picture up to date until the returned function is called. */
export const followPicture = (): (() => void) =>
  effect(() => {
    const of = arrangement.value;
    void Promise.resolve(of.texture && read(of.texture)).then((picture) => {
      if (arrangement.peek() === of) decoded.value = { of, picture };
    });
  });

/** The texture's picture; undefined without a texture, and until it is decoded. */
export const texturePicture = computed(() => {
  const { of, picture } = decoded.value;
  return of === arrangement.value ? picture : undefined;
});

/** True if the browser cannot show the texture. */
export const isUndecodable = computed(
  () =>
    arrangement.value.texture !== undefined &&
    decoded.value.of === arrangement.value &&
    texturePicture.value === undefined,
);

/** Width of a picture divided by its height; 1 if the browser cannot decode it. */
export async function aspectOf(file: File): Promise<number> {
  const picture = await read(file);
  return picture ? picture.width / picture.height : 1;
}
