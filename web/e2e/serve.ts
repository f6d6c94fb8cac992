/** Daemon and virtual rig to try the page by hand, until Ctrl-C; the store is gone with them. */
import { Daemon } from './daemon';

const daemon = await Daemon.start();
console.log(`${daemon.address}   (logs in ${daemon.folder}; Ctrl-C ends it)`);
for (const signal of ['SIGINT', 'SIGTERM'] as const)
  process.once(signal, () => void daemon.stop().then(() => process.exit(0)));
