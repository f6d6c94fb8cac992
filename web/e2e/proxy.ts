/**
 * A reverse proxy as nginx is by default: it refuses bodies above 1 MiB, and collects a response before it passes it on
 * unless the response says `X-Accel-Buffering: no`. It serves the daemon in a folder and passes on Host.
 */
import { createServer, request, type IncomingMessage, type ServerResponse } from 'node:http';
import type { AddressInfo } from 'node:net';

const kBodyLimit = 1 << 20;

export interface Proxy {
  port: number;
  /** Number of requests that were refused because of their size. */
  refused: number;
  stop(): void;
}

/**
 * @param daemon  "http://127.0.0.1:41234"
 * @param folder  "/hydroprint/"
 */
export async function startProxy(daemon: string, folder: string): Promise<Proxy> {
  const proxy: Proxy = { port: 0, refused: 0, stop: () => {} };
  const server = createServer((incoming, response) => {
    if (Number(incoming.headers['content-length'] ?? 0) > kBodyLimit) {
      proxy.refused += 1;
      incoming.resume();
      response.writeHead(413, { 'Content-Type': 'text/html' }).end('<h1>413</h1>');
    } else if (incoming.url?.startsWith(folder)) {
      passOn(daemon, `/${incoming.url.slice(folder.length)}`, incoming, response);
    } else {
      response.writeHead(404).end();
    }
  });
  await new Promise<void>((done) => server.listen(0, '127.0.0.1', done));
  proxy.port = (server.address() as AddressInfo).port;
  proxy.stop = () => {
    server.closeAllConnections();
    server.close();
  };
  return proxy;
}

function passOn(daemon: string, path: string, from: IncomingMessage, to: ServerResponse): void {
  const { method, headers } = from;
  const outgoing = request(new URL(path, daemon), { method, headers }, (answer) => {
    const begin = () => to.writeHead(answer.statusCode!, answer.headers);
    if (answer.headers['x-accel-buffering'] === 'no') {
      begin();
      answer.pipe(to);
    } else {
      void answer.toArray().then(
        (pieces) => begin().end(Buffer.concat(pieces)),
        () => to.destroy(),
      );
    }
  });
  outgoing.on('error', () => to.destroy());
  to.on('close', () => outgoing.destroy());
  from.pipe(outgoing);
}
