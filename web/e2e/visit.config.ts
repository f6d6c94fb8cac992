import { defineConfig } from 'vitest/config';

// Of a daemon that somebody else started: see tests/deploy/quickstart_test.
export default defineConfig({ test: { include: ['e2e/*.visit.ts'], testTimeout: 120_000 } });
