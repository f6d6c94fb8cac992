/** SHA-256 of files. */

// A slice takes a few hundredths of a second, even on a phone. The page handles its events between slices.
const kSlice = 1 << 20;

const hexOf = (digest: Uint8Array): string =>
  [...digest].map((byte) => byte.toString(16).padStart(2, '0')).join('');

/**
 * Returns the SHA-256 in lower-case hexadecimal. Fails if the file cannot be read, or if the signal aborts.
 *
 * Browsers offer `crypto.subtle` only over TLS and on this machine. On other pages, a library computes the hash in slices;
 * its code is loaded only then.
 */
export async function sha256(file: Blob, signal?: AbortSignal): Promise<string> {
  // The type of `crypto` does not know that browsers may lack `subtle`.
  const subtle = crypto.subtle as SubtleCrypto | undefined;
  if (subtle)
    return hexOf(new Uint8Array(await subtle.digest('SHA-256', await file.arrayBuffer())));
  const { sha256: algorithm } = await import('@noble/hashes/sha2.js');
  const hash = algorithm.create();
  for (let begin = 0; begin < file.size; begin += kSlice) {
    signal?.throwIfAborted();
    hash.update(new Uint8Array(await file.slice(begin, begin + kSlice).arrayBuffer()));
  }
  return hexOf(hash.digest());
}
