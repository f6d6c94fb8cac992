"""A small reverse proxy as nginx is by default: it speaks HTTP/1.0 to the daemon, refuses bodies above 1 MiB, and collects
responses unless they say X-Accel-Buffering: no."""
import http.client
import http.server
import threading

BODY_LIMIT = 1 << 20
BUFFER = 4096
HOP_BY_HOP = {"connection", "keep-alive", "te", "transfer-encoding", "upgrade"}


class Upstream(http.client.HTTPConnection):
    _http_vsn, _http_vsn_str = 10, "HTTP/1.0"


class Handler(http.server.BaseHTTPRequestHandler):
    def relay(self):
        size = int(self.headers.get("Content-Length", 0))
        if size > BODY_LIMIT or not self.path.startswith(self.server.folder):
            self.rfile.read(size)  # otherwise the client might meet a closed connection instead of the answer
            self.close_connection = True
            self.send_error(413 if size > BODY_LIMIT else 404)
            return
        upstream = Upstream(self.server.daemon, timeout=60)
        upstream.putrequest(self.command, "/" + self.path[len(self.server.folder):], skip_host=True,
                            skip_accept_encoding=True)
        for name, value in self.headers.items():
            if name.lower() not in HOP_BY_HOP | {"host"}:
                upstream.putheader(name, value)
        upstream.putheader("Host", self.headers["Host"] if self.server.passes_host else self.server.daemon)
        upstream.endheaders(self.rfile.read(size))
        response = upstream.getresponse()
        self.pass_back(response)
        upstream.close()

    def pass_back(self, response):
        is_buffered = response.headers.get("X-Accel-Buffering") != "no"
        self.send_response(response.status)
        for name, value in response.headers.items():
            if name.lower() not in HOP_BY_HOP | {"x-accel-buffering"}:
                self.send_header(name, value)
        self.end_headers()
        collected = b""
        while piece := response.read1(BUFFER):
            collected += piece
            if len(collected) >= BUFFER or not is_buffered:
                self.wfile.write(collected)
                collected = b""
        self.wfile.write(collected)

    do_GET = do_HEAD = do_POST = do_PATCH = do_DELETE = relay

    def log_message(self, *_):
        pass


class SmallProxy(http.server.ThreadingHTTPServer):
    """Serves the daemon in a folder ("/hydroprint/") on a free port. Use it in a with statement."""
    daemon_threads = True

    def __init__(self, daemon, folder, passes_host):
        super().__init__(("127.0.0.1", 0), Handler)
        self.daemon, self.folder, self.passes_host = daemon, folder, passes_host
        threading.Thread(target=self.serve_forever, daemon=True).start()

    def handle_error(self, *_):
        pass  # the client has closed the connection

    def __exit__(self, *exception):
        self.shutdown()
        super().__exit__(*exception)
