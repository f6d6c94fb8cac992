import { defineConfig } from 'vitest/config';

// Through a real browser, daemon and (virtual) rig: one after the other, and with patience on a busy machine.
export default defineConfig({
  test: {
    include: ['e2e/*.e2e.ts'],
    fileParallelism: false,
    testTimeout: 360_000,
    hookTimeout: 60_000,
    bail: 0,
  },
});
