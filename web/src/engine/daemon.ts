/** The daemon as the page's engine. */
import { fetchBytes } from '../api/call';
import type { Preview } from '../api/types';
import { done, refused, type Result } from '../model/result';
import type { DipPreview, Engine } from './engine';

const kLineFeed = 10;

/** Separates a preview's JSON from the bytes of its map, which begin at a multiple of 8 bytes. */
export function previewOf(bytes: ArrayBuffer): Result<DipPreview> {
  const end = new Uint8Array(bytes).indexOf(kLineFeed);
  try {
    const preview = JSON.parse(new TextDecoder().decode(bytes.slice(0, end))) as Preview;
    return done({ ...preview, map: new Float32Array(bytes, end + 1) });
  } catch {
    return refused('the preview cannot be read', 'Reload the page', { status: 0 });
  }
}

export const daemon: Engine = {
  read: (model, signal) =>
    fetchBytes('models:read', { method: 'POST', json: { inspect: model }, signal }),
  preview: async (dip, signal) => {
    const answer = await fetchBytes('previews:compute', {
      method: 'POST',
      json: { simulate: dip },
      signal,
    });
    return answer.ok ? previewOf(answer.value) : answer;
  },
};
