"""Does what a page does, through a reverse proxy: sign in, upload 20 MB, submit a job, watch events.
Usage: behind_proxy.py FOLDER_OF_PROGRAMS          with a small proxy that has nginx's defaults
       behind_proxy.py FOLDER_OF_PROGRAMS --nginx  with nginx and the configuration in docs/operating.md"""
import contextlib
import hashlib
import http.client
import json
import os
import pathlib
import re
import socket
import ssl
import subprocess
import sys
import tempfile
import textwrap
import time

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path += [str(ROOT / "tests"), str(ROOT / "tests/daemon/http")]
sys.dont_write_bytecode = True  # set before the imports below
import programs  # noqa: E402
import small_proxy  # noqa: E402

HOST = "print.example.org"
FOLDER = "/hydroprint/"
PASSWORD = "a long enough one"
TETRAHEDRON = b"".join([b"v 10 10 10 1 0 0\nv 10 -10 -10 0 1 0\nv -10 10 -10 0 0 1\nv -10 -10 10 1 1 0\n",
                        b"f 1 2 3\nf 1 3 4\nf 1 4 2\nf 2 4 3\n"])
PATIENCE_S = 60
FIRST_EVENT_S = 1


def require(holds, *what):
    if not holds:
        raise AssertionError(" ".join(str(part) for part in what))


def page_chunk():
    """Returns the number of bytes that the page uploads at a time."""
    text = (ROOT / "web/src/api/uploads.ts").read_text(encoding="utf-8")
    number, shift = re.search(r"kChunk = (\d+) << (\d+)", text).groups()
    return int(number) << int(shift)


class Page:
    """Sends the requests of a page, with its session, its CSRF token and its Origin.
    `connect` returns a new http.client.HTTPConnection to the proxy."""

    def __init__(self, connect, origin, host=HOST):
        self.connect, self.fields = connect, {"Host": host, "Origin": origin}

    def open(self, method, path, data=None, fields=()):
        connection = self.connect()
        connection.request(method, FOLDER + path, data, self.fields | dict(fields))
        return connection.getresponse()

    def send(self, method, path, body=None, data=None, fields=()):
        """Returns the response and its content: the value of JSON, otherwise text."""
        if body is not None:
            data, fields = json.dumps(body), {"Content-Type": "application/json"} | dict(fields)
        response = self.open(method, path, data, fields)
        text = response.read().decode(errors="replace")
        is_json = response.headers.get_content_type() == "application/json"
        return response, json.loads(text) if is_json else text

    def call(self, *arguments, **more):
        """Same as send(), but the request must succeed. Returns the content."""
        response, content = self.send(*arguments, **more)
        require(response.status < 300, *arguments[:2], response.status, content)
        return content

    def sign_in(self):
        response, content = self.send("POST", "v1/session:signIn", {"user": "ann", "password": PASSWORD})
        require(response.status == 200, "sign-in:", response.status, content)
        cookie = response.headers["Set-Cookie"]
        self.fields |= {"Cookie": cookie.split(";")[0], "X-Hydroprint-Csrf": content["csrfToken"]}
        return cookie

    def upload(self, content, chunk):
        digest = hashlib.sha256(content).hexdigest()
        upload = self.call("POST", "v1/uploads", {"sizeBytes": str(len(content)), "sha256": digest})["upload"]["name"]
        for begin in range(0, len(content), chunk):
            fields = {"Upload-Offset": str(begin), "Content-Type": "application/offset+octet-stream"}
            asset = self.call("PATCH", "v1/" + upload, data=content[begin:begin + chunk], fields=fields)
        require(asset["sha256"] == digest and asset["sizeBytes"] == str(len(content)), "the upload is not whole:", asset)
        return asset["name"]


def check_page(page):
    """The page and its API, with an account."""
    response, text = page.send("GET", "")
    require(response.status == 200 and "<!doctype html>" in text, "the page:", response.status, text[:200])
    urls = re.findall(r'(?:src|href)="([^"]*)"', text)
    require(not any(url.startswith("/") for url in urls), "the page has absolute URLs:", urls)
    page.call("POST", "v1/users", {"user": {"name": "users/ann", "role": "ADMIN"}, "password": PASSWORD})
    require(page.send("GET", "v1/jobs")[0].status == 401, "no sign-in is required")
    cookie = page.sign_in()
    response, content = page.send("POST", "v1/queue:pause", {}, fields={"X-Hydroprint-Csrf": "wrong"})
    require(response.status == 403 and "CSRF" in json.dumps(content), "a wrong CSRF token:", response.status, content)
    return cookie


def check_upload(page):
    chunk = page_chunk()
    response, _ = page.send("PATCH", "v1/uploads/1", data=bytes(small_proxy.BODY_LIMIT + 1))
    require(response.status == 413, "the proxy does not limit bodies as nginx does:", response.status)
    begin = time.monotonic()
    page.upload(bytes(i * 7 % 251 for i in range(1_000_000)) * 20, chunk)
    print(f"20 MB in chunks of {chunk >> 10} KiB: {time.monotonic() - begin:.1f} s")


def next_event(stream):
    """Returns the data of the next event."""
    for line in iter(stream.readline, b""):
        if line.startswith(b"data:"):
            return json.loads(line[5:])
    raise AssertionError("the event stream ended")


def check_job_and_events(page):
    begin = time.monotonic()
    stream = page.open("GET", "v1/events:watch?topics=job")
    next_event(stream)
    elapsed_s = time.monotonic() - begin
    print(f"first event: {1000 * elapsed_s:.0f} ms")
    require(elapsed_s < FIRST_EVENT_S, "the first event came after", elapsed_s, "s")
    mesh = {"name": "a.obj", "asset": page.upload(TETRAHEDRON, page_chunk())}
    spec = {"mesh": mesh, "film": "circle:30", "depthMm": 3, "dpi": 72}
    job = page.call("POST", "v1/jobs", {"simulate": spec})["name"]
    # Each event of the job has to pass while the stream is open. A stream that is held back ends this by its timeout.
    while (state := next_event(stream)["job"]["event"].get("state")) != "SUCCEEDED":
        require(state not in ("FAILED", "CANCELLED"), job, state)
    response = page.open("GET", f"v1/{job}/artifacts/film.png:download")
    require(response.read(4) == b"\x89PNG", "film.png:", response.status)


def check_refusals(page, other):
    """`page` has an Origin that does not match its Host; `other` has an unknown Host."""
    for sender, method, status, reason in ((page, "POST", 403, "ORIGIN_FORBIDDEN"), (other, "GET", 421, "HOST_UNKNOWN")):
        response, content = sender.send(method, "v1/jobs")
        require(response.status == status and reason in json.dumps(content), reason, response.status, content)
        for words in ("reverse proxy", "proxy_set_header Host", "server.host_names"):
            require(words in content["error"]["message"], reason, "without", words, content)


def with_small_proxy(daemon):
    with small_proxy.SmallProxy(daemon, FOLDER, passes_host=True) as proxy, \
            small_proxy.SmallProxy(daemon, FOLDER, passes_host=False) as replacing:
        def connector(server):
            return lambda: http.client.HTTPConnection("127.0.0.1", server.server_port, timeout=PATIENCE_S)
        page = Page(connector(proxy), "http://" + HOST)
        check_page(page)
        check_upload(page)
        check_job_and_events(page)
        check_refusals(Page(connector(replacing), "http://" + HOST), Page(connector(proxy), "http://a.lan", "a.lan"))


class TlsOverSocket(http.client.HTTPConnection):
    """A connection with TLS over a Unix socket, so that nginx needs no port."""

    def __init__(self, path, certificate):
        super().__init__(HOST, timeout=PATIENCE_S)
        self.path, self.certificate = str(path), str(certificate)

    def connect(self):
        plain = socket.socket(socket.AF_UNIX)
        plain.settimeout(self.timeout)
        plain.connect(self.path)
        self.sock = ssl.create_default_context(cafile=self.certificate).wrap_socket(plain, server_hostname=HOST)


def documented_server():
    """Returns the nginx configuration in docs/operating.md."""
    text = (ROOT / "docs/operating.md").read_text(encoding="utf-8")
    section = text.split("## Behind a reverse proxy\n")[1].split("\n## ")[0]
    return textwrap.dedent(re.search(r"^    server \{\n(?:(?:    .*)?\n)+?    \}\n", section, re.M)[0])


def adapted(text, replacements):
    for old, new in replacements.items():
        require(text.count(old) == 1, f"docs/operating.md: expected '{old}' once in the configuration of nginx")
        text = text.replace(old, str(new))
    return text


@contextlib.contextmanager
def nginx(folder, servers):
    """Runs nginx with these server blocks, and everything else at its defaults."""
    temporary = "".join(f"{kind}_temp_path {folder}/{kind};\n"
                        for kind in ("client_body", "proxy", "fastcgi", "uwsgi", "scgi"))
    user = "user root;\n" if os.geteuid() == 0 else ""  # the folder belongs to this user
    (folder / "nginx.conf").write_text(f"{user}daemon off; pid {folder}/nginx.pid; error_log {folder}/error.log;\n"
                                       f"events {{}}\nhttp {{\naccess_log off;\n{temporary}{servers}}}\n")
    command = ["/usr/sbin/nginx", "-p", str(folder), "-c", str(folder / "nginx.conf"), "-e", str(folder / "error.log")]
    child = subprocess.Popen(command)
    try:
        end = time.monotonic() + PATIENCE_S
        while not (folder / "nginx.pid").exists():  # nginx writes it after it has opened its sockets
            require(child.poll() is None and time.monotonic() < end, "nginx did not start")
            time.sleep(0.02)
        yield
    finally:
        child.terminate()
        child.wait()


def with_nginx(daemon):
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        certificate, key = folder / "certificate.pem", folder / "key.pem"
        subprocess.run(["openssl", "req", "-x509", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:P-256", "-nodes",
                        "-subj", f"/CN={HOST}", "-addext", f"subjectAltName=DNS:{HOST}", "-days", "2",
                        "-out", certificate, "-keyout", key], check=True, capture_output=True)
        document = documented_server()
        common = {"/etc/ssl/certs/print.example.org.pem": certificate, "/etc/ssl/private/print.example.org.key": key,
                  "http://127.0.0.1:8080/": f"http://{daemon}/"}
        socket_of = {"right": folder / "right", "replacing": folder / "replacing"}
        right = adapted(document, common | {"listen 443 ssl": f"listen unix:{socket_of['right']} ssl"})
        replacing = adapted(document, common | {"listen 443 ssl": f"listen unix:{socket_of['replacing']} ssl",
                                                "proxy_set_header Host $http_host;": ""})
        with nginx(folder, right + replacing):
            def connector(which):
                return lambda: TlsOverSocket(socket_of[which], certificate)
            page = Page(connector("right"), "https://" + HOST)
            cookie = check_page(page)
            require("Secure" in cookie, "the cookie is sent without TLS too:", cookie)
            check_upload(page)
            check_job_and_events(page)
            check_refusals(Page(connector("replacing"), "https://" + HOST),
                           Page(connector("right"), "https://a.lan", "a.lan"))


def main():
    bin_folder = pathlib.Path(sys.argv[1])
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / "hydroprintd.toml").write_text(f'[server]\nhost_names = "{HOST}"\n')
        daemon, found = programs.start([bin_folder / "hydroprintd", "--grpc", "127.0.0.1:0", "--http", "127.0.0.1:0",
                                        "--config", folder / "hydroprintd.toml", "--state-dir", folder / "state"],
                                       r"\bhttp=(\S+:\d+)")
        try:
            (with_nginx if "--nginx" in sys.argv else with_small_proxy)(found[1])
        finally:
            daemon.terminate()
            daemon.wait()


main()
