// Lays a compressed copy beside each file of a folder that gains by it; the daemon sends the one that is asked for.
import { readdirSync, readFileSync, statSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { brotliCompressSync, constants, gzipSync } from 'node:zlib';

const kWorthwhile = /\.(html|js|css|json|svg|obj|mtl)$/;

for (const name of readdirSync(process.argv[2], { recursive: true })) {
  const path = join(process.argv[2], name);
  if (!kWorthwhile.test(path) || !statSync(path).isFile()) continue;
  const bytes = readFileSync(path);
  // Samples are large and seldom asked for: not at brotli's slowest.
  const quality = bytes.length > 1 << 20 ? 5 : 11;
  writeFileSync(`${path}.gz`, gzipSync(bytes, { level: 9 }));
  writeFileSync(
    `${path}.br`,
    brotliCompressSync(bytes, { params: { [constants.BROTLI_PARAM_QUALITY]: quality } }),
  );
}
