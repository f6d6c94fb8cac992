/** The pictures of the draft as the browser decodes them. It cannot decode TIFF. */
import { computed, effect, signal } from '@preact/signals';
import type { Arrangement } from '../../../model/arrangement';
import { readPicture } from '../../../paint/paint';
import { arrangement } from '../intake';

export interface Decoded {
  /** The arrangement of files to which the pictures belong. */
  of: Arrangement<File> | undefined;
  pictures: ReadonlyMap<File, ImageBitmap>;
}

export const decoded = signal<Decoded>({ of: undefined, pictures: new Map() });

const known = new WeakMap<File, Promise<ImageBitmap | undefined>>();

function read(file: File): Promise<ImageBitmap | undefined> {
  const picture = known.get(file) ?? readPicture(file);
  known.set(file, picture);
  return picture;
}

async function decode({ materials, texture }: Arrangement<File>): Promise<Decoded['pictures']> {
  const pictures = new Map<File, ImageBitmap>();
  for (const file of [texture, ...[...materials.values()].map((material) => material.file)]) {
    const picture = file && (await read(file));
    if (file && picture) pictures.set(file, picture);
  }
  return pictures;
}

/** Keeps the pictures up to date until the returned function is called. */
export const followPictures = (): (() => void) =>
  effect(() => {
    const of = arrangement.value;
    void decode(of).then((pictures) => {
      if (arrangement.peek() === of) decoded.value = { of, pictures };
    });
  });

/** The texture's picture; undefined without a texture, and until it is decoded. */
export const texturePicture = computed(() => {
  const { of, pictures } = decoded.value;
  const { texture } = arrangement.value;
  return of === arrangement.value && texture ? pictures.get(texture) : undefined;
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
