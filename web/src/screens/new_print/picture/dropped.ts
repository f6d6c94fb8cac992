/** Takes files that were dropped on the page. A picture that was dropped on the object lands there. */
import { draft, longest_mm } from '../draft';
import { arrangement, take } from '../intake';
import { setMode, view } from '../mode';
import { aspectOf } from './decoded';
import { decalAt, landing } from './drop';
import { rotation } from './placed';

/** @param x, y  place on the screen, as of a pointer event */
export async function takeDropped(files: readonly File[], x: number, y: number): Promise<void> {
  const hit = view.value?.hit(x, y);
  const picture = landing(files, hit);
  if (!hit || !picture) return take(files);
  const aspect = await aspectOf(picture);
  await take(files, decalAt(hit, longest_mm.value, aspect, rotation.value));
  const hasLanded = arrangement.value.texture === picture;
  if (hasLanded && draft.value.layer.projection === 'decal') setMode('picture');
}
