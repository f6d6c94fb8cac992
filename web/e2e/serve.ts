/** Runs a daemon and a virtual rig for manual tests until Ctrl-C, then deletes their state folder. */
import { Daemon } from './daemon';

const daemon = await Daemon.start();
console.log(`${daemon.address}   (logs in ${daemon.folder}; Ctrl-C to stop)`);
for (const signal of ['SIGINT', 'SIGTERM'] as const)
  process.once(signal, () => void daemon.stop().then(() => process.exit(0)));
