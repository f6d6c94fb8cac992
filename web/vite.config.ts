import { defineConfig } from 'vite';

// What the daemon serves; see deploy/build-web.
export default defineConfig({
  esbuild: { jsx: 'automatic', jsxImportSource: 'preact' },
  // Nothing is inlined as data:, which the daemon's Content-Security-Policy does not let through.
  build: { outDir: '../build/web', emptyOutDir: true, target: 'es2022', assetsInlineLimit: 0 },
  server: { proxy: { '/v1': process.env['HYDROPRINT_HTTP'] ?? 'http://127.0.0.1:8080' } },
});
