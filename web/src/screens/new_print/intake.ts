/** Handles dropped files: classifies them, reads the model, and reports refused files with the reason. */
import { batch, computed, signal } from '@preact/signals';
import { arrange, type Arrangement } from '../../model/arrangement';
import { contradiction, nameFor, roleOf, type Role } from '../../model/files';
import { decodeText } from '../../model/mtl';
import { refused, type Result } from '../../model/result';
import { readMesh } from '../../worker/reader';
import { change, clear, draft, firstScale, shape, type Shape } from './draft';
import type { LayerChoices } from './picture/choices';

interface Problem {
  name: string;
  why: string;
}

/** Refused files, with the reason. */
export const problems = signal<Problem[]>([]);
const kNothing: Arrangement<File> = arrange(undefined, [], []);
export const arrangement = signal(kNothing);
export const isReading = signal(false);

const withRole = (files: readonly File[], role: Role) =>
  files.filter((file) => roleOf(file.name) === role);

/** Returns the model among the files. */
export const meshOf = (files: readonly File[]): File | undefined => withRole(files, 'mesh')[0];
export const profileOf = (files: readonly File[]): File | undefined =>
  withRole(files, 'profile')[0];

/** Files without a model. They are used when the model arrives. */
export const waiting = computed(() => {
  const { files, from } = draft.value;
  return shape.value || from || meshOf(files) ? [] : files;
});

/** Forgets the draft and its files. */
export function startOver(): void {
  batch(() => {
    clear();
    problems.value = [];
    arrangement.value = kNothing;
  });
}

/** Removes a file from the draft. */
export const remove = (file: File): Promise<void> =>
  readAll(without(draft.value.files, file), false, []);

/**
 * Adds files to the draft. A new model replaces the old one and all files that belong to it.
 * @param layer  of the picture among the files, if it becomes the texture
 */
export async function take(dropped: readonly File[], layer?: LayerChoices): Promise<void> {
  const good: File[] = [];
  const bad: Problem[] = [];
  for (const file of dropped) {
    const why = await whyNot(file);
    if (why) bad.push({ name: file.name, why });
    else good.push(file);
  }
  const meshes = withRole(good, 'mesh');
  for (const extra of meshes.slice(1))
    bad.push({
      name: extra.name,
      why: 'only one object can be dipped at a time. Drop one model only',
    });
  problems.value = bad;
  const usable = good.filter((file) => !meshes.slice(1).includes(file));
  if (usable.length === 0) return;
  const { files } = draft.value;
  const hasModel = waiting.value.length === 0;
  const kept = meshes.length > 0 && hasModel ? withRole(files, 'profile') : files;
  // A newly dropped image replaces the old texture, unless a material references the old one.
  const images = withRole(usable, 'image');
  const stale = images.length > 0 && hasModel && arrangement.value.texture;
  const merged = [
    ...usable,
    ...kept.filter((file) => file !== stale && !usable.some((other) => other.name === file.name)),
  ];
  await readAll(merged, meshes.length > 0, bad);
  const { texture } = arrangement.value;
  if (layer && texture && usable.includes(texture)) change({ layer });
}

/** Reads the files of a restored draft again. */
export const reread = (): Promise<void> => readAll(draft.value.files, false, []);

async function whyNot(file: File): Promise<string | undefined> {
  const role = roleOf(file.name);
  if (typeof role !== 'string') return role.why;
  const head = await file
    .slice(0, 4096)
    .arrayBuffer()
    .catch(() => undefined);
  if (!head) return 'the file cannot be read. If it is a folder, drop the files inside it';
  return contradiction(role, file.name, new Uint8Array(head));
}

async function readAll(files: File[], isNew: boolean, bad: Problem[]): Promise<void> {
  isReading.value = true;
  const mesh = meshOf(files);
  const read = mesh && (await readMesh(mesh));
  const mtl = await Promise.all(
    withRole(files, 'material').map(async (file) => ({
      file,
      text: decodeText(await file.arrayBuffer()),
    })),
  );
  isReading.value = false;
  if (mesh && read && !read.ok) {
    const { what, remedy } = read.failure;
    problems.value = [...bad, { name: mesh.name, why: remedy ? `${what}. ${remedy}` : what }];
    // The files that came with the model wait for a better one.
    const hasModel = shape.value !== undefined || meshOf(draft.value.files) !== undefined;
    if (isNew && !hasModel) await readAll(without(files, mesh), false, problems.value);
    return;
  }
  batch(() => {
    const model = mesh && read?.ok ? { name: mesh.name, mesh: read.value.mesh } : undefined;
    arrangement.value = withPictures(arrange(model, mtl, withRole(files, 'image')));
    problems.value = bad;
    if (read?.ok) shape.value = read.value;
    if (isNew && mesh && read?.ok) begin(mesh, read.value, files);
    else change({ files });
  });
}

const without = (files: readonly File[], file: File): File[] =>
  files.filter((other) => other !== file);

/** Begins a print of a new model. */
function begin(mesh: File, read: Shape, files: File[]): void {
  const { from: _, ...rest } = draft.value;
  draft.value = { ...rest, files };
  change({
    name: mesh.name.replace(/\.\w+$/, ''),
    scale: firstScale(read),
    layer: {},
    before: [],
    after: [],
  });
}

/** Adds the images embedded in the model as files for display. They are not uploaded separately. */
function withPictures(found: Arrangement<File>): Arrangement<File> {
  const materials = new Map(found.materials);
  for (const [name, { picture, ...material }] of found.materials) {
    if (!picture || material.file) continue;
    // Copied, because the bytes are part of the model's buffer.
    const file = new File([picture.bytes.slice()], name, { type: picture.type });
    materials.set(name, { ...material, file });
  }
  return { ...found, materials };
}

interface Sample {
  name: string;
  label: string;
}

export async function samples(): Promise<Sample[]> {
  const response = await fetch('samples.json').catch(() => undefined);
  return response?.ok ? ((await response.json()) as Sample[]) : [];
}

/** Fetches a sample and handles it like dropped files. */
export async function takeSample(name: string): Promise<Result<void>> {
  const files: File[] = [];
  for (const ending of ['obj', 'mtl', 'png']) {
    const response = await fetch(`samples/${name}.${ending}`).catch(() => undefined);
    if (!response?.ok)
      return refused('the sample cannot be downloaded', 'Try again, or drop a model of your own');
    files.push(new File([await response.blob()], `${name}.${ending}`));
  }
  await take(files);
  return { ok: true, value: undefined };
}

/** The draft's files with their names and roles in the job. */
export function inputsOf(
  files: readonly File[],
): { role: 'mesh' | 'texture' | 'extra' | 'profile'; name: string; file: File }[] {
  const { extra, texture } = arrangement.value;
  const mesh = meshOf(files);
  const profile = profileOf(files);
  return [
    ...(mesh ? [{ role: 'mesh' as const, name: nameFor(mesh, []), file: mesh }] : []),
    ...(texture ? [{ role: 'texture' as const, name: nameFor(texture, []), file: texture }] : []),
    ...extra.map(({ name, file }) => ({ role: 'extra' as const, name, file })),
    ...(profile ? [{ role: 'profile' as const, name: nameFor(profile, []), file: profile }] : []),
  ];
}
