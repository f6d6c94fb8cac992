/** Handles dropped files: classifies them, has the model read, and reports refused files with the reason. */
import { batch, computed, signal } from '@preact/signals';
import type { Warning } from '../../api/types';
import { arrange, isNamed, type Arrangement } from '../../model/arrangement';
import { contradiction, nameFor, roleOf, type Role } from '../../model/files';
import { done, refused, wordsOf, type Result } from '../../model/result';
import { may } from '../../state/session';
import { change, clear, draft, shape, unitOfFormat, type Shape } from './draft';
import type { LayerChoices } from './picture/choices';
import { bring, forget, readModel, stage } from './reading';

interface Problem {
  name: string;
  why: string;
}

/** Refused files, with the reason. */
export const problems = signal<Problem[]>([]);
const kNothing: Arrangement<File> = arrange(undefined, [], []);
export const arrangement = signal(kNothing);

const withRole = (files: readonly File[], role: Role) =>
  files.filter((file) => roleOf(file.name) === role);

/** Why the model lacks its own colours, if nothing else gives it colours. */
export const colourless = computed<Problem[]>(() => {
  const { missing, texture } = arrangement.value;
  const failure = shape.value?.colourless;
  if (missing.length === 0 && failure && !texture)
    return [{ name: meshOf(draft.value.files)?.name ?? 'The model', why: wordsOf(failure) }];
  const why = 'the model names this file. Add it, or choose another texture';
  return missing.map((name) => ({ name, why }));
});

/** Missing colours are a problem, unless a texture replaces them. */
const kOfColours: readonly Warning['code'][] = ['MATERIAL_FILE_MISSING', 'MATERIAL_MISSING'];

/** What the worker noticed while it read the model. */
export const notes = computed(() =>
  (shape.value?.summary.warnings ?? []).filter(({ code }) => !kOfColours.includes(code)),
);

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
  cancel();
  batch(() => {
    clear();
    problems.value = [];
    arrangement.value = kNothing;
  });
}

/** Removes a file from the draft, or from the files that are being read. */
export const remove = (file: File): Promise<void> =>
  readAll(without(pending?.files ?? draft.value.files, file), pending?.isNew ?? false, []);

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
  const files = pending?.files ?? draft.value.files;
  const hasModel = pending !== undefined || waiting.value.length === 0;
  const kept = meshes.length > 0 && hasModel ? withRole(files, 'profile') : files;
  // A newly dropped image replaces the old texture, unless a material references the old one.
  const images = withRole(usable, 'image');
  const stale = images.length > 0 && hasModel && !pending?.isNew && arrangement.value.texture;
  const merged = [
    ...usable,
    ...kept.filter((file) => file !== stale && !usable.some((other) => other.name === file.name)),
  ];
  await readAll(merged, meshes.length > 0 || (pending?.isNew ?? false), bad);
  const { texture } = arrangement.value;
  if (layer && texture && usable.includes(texture)) change({ layer });
}

/** Reads the files of a restored draft again. */
export const reread = (): Promise<void> => readAll(draft.value.files, false, []);

/** Uploads and reads the model again, because the daemon does not have its files any more. */
export function readAgain(): Promise<void> {
  const { files } = draft.value;
  forget(files);
  readFrom = [];
  return readAll(files, false, problems.value);
}

async function whyNot(file: File): Promise<string | undefined> {
  const role = roleOf(file.name);
  if (typeof role !== 'string') return role.why;
  const head = await file
    .slice(0, 16)
    .arrayBuffer()
    .catch(() => undefined);
  if (!head) return 'the file cannot be read. If it is a folder, drop the files inside it';
  return contradiction(role, new Uint8Array(head));
}

/** A model, and InspectSpec.extra_files. */
const kMostFiles = 1 + 256;

/** The files that are being read, and whether they begin a new print. */
let pending: { files: File[]; isNew: boolean; abort: AbortController } | undefined;
/** The files from which the shown model was read. */
let readFrom: readonly File[] = [];

/** Ends the reading of a model. What was there before stays. */
export function cancel(): void {
  pending?.abort.abort();
  pending = undefined;
  stage.value = undefined;
}

async function readAll(files: File[], isNew: boolean, bad: Problem[]): Promise<void> {
  cancel();
  const mesh = meshOf(files);
  if (!mesh) return use(files, undefined, bad);
  const now = { files, isNew, abort: new AbortController() };
  pending = now;
  const read = await readFiles(files, mesh, isNew, now.abort.signal);
  if (pending !== now) return;
  cancel();
  if (read.ok && !isNew) return use(files, read.value, bad);
  if (read.ok) {
    const strays = straysIn(files, read.value);
    const kept = files.filter((file) => !strays.includes(file));
    return use(kept, read.value, [...bad, ...whyStray(strays)], mesh);
  }
  problems.value = [...bad, { name: mesh.name, why: wordsOf(read.failure) }];
  // The files that came with the model wait for a better one.
  const hasModel = shape.value !== undefined || meshOf(draft.value.files) !== undefined;
  if (isNew && !hasModel) use(without(files, mesh), undefined, problems.value);
}

/** Pictures that came with a model but are not of its colours, such as the normal map of a glTF. */
function straysIn(files: readonly File[], { summary }: Shape): File[] {
  const images = withRole(files, 'image');
  const strays = images.filter((image) => !isNamed(image, summary.companions));
  return strays.length < images.length ? strays : [];
}

function whyStray(strays: readonly File[]): Problem[] {
  if (strays.length === 0) return [];
  const why =
    'not used, because the model has pictures of its own. To use a picture as the texture, drop it again';
  return [{ name: strays.map(({ name }) => name).join(', '), why }];
}

/** Takes the files into the draft. `begun`: the model of a new print. */
function use(files: File[], read: Shape | undefined, bad: Problem[], begun?: File): void {
  const before = shape.value;
  batch(() => {
    // The files of a job are complete; its model names none of the dropped ones.
    const ofJob = draft.value.from && before && { ...before.summary, companions: [] };
    arrangement.value = arrange(
      read?.summary ?? ofJob,
      withRole(files, 'material'),
      withRole(files, 'image'),
    );
    problems.value = bad;
    if (read) shape.value = read;
    if (read && begun) begin(begun, files);
    else change({ files });
  });
  if (read) readFrom = files;
  if (read && before && read !== before) closePictures(before);
}

function closePictures({ mesh }: Shape): void {
  for (const { look } of mesh.parts) look.picture?.close();
}

/** The files that the model was, or would be, read from: images only if it names them. */
const bearing = (files: readonly File[], { summary }: Shape): File[] =>
  files.filter((file) => {
    const role = roleOf(file.name);
    const isPart = role === 'image' && isNamed(file, summary.companions);
    return role === 'mesh' || role === 'material' || isPart;
  });

const isSame = (a: readonly File[], b: readonly File[]): boolean =>
  a.length === b.length && a.every((file) => b.includes(file));

/** Returns the shown model if it was read from the same files. */
async function readFiles(
  files: readonly File[],
  mesh: File,
  isNew: boolean,
  signal: AbortSignal,
): Promise<Result<Shape>> {
  const known = draft.value.from ? undefined : shape.value;
  if (known && isSame(bearing(files, known), bearing(readFrom, known))) return done(known);
  if (!may('MAKER'))
    return refused('your role cannot use models', 'Ask an admin for the role Maker');
  const outgoing = [mesh, ...withRole(files, 'material'), ...withRole(files, 'image')].map(
    (file) => ({ name: nameFor(file), file }),
  );
  if (outgoing.length > kMostFiles)
    return refused(
      `the model comes with ${outgoing.length - 1} files, but at most ${kMostFiles - 1} can be used`,
      'Combine its textures in a 3D editor',
    );
  const scale = isNew ? (unitOfFormat(mesh.name) ?? 1) : draft.value.scale;
  for (let isAgain = false; ; isAgain = true) {
    const brought = await bring(outgoing, (now) => (stage.value = now), signal);
    if (!brought.ok) return brought;
    const [first, ...extraFiles] = brought.value;
    const read = await readModel({ mesh: first!, extraFiles }, { scale }, signal);
    if (read.ok || isAgain || read.failure.reason !== 'ASSET_MISSING') return read;
    forget(files);
  }
}

const without = (files: readonly File[], file: File): File[] =>
  files.filter((other) => other !== file);

/** Begins a print of a new model. */
function begin(mesh: File, files: File[]): void {
  const { from: _, ...rest } = draft.value;
  draft.value = { ...rest, files };
  change({
    name: mesh.name.replace(/\.\w+$/, ''),
    scale: unitOfFormat(mesh.name) ?? 1,
    layer: {},
    before: [],
    after: [],
  });
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
    ...(mesh ? [{ role: 'mesh' as const, name: nameFor(mesh), file: mesh }] : []),
    ...(texture ? [{ role: 'texture' as const, name: nameFor(texture), file: texture }] : []),
    ...extra.map(({ name, file }) => ({ role: 'extra' as const, name, file })),
    ...(profile ? [{ role: 'profile' as const, name: nameFor(profile), file: profile }] : []),
  ];
}
