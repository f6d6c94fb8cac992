/** Resumable uploads: they continue after a lost connection and after a reload of the page. */
import { done, refused, type Result } from '../model/result';
import { call } from './call';
import { sha256 } from './sha256';
import type { Asset, Upload } from './types';

// Below 1 MiB, nginx's default limit for request bodies.
const kChunk = 512 << 10;
const kWaits_s = [0.5, 1, 2, 4, 8, 15];

type Answer = { asset?: Asset; receivedBytes?: number };
type Started = { asset?: Asset; upload?: Upload };

const wait = (seconds: number) => new Promise((resolve) => setTimeout(resolve, 1000 * seconds));

/**
 * Uploads a file unless the daemon already has it, and returns the name of its asset ("assets/...").
 * @param onProgress  called with the uploaded fraction and whether the connection is lost
 */
export async function upload(
  file: Blob,
  onProgress: (share: number, isLost: boolean) => void,
  signal: AbortSignal,
): Promise<Result<string>> {
  const hash = await sha256(file, signal).catch(() => undefined);
  if (signal.aborted) return refused('cancelled', undefined, { reason: 'ABORTED_HERE' });
  if (!hash) return unreadable;
  const resumable = new ResumableUpload(hash);
  let share = 0;
  for (let lost = 0; ; ) {
    const answer = await step(file, hash, resumable, signal);
    if (answer.ok) {
      if (answer.value.asset) {
        resumable.forget();
        return done(answer.value.asset.name);
      }
      const got = answer.value.receivedBytes ?? 0;
      const before = share;
      share = file.size > 0 ? got / file.size : 1;
      if (share > before) lost = 0;
      onProgress(share, false);
      continue;
    }
    const { failure } = answer;
    if (signal.aborted || !passes(failure.status, failure.reason)) return answer;
    // If the daemon has discarded the upload, start again; otherwise continue from its offset.
    resumable.offset = undefined;
    if (failure.reason === 'UPLOAD_NOT_FOUND') resumable.forget();
    onProgress(share, failure.status === 0);
    await wait(kWaits_s[Math.min(lost, kWaits_s.length - 1)]!);
    lost += 1;
  }
}

const unreadable = refused(
  'the file cannot be read; it may have been moved or changed',
  'Choose the file again',
);

const passes = (status: number | undefined, reason: string | undefined): boolean =>
  status === 0 ||
  status === 503 ||
  ['UPLOAD_NOT_FOUND', 'UPLOAD_BUSY', 'OFFSET_MISMATCH', 'UPLOADS_FULL'].includes(reason ?? '');

/** Creates the upload, gets its offset if that is unknown, or sends the next chunk. Safe to repeat after any failure. */
async function step(
  file: Blob,
  hash: string,
  resumable: ResumableUpload,
  signal: AbortSignal,
): Promise<Result<Answer>> {
  if (!resumable.name) {
    const answer = await call<Started>('POST', 'uploads', {
      json: { sizeBytes: String(file.size), sha256: hash, mediaType: file.type || undefined },
      signal,
    });
    if (!answer.ok) return answer;
    const { asset, upload: started } = answer.value;
    if (started) resumable.begin(started);
    return done(asset ? { asset } : { receivedBytes: resumable.offset ?? 0 });
  }
  const { offset } = resumable;
  if (offset === undefined) {
    const known = await call<Upload>('GET', resumable.name, { signal });
    if (!known.ok) return known;
    resumable.offset = Number(known.value.receivedBytes);
    return done({ receivedBytes: resumable.offset });
  }
  // Read here, because fetch() does not tell a changed file from a lost connection.
  const chunk = await file
    .slice(offset, offset + kChunk)
    .arrayBuffer()
    .catch(() => undefined);
  if (!chunk) return unreadable;
  const sent = await call<Partial<Asset>>('PATCH', resumable.name, {
    bytes: new Blob([chunk]),
    headers: { 'Upload-Offset': String(offset), 'Content-Type': 'application/offset+octet-stream' },
    signal,
  });
  if (!sent.ok) return sent;
  // Only the response to the last chunk contains the asset.
  if (sent.value.name) return done({ asset: sent.value as Asset });
  resumable.offset = Math.min(offset + kChunk, file.size);
  return done({ receivedBytes: resumable.offset });
}

/** Remembers, across reloads, the upload that was started for these bytes. */
class ResumableUpload {
  name: string | undefined;
  /** Number of bytes that the daemon has; undefined if it has to be asked. */
  offset: number | undefined;
  private readonly key: string;

  constructor(hash: string) {
    this.key = `upload:${hash}`;
    this.name = localStorage.getItem(this.key) ?? undefined;
  }
  begin({ name, receivedBytes }: Upload): void {
    this.name = name;
    this.offset = Number(receivedBytes);
    localStorage.setItem(this.key, name);
  }
  forget(): void {
    this.name = undefined;
    localStorage.removeItem(this.key);
  }
}
