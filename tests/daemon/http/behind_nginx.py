"""Runs the daemon behind Debian's nginx, configured by the example in docs/operating.md with nginx's defaults, and does
what a page does: sign in, upload 20 MB in the page's pieces, submit a job, watch events.
Usage: behind_nginx.py FOLDER_OF_PROGRAMS REPOSITORY, whose build/web has been built."""
import contextlib
import hashlib
import http.client
import json
import pathlib
import re
import socket
import subprocess
import sys
import tempfile
import threading
import time

sys.path.append(str(pathlib.Path(__file__).resolve().parents[2]))
import programs  # noqa: E402

HOST = "prints.example.org"
PREFIX = "/hydroprint/"
EVENT_LIMIT_S = 1
MODEL = b"v 10 10 10 1 0 0\nv 10 -10 -10 0 1 0\nv -10 10 -10 0 0 1\nv -10 -10 10 1 1 0\nf 1 2 3\nf 1 3 4\nf 1 4 2\nf 2 4 3\n"


def require(holds, *what):
    if not holds:
        raise AssertionError(" ".join(str(part) for part in what))


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def example(repository):
    """The nginx example of the documentation."""
    text = (repository / "docs/operating.md").read_text(encoding="utf-8")
    found = re.search(r"```nginx\n(.*?)```", text, re.DOTALL)
    require(found, "docs/operating.md has no nginx example")
    return found[1]


def adapted(block, port, upstream, passes_host=True):
    """The example with the addresses of this test, and without TLS."""
    block, count = re.subn(r"listen 443 ssl;", f"listen 127.0.0.1:{port};", block)
    require(count == 1, "the example does not listen on 443 ssl")
    block = re.sub(r"\s*ssl_certificate\S* \S+;", "", block)
    block, count = re.subn(r"http://127\.0\.0\.1:8080/", f"http://{upstream}/", block)
    require(count == 1, "the example does not pass to 127.0.0.1:8080")
    return block if passes_host else re.sub(r"proxy_set_header Host .*", "", block)


@contextlib.contextmanager
def nginx(folder, block):
    """Runs nginx with one server block and everything else at its defaults."""
    places = "\n".join(f"{kind}_temp_path {folder}/{kind};" for kind in ("client_body", "proxy", "fastcgi", "uwsgi", "scgi"))
    (folder / "nginx.conf").write_text(
        f"daemon off; master_process off; pid {folder}/nginx.pid; error_log {folder}/error.log;\n"
        f"events {{}}\nhttp {{ access_log off; {places}\n{block}\n}}\n")
    child = subprocess.Popen(["/usr/sbin/nginx", "-p", str(folder), "-c", str(folder / "nginx.conf")],
                             stderr=subprocess.PIPE, text=True)
    try:
        yield child
    finally:
        child.terminate()
        child.wait()


class Page:
    """Sends the requests of a page that was opened at http://HOST:PORT/hydroprint/."""

    def __init__(self, port):
        self.port, self.headers = port, {"Host": f"{HOST}:{port}"}
        self.origin = {"Origin": f"http://{HOST}:{port}"}

    def connect(self):
        deadline = time.monotonic() + 60
        while True:
            connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=60)
            try:
                connection.connect()
                return connection
            except ConnectionRefusedError:  # nginx is still starting
                require(time.monotonic() < deadline, "nginx does not listen")
                time.sleep(0.02)

    def open(self, method, path, body=None, headers=()):
        connection = self.connect()
        own = self.headers | (self.origin if method not in ("GET", "HEAD") else {}) | dict(headers)
        connection.request(method, PREFIX + path, body, own)
        return connection.getresponse()

    def send(self, method, path, value=None, body=None, headers=()):
        if value is not None:
            body, headers = json.dumps(value), {"Content-Type": "application/json"} | dict(headers)
        response = self.open(method, path, body, headers)
        return response, response.read()

    def call(self, method, path, value=None, body=None, headers=()):
        response, answer = self.send(method, path, value, body, headers)
        require(response.status < 300, method, path, response.status, answer[:400])
        return json.loads(answer or b"{}")

    def sign_in(self, token):
        response, answer = self.send("POST", "v1/session:signIn", {"linkToken": token})
        require(response.status == 200, "sign-in:", response.status, answer[:400])
        self.headers["Cookie"] = response.headers["Set-Cookie"].split(";")[0]
        self.headers["X-Hydroprint-Csrf"] = json.loads(answer)["csrfToken"]

    def upload(self, content, piece):
        """Uploads in pieces and returns the name of the asset."""
        made = self.call("POST", "v1/uploads", {"sizeBytes": str(len(content)),
                                                "sha256": hashlib.sha256(content).hexdigest()})
        if "asset" in made:
            return made["asset"]["name"]
        for at in range(0, len(content), piece):
            done = self.call("PATCH", "v1/" + made["upload"]["name"], body=content[at:at + piece],
                             headers={"Upload-Offset": str(at), "Content-Type": "application/offset+octet-stream"})
        return done["name"]


def piece_of_page(repository):
    text = (repository / "web/src/api/uploads.ts").read_text(encoding="utf-8")
    number, shift = re.search(r"kChunk = (\d+) << (\d+)", text).groups()
    return int(number) << int(shift)


def check_page(page):
    """The page below the path, and each file that it names."""
    response, text = page.send("GET", "")
    require(response.status == 200 and b"<title>Hydroprint" in text, "page:", response.status)
    names = re.findall(r'(?:src|href)="([^"]+)"', text.decode())
    require(any(name.endswith(".js") for name in names), "the page names no script")
    for name in names:
        require(not name.startswith("/"), "not relative:", name)
        status = page.send("GET", name.removeprefix("./"))[0].status
        require(status == 200, name, status)


def check_events(page):
    """An event arrives soon after it happens."""
    response = page.open("GET", "v1/events:watch?topics=job")
    require(response.status == 200, "events:", response.status)
    arrived = []

    def read():
        while not arrived:
            line = response.readline()
            if not line or b"jobs/" in line:
                arrived.append(time.monotonic())

    reader = threading.Thread(target=read, daemon=True)
    reader.start()
    mesh = page.upload(MODEL, 512 << 10)
    began = time.monotonic()
    job = page.call("POST", "v1/jobs", {"simulate": {"mesh": {"name": "a.obj", "asset": mesh}}})
    reader.join(60)
    require(arrived, "no event arrived")
    print(f"the first event arrived {1000 * (arrived[0] - began):.0f} ms after the request of {job['name']}")
    require(arrived[0] - began < EVENT_LIMIT_S, "the first event was late")


def main():
    folder_of_programs, repository = map(pathlib.Path, sys.argv[1:3])
    with tempfile.TemporaryDirectory() as name:
        folder, port, strict = pathlib.Path(name), free_port(), free_port()
        (folder / "hydroprintd.toml").write_text(
            f'[server]\nhost_names = "{HOST}"\nweb_dir = "{repository.resolve()}/build/web"\n')
        daemon, found = programs.start(
            [folder_of_programs / "hydroprintd", "--grpc", "127.0.0.1:0", "--http", "127.0.0.1:0", "--config",
             folder / "hydroprintd.toml", "--state-dir", folder / "state", "--first-admin", "ann"],
            r"\bgrpc=(\S+:\d+) http=(\S+:\d+)")
        try:
            upstream, block = found[2], example(repository)
            with nginx(folder, adapted(block, port, upstream) + adapted(block, strict, upstream, passes_host=False)):
                page = Page(port)
                check_page(page)
                page.sign_in(re.search(r"/sign-in#(\w+)", "".join(daemon.said))[1])
                piece = piece_of_page(repository)
                content = bytes(20_000_000)
                name = page.upload(content, piece)
                require(name == "assets/" + hashlib.sha256(content).hexdigest(), name)
                check_events(page)
                wrong, answer = Page(strict).send("POST", "v1/jobs?validateOnly=true", {})
                require(wrong.status == 403, "Host replaced:", wrong.status, answer[:400])
                for word in (b"ORIGIN_FORBIDDEN", b"Host", b"proxy", b"server.host_names"):
                    require(word in answer, word, "is missing in", answer)
                other = Page(port)
                other.headers["Host"] = "elsewhere.example"
                unknown, answer = other.send("GET", "v1/jobs")
                require(unknown.status == 421 and b"server.host_names" in answer, unknown.status, answer[:400])
        finally:
            daemon.terminate()
            daemon.wait()


if __name__ == "__main__":
    main()
