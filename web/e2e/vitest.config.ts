import { defineConfig } from 'vitest/config';

// Uses a real browser, daemon and virtual rig. The tests run one after another, with long timeouts for busy machines.
export default defineConfig({
  test: {
    include: ['e2e/*.e2e.ts'],
    fileParallelism: false,
    testTimeout: 360_000,
    hookTimeout: 60_000,
    bail: 0,
  },
});
