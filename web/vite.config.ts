import { defineConfig } from 'vite';

// Builds the files that the daemon serves; see deploy/build-web.
export default defineConfig({
  // URLs of files are relative, so that a reverse proxy can serve the page in any folder.
  base: './',
  esbuild: { jsx: 'automatic', jsxImportSource: 'preact' },
  // Nothing is inlined as a data: URL, because the daemon's Content-Security-Policy blocks these.
  build: { outDir: '../build/web', emptyOutDir: true, target: 'es2022', assetsInlineLimit: 0 },
  server: { proxy: { '/v1': process.env['HYDROPRINT_HTTP'] ?? 'http://127.0.0.1:8080' } },
});
