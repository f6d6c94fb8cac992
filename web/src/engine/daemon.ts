/** The daemon as the page's engine. */
import { fetchBytes } from '../api/call';
import type { Preview } from '../api/types';
import { done, refused, type Result } from '../model/result';
import type { DipPreview, Engine, Model } from './engine';

const kLineFeed = 10;

/** Separates a preview's JSON from the bytes of its map, which begin at a multiple of 8 bytes. */
export function previewOf(bytes: ArrayBuffer): Result<DipPreview> {
  const end = new Uint8Array(bytes).indexOf(kLineFeed);
  try {
    const preview = JSON.parse(new TextDecoder().decode(bytes.slice(0, end))) as Preview;
    return done({ ...preview, map: new Float32Array(bytes, end + 1) });
  } catch {
    return refused('the preview cannot be read', 'Reload the page');
  }
}

/** Reads a model. The code for that is not part of the first screen. */
async function modelOf(bytes: ArrayBuffer): Promise<Result<Model>> {
  const code = await import('./model').catch(() => undefined);
  return code
    ? code.modelOf(bytes)
    : refused('the daemon does not answer', undefined, { status: 0 });
}

/** Sends a request whose response is bytes. */
async function ask<T>(
  method: string,
  json: unknown,
  signal: AbortSignal,
  read: (bytes: ArrayBuffer) => Result<T> | Promise<Result<T>>,
): Promise<Result<T>> {
  const answer = await fetchBytes(method, { method: 'POST', json, signal });
  return answer.ok ? read(answer.value) : answer;
}

export const daemon: Engine = {
  read: (inspect, signal) => ask('models:read', { inspect }, signal, modelOf),
  preview: (simulate, signal) => ask('previews:compute', { simulate }, signal, previewOf),
};
