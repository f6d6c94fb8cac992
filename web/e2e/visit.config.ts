import { defineConfig } from 'vitest/config';

// Tests against a daemon that is already running; see tests/deploy/quickstart_test.
export default defineConfig({ test: { include: ['e2e/*.visit.ts'], testTimeout: 120_000 } });
