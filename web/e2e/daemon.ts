/** Starts the real programs as a user would: hydroprintd with a virtual rig, its own state folder and free ports. */
import { spawn, type ChildProcess } from 'node:child_process';
import { mkdtempSync, openSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { connect } from 'node:net';
import { tmpdir } from 'node:os';
import { join, resolve } from 'node:path';
import { createInterface } from 'node:readline';
import { fileURLToPath } from 'node:url';

export const root = resolve(fileURLToPath(new URL('.', import.meta.url)), '../..');
export const bin = join(root, 'build/release/bin');

/** A name under which the daemon answers, besides its address. */
export const kLanHost = 'rig.lan';

const kWater_mm = 240; // axis position at which the gripper is at the water level

/** Starts a program and waits for its ready line. `ready` holds its values by key, such as "http=127.0.0.1:8080". */
async function start(
  name: string,
  args: string[],
  log: string,
): Promise<{ process: ChildProcess; ready: Map<string, string> }> {
  const child = spawn(join(bin, name), args, { stdio: ['ignore', 'pipe', openSync(log, 'a')] });
  const lines = createInterface({ input: child.stdout! });
  const ready = await new Promise<string>((resolve, reject) => {
    lines.on('line', (line) => line.startsWith(`${name} ready`) && resolve(line));
    child.on('error', reject);
    child.on('exit', (status) => reject(new Error(`${name} ended with ${status}; see ${log}`)));
  });
  const words = ready.split(' ').slice(2);
  return {
    process: child,
    ready: new Map(words.map((word) => [word.split('=')[0]!, word.slice(word.indexOf('=') + 1)])),
  };
}

async function end(child: ChildProcess | undefined, signal: NodeJS.Signals): Promise<void> {
  if (!child || child.exitCode !== null || child.signalCode !== null) return;
  const ended = new Promise((resolve) => child.once('exit', resolve));
  child.kill(signal);
  await ended;
}

export class Daemon {
  readonly folder = mkdtempSync(join(tmpdir(), 'hydroprint-web-'));
  /** "http://127.0.0.1:41234" */
  address = '';
  private rig: ChildProcess | undefined;
  private daemon: ChildProcess | undefined;
  private rigAddress = '';
  private http = '127.0.0.1:0';

  static async start(): Promise<Daemon> {
    const made = new Daemon();
    await made.startRig();
    await made.startDaemon();
    return made;
  }

  /** Stops the daemon; `kill` stops it without cleanup. startDaemon() starts it at the same address. */
  async stopDaemon(how: 'ask' | 'kill' = 'ask'): Promise<void> {
    await end(this.daemon, how === 'kill' ? 'SIGKILL' : 'SIGTERM');
  }

  async startDaemon(): Promise<void> {
    const { process, ready } = await start(
      'hydroprintd',
      [
        ...['--config', join(this.folder, 'hydroprintd.toml')],
        ...['--state-dir', join(this.folder, 'state')],
        ...['--grpc', '127.0.0.1:0', '--http', this.http],
        ...['--rig', this.rigAddress],
        ...['--rig-profile', join(root, 'hardware/profiles/virtual.toml')],
      ],
      this.log,
    );
    this.daemon = process;
    this.http = ready.get('http')!.replace(/^https?:\/\//, '');
    this.address = `http://${this.http}`;
  }

  async stop(): Promise<void> {
    await end(this.daemon, 'SIGTERM');
    await end(this.rig, 'SIGTERM');
    rmSync(this.folder, { recursive: true, force: true });
  }

  /** Returns the last lines of the daemon's log. */
  logEnd(lines: number): string {
    return readFileSync(this.log, 'utf8').trimEnd().split('\n').slice(-lines).join('\n');
  }

  /** Sends a command to the virtual rig's control socket, such as "camera gone" or "clear". */
  async act(line: string): Promise<void> {
    const socket = connect(this.control);
    socket.end(`${line}\n`);
    const said = (await socket.toArray()).join('');
    if (!said.startsWith('ok')) throw new Error(`the rig answered "${said}" to "${line}"`);
  }

  private get log(): string {
    return join(this.folder, 'hydroprintd.log');
  }

  private get control(): string {
    return join(this.folder, 'control');
  }

  private async startRig(): Promise<void> {
    const scene = join(this.folder, 'scene.toml');
    writeFileSync(scene, `[water]\nat_mm = ${kWater_mm}\n[camera]\nseed = 1\n`);
    const { process, ready } = await start(
      'hydroprint-virtual-rig',
      [
        ...['--profile', join(root, 'hardware/profiles/virtual.toml')],
        ...['--scene', scene, '--control', this.control, '--tcp', '0'],
      ],
      join(this.folder, 'rig.log'),
    );
    this.rig = process;
    this.rigAddress = ready.get('tcp')!;
    writeFileSync(
      join(this.folder, 'hydroprintd.toml'),
      `[server]\nweb_dir = "${join(root, 'build/web')}"\nhost_names = "${kLanHost}"\n` +
        `[camera]\ndevice = "hydroprint:${this.control}"\npatience_s = 60\n` +
        `layout = "${join(root, 'deploy/rig_layout.toml.example')}"\ngripper_water_mm = ${kWater_mm}.0\n`,
    );
  }
}
