/** Resumable uploads: they continue after a lost connection and after a reload of the page. */
import { done, refused, type Result } from '../model/result';
import { call } from './call';
import type { Asset, Upload } from './types';

const kChunk = 4 << 20;
const kWaits_s = [0.5, 1, 2, 4, 8, 15];

type Answer = { asset?: Asset; upload?: Upload };

/** Returns the SHA-256 in lower-case hexadecimal. */
export async function sha256(bytes: ArrayBuffer): Promise<string> {
  const digest = new Uint8Array(await crypto.subtle.digest('SHA-256', bytes));
  return [...digest].map((byte) => byte.toString(16).padStart(2, '0')).join('');
}

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
  const bytes = await file.arrayBuffer().catch(() => undefined);
  if (!bytes)
    return refused(
      'the file cannot be read; it may have been moved or changed',
      'Choose the file again',
    );
  const hash = await sha256(bytes);
  const resumable = new ResumableUpload(hash);
  let share = 0;
  for (let lost = 0; ; ) {
    const answer = await step(file, hash, resumable, signal);
    if (answer.ok) {
      if (answer.value.asset) {
        resumable.forget();
        return done(answer.value.asset.name);
      }
      lost = 0;
      const got = Number(answer.value.upload?.receivedBytes ?? 0);
      share = file.size > 0 ? got / file.size : 1;
      onProgress(share, false);
      continue;
    }
    const { failure } = answer;
    if (signal.aborted || !passes(failure.status, failure.reason)) return answer;
    // If the daemon has discarded the upload, start again; otherwise continue from its offset.
    if (failure.reason === 'UPLOAD_NOT_FOUND') resumable.forget();
    onProgress(share, failure.status === 0);
    await wait(kWaits_s[Math.min(lost, kWaits_s.length - 1)]!);
    lost += 1;
  }
}

const passes = (status: number | undefined, reason: string | undefined): boolean =>
  status === 0 ||
  status === 503 ||
  ['UPLOAD_NOT_FOUND', 'UPLOAD_BUSY', 'OFFSET_MISMATCH', 'UPLOADS_FULL'].includes(reason ?? '');

/** Creates the upload, or gets its offset and sends the next chunk. Safe to repeat after any failure. */
async function step(
  file: Blob,
  hash: string,
  resumable: ResumableUpload,
  signal: AbortSignal,
): Promise<Result<Answer>> {
  if (!resumable.name) {
    const answer = await call<Answer>('POST', 'uploads', {
      json: { sizeBytes: String(file.size), sha256: hash, mediaType: file.type || undefined },
      signal,
    });
    if (answer.ok && answer.value.upload) resumable.remember(answer.value.upload.name);
    return answer;
  }
  const known = await call<Upload>('GET', resumable.name, { signal });
  if (!known.ok) return known;
  const offset = Number(known.value.receivedBytes);
  const sent = await call<Partial<Asset>>('PATCH', resumable.name, {
    bytes: file.slice(offset, offset + kChunk),
    headers: { 'Upload-Offset': String(offset), 'Content-Type': 'application/offset+octet-stream' },
    signal,
  });
  if (!sent.ok) return sent;
  // Only the response to the last chunk contains the asset.
  if (sent.value.name) return done({ asset: sent.value as Asset });
  const receivedBytes = String(Math.min(offset + kChunk, file.size));
  return done({ upload: { ...known.value, receivedBytes } });
}

/** Remembers, across reloads, the upload that was started for these bytes. */
class ResumableUpload {
  name: string | undefined;
  private readonly key: string;

  constructor(hash: string) {
    this.key = `upload:${hash}`;
    this.name = localStorage.getItem(this.key) ?? undefined;
  }
  remember(name: string): void {
    this.name = name;
    localStorage.setItem(this.key, name);
  }
  forget(): void {
    this.name = undefined;
    localStorage.removeItem(this.key);
  }
}
