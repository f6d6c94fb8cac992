// Writes compressed copies of the compressible files in a folder; the daemon sends the encoding that a client requests.
import { readdirSync, readFileSync, statSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { brotliCompressSync, constants, gzipSync } from 'node:zlib';

const kWorthwhile = /\.(html|js|css|json|svg|obj|mtl)$/;

for (const name of readdirSync(process.argv[2], { recursive: true })) {
  const path = join(process.argv[2], name);
  if (!kWorthwhile.test(path) || !statSync(path).isFile()) continue;
  const bytes = readFileSync(path);
  // Samples are large and rarely requested, so they do not use the slowest brotli quality.
  const quality = bytes.length > 1 << 20 ? 5 : 11;
  writeFileSync(`${path}.gz`, gzipSync(bytes, { level: 9 }));
  writeFileSync(
    `${path}.br`,
    brotliCompressSync(bytes, { params: { [constants.BROTLI_PARAM_QUALITY]: quality } }),
  );
}
