"""Calls every route in the OpenAPI document of a daemon, in the order of a usual day at a rig, and validates
each answer against the document. Then calls each route without authentication, and for resources that do not exist.
Usage: call_every_route.py FOLDER_OF_PROGRAMS RIG_PROFILE"""
import base64
import hashlib
import http.client
import json
import pathlib
import re
import sys
import time
import urllib.parse

TESTS = pathlib.Path(__file__).resolve().parents[2]
sys.path += [str(TESTS), str(TESTS / "daemon/rest")]
import check_openapi  # noqa: E402
import programs  # noqa: E402

PATIENCE_S = 120
PASSWORD = "a long enough one"
TETRAHEDRON = (b"v 10 10 10 1 0 0\nv 10 -10 -10 0 1 0\nv -10 10 -10 0 0 1\nv -10 -10 10 1 1 0\n"
               b"f 1 2 3\nf 1 3 4\nf 1 4 2\nf 2 4 3\n")


def require(holds, *what):
    if not holds:
        raise AssertionError(" ".join(str(part) for part in what))


class Answer:
    def __init__(self, response, body):
        self.status, self.headers, self.body = response.status, response.headers, body

    @property
    def json(self):
        return json.loads(self.body)


class Api:
    """Calls operations by name and validates the answers against the document."""

    def __init__(self, address):
        self.address, self.done = address, set()
        self.identity = {}  # header fields that identify the caller
        self.document = json.loads(self.send("GET", "/openapi.json").body)
        self.closed = check_openapi.closed(self.document)
        self.operations = {operation["operationId"]: (method.upper(), path, operation)
                           for path, method, operation in check_openapi.operations_of(self.closed)}

    def send(self, method, target, body=None, headers=(), until=None):
        """Sends a request and returns the answer. `until`: number of events to read from an endless answer."""
        connection = http.client.HTTPConnection(self.address, timeout=PATIENCE_S)
        connection.request(method, target, body, dict(headers) | self.identity)
        response = connection.getresponse()
        streams = response.headers.get_content_type() == "text/event-stream"
        body = self.events(response, until or 1) if streams else response.read()
        connection.close()
        return Answer(response, body)

    @staticmethod
    def events(response, count):
        """Returns the data of the first `count` events of a stream, or of fewer if the stream ends, as a JSON list."""
        found, kind = [], ""
        while len(found) < count and kind != "end":
            line = response.readline()
            require(line, "a stream ended unexpectedly")
            if line.startswith(b"event:"):
                kind = line[6:].decode().strip()
                require(kind != "error", "a stream ended with an error")
            elif line.startswith(b"data:") and kind != "end":
                found.append(json.loads(line[5:]))
        return json.dumps(found).encode()

    def ask(self, name, body=None, headers=(), query=None, until=None, **places):
        method, path, operation = self.operations[name]
        for place, value in places.items():
            path = path.replace("{" + place + "}", urllib.parse.quote(value, safe=""))
        if query:
            path += "?" + urllib.parse.urlencode(query)
        if body is None and "requestBody" in operation:
            body = {}
        data = body if isinstance(body, (bytes, type(None))) else json.dumps(body).encode()
        answer = self.send(method, path, data, headers, until)
        self.check(name, operation, answer)
        return answer

    def check(self, name, operation, answer):
        stated = operation["responses"].get(str(answer.status))
        if stated is None:
            require(400 <= answer.status < 500 or answer.status == 503, name, "answers", answer.status, answer.body)
            if operation is self.operations[name][2] and answer.body:
                troubles = check_openapi.check(answer.json, {"$ref": "#/components/schemas/Error"}, self.closed)
                require(not troubles, name, answer.body, troubles)
            return
        content = stated.get("content", {})
        for kind, values in (("application/json", lambda: [answer.json]), ("text/event-stream", lambda: answer.json)):
            for value in values() if kind in content and answer.body else []:
                troubles = check_openapi.check(value, content[kind]["schema"], self.closed)
                require(not troubles, name, value, troubles)

    def call(self, name, *args, **more):
        """Same as ask(), but the call must succeed."""
        answer = self.ask(name, *args, **more)
        require(answer.status < 400, name, answer.status, answer.body)
        self.done.add(name)
        return answer


def last(name):
    return name.rsplit("/", 1)[1]


def upload(api, data):
    digest = hashlib.sha256(data).hexdigest()
    begun = api.call("StartUpload", {"sizeBytes": str(len(data)), "sha256": digest}).json
    number, half = last(begun["upload"]["name"]), len(data) // 2
    part = api.call("PatchUpload", data[:half], {"Upload-Offset": "0"}, upload=number)
    require(part.status == 204, "half an upload is", part.status)
    require(api.call("HeadUpload", upload=number).headers["Upload-Offset"] == str(half), "HEAD returns another offset")
    require(api.call("GetUpload", upload=number).json["receivedBytes"] == str(half), "GET returns another offset")
    asset = api.call("PatchUpload", data[half:], {"Upload-Offset": str(half)}, upload=number).json
    require(asset["sha256"] == digest, asset)
    return asset["name"]


def files(api):
    asset = upload(api, TETRAHEDRON)
    api.call("GetAsset", asset=last(asset))
    require(any(found["name"] == asset for found in api.call("ListAssets").json["assets"]), "an asset is not listed")
    api.call("DeleteAsset", asset=last(upload(api, b"of no use")))
    return asset


def create(api, spec, query=None):
    return last(api.call("CreateJob", spec, query=query).json["name"])


def plan(api, asset):
    pose = {"rotationWxyz": [1, 0, 0, 0], "translationMm": [0, 0, 0]}
    number = create(api, {"plan": {"object": {"mesh": {"name": "tetrahedron.obj", "asset": asset}}, "dpi": 72,
                                   "film": {"film": "circle:30"}, "immersions": [{"pose": pose, "depthMm": 3}]}})
    api.call("WatchJob", job=number, until=10**6)
    progress = api.call("GetPlanProgress", job=number).json
    require(progress["nextImmersion"] == 1 and len(progress["dips"]) == 1, progress)


def jobs(api, asset):
    """Calls the operations on jobs. Returns the number of a successful simulation."""
    mesh = {"mesh": {"name": "tetrahedron.obj", "asset": asset}, "film": "circle:30", "depthMm": 3, "dpi": 72}
    api.call("PauseQueue", {"reason": "put in order"})
    first, second = (create(api, {"simulate": mesh, "displayName": name}) for name in ("first", "second"))
    require(api.call("GetQueue").json["paused"], "the queue is not paused")
    api.call("MoveJob", {"before": "jobs/" + first}, job=second)
    api.call("CancelJob", job=second)
    api.call("ResumeQueue")
    seen = api.call("WatchJob", job=first, until=10**6).json
    require(seen, "no events of a job arrived")
    require(api.call("GetJob", job=first).json["state"] == "SUCCEEDED", api.ask("GetJob", job=first).body)
    require(len(api.call("ListJobs").json["jobs"]) == 2, "expected two jobs")
    api.call("ListJobEvents", job=first)
    require("simulate" in api.call("GetJobReport", job=first).json, "a report is not that of its kind")
    api.call("ShareJob", {"shared": True}, job=first)
    require("purgeTime" not in api.call("PinJob", {"pinned": True}, job=first).json, "a pinned job has a purge time")
    require(int(api.call("GetUsage").json["pinnedBytes"]) > 0, "pinned bytes are not counted")
    api.call("WatchEvents", query={"afterSeq": 0, "topics": "job"}, until=3)
    artifacts(api, first)
    again = last(api.call("RetryJob", job=second).json["name"])
    api.call("WatchJob", job=again, until=10**6)
    api.call("DeleteJob", job=second)
    plan(api, asset)
    line, _, bytes_after = api.call("ComputePreview", {"simulate": mesh}).body.partition(b"\n")
    require(len(line) % 8 == 7 and len(bytes_after) == 4 * 16, len(line), len(bytes_after))
    require(json.loads(line)["coverage"] > 0, line)
    read = api.call("ReadModel", {"inspect": {"mesh": mesh["mesh"]}})
    require(read.headers["Content-Type"] == "model/gltf-binary", read.headers["Content-Type"])
    require(read.body[:4] == b"glTF" and len(read.body) == int.from_bytes(read.body[8:12], "little"), read.body[:40])
    return first


def artifacts(api, job):
    names = [found["name"].split("/", 3)[3] for found in api.call("ListArtifacts", job=job).json["artifacts"]]
    require("film.png" in names, names)
    stated = api.call("GetArtifact", job=job, artifact="film.png").json
    whole = api.call("DownloadArtifact", job=job, artifact="film.png")
    require(hashlib.sha256(whole.body).hexdigest() == stated["sha256"], "the bytes do not match the hash")
    part = api.call("DownloadArtifact", headers={"Range": "bytes=1-3"}, job=job, artifact="film.png")
    require(part.status == 206 and part.body == b"PNG", part.status, part.body)
    same = api.call("DownloadArtifact", headers={"If-None-Match": whole.headers["ETag"]}, job=job, artifact="film.png")
    require(same.status == 304 and not same.body, same.status)
    head = api.call("HeadArtifact", job=job, artifact="film.png")
    require(head.headers["Content-Length"] == str(len(whole.body)), head.headers)


def calibrations(api, asset):
    by_hand = {"mesh": {"name": "tetrahedron.obj", "asset": asset},
               "pose": {"rotationWxyz": [1, 0, 0, 0], "translationMm": [0, 0, 0]}}
    number = last(api.call("CreateCalibration", by_hand).json["name"])
    api.call("GetCalibration", calibration=number)
    api.call("ListCalibrations")
    api.call("ActivateCalibration", calibration=number)
    api.call("DeleteCalibration", calibration=number)


def wait_for(what, is_so):
    end = time.monotonic() + PATIENCE_S
    while not is_so():
        require(time.monotonic() < end, "waited in vain for", what)
        time.sleep(0.05)


def rig(api, simulation):
    now = lambda: api.call("GetRig").json  # noqa: E731
    is_over = lambda: now()["motion"]["outcome"] != "RUNNING" and now()["state"] == "IDLE"  # noqa: E731
    wait_for("the drive", lambda: now()["state"] != "OFFLINE")
    lease = {"leaseId": api.call("AcquireLease", {"purpose": "every route"}).json["leaseId"]}
    api.call("GetLease")
    api.call("RenewLease", lease)
    api.call("StopMotion")
    api.call("ResetFault", lease)
    api.call("Arm", lease)
    api.call("Home", lease)
    wait_for("the home position", is_over)
    api.call("Jog", lease | {"speedMmPerS": 1})
    api.call("StopMotion")
    wait_for("standstill", is_over)
    api.call("MoveTo", lease | {"positionMm": 20, "speedMmPerS": 10})
    api.call("WatchRig", until=2)
    wait_for("the way's end", is_over)
    dip = create(api, {"dip": {"simulateJob": "jobs/" + simulation}}, lease)
    job = lambda: api.call("GetJob", job=dip).json  # noqa: E731
    wait_for("the dip's first question", lambda: job()["state"] == "WAITING_FOR_OPERATOR")
    api.call("ConfirmStep", lease | {"step": job()["dipStatus"]["step"]}, job=dip)
    api.call("CancelJob", job=dip)
    wait_for("the dip's end", lambda: job()["state"] == "CANCELLED")
    api.call("Disarm", lease)
    api.call("ReleaseLease", lease)
    api.call("AcquireLease", {"purpose": "forgotten"})
    api.call("BreakLease", {"reason": "gone home"})


def sign_in(api, body):
    """Signs in as a page does: with a cookie that its scripts cannot read."""
    api.identity = {}
    answer = api.call("SignIn", body)
    cookie = answer.headers["Set-Cookie"]
    require("HttpOnly" in cookie and "SameSite=Strict" in cookie, cookie)
    require(answer.json.get("sessionToken", "") == "", "the session token must only be in the cookie")
    api.identity = {"Cookie": cookie.split(";")[0], "X-Hydroprint-Csrf": answer.json["csrfToken"]}


def people(api):
    """Creates the first admin, who makes all further calls."""
    api.call("CreateUser", {"user": {"name": "users/ann", "role": "ADMIN"}, "password": PASSWORD})
    sign_in(api, {"user": "ann", "password": PASSWORD})
    require(api.call("WhoAmI").json["role"] == "ADMIN", "the first user is not an admin")
    admin = {"Authorization": "Bearer " + api.call("CreateApiKey", {"displayName": "scripts"}).json["key"]}
    api.identity = admin
    api.call("CreateUser", {"user": {"name": "users/bob", "role": "VIEWER"}, "password": PASSWORD})
    api.call("UpdateUser", {"role": "MAKER"}, user="bob")
    api.call("SetPassword", {"newPassword": PASSWORD + " too"}, user="bob")
    sign_in(api, {"linkToken": api.call("CreateSignInLink", user="bob").json["token"]})
    made = api.call("CreateApiKey", {"displayName": "to be deleted"}).json["apiKey"]["name"]
    require(len(api.call("ListApiKeys").json["apiKeys"]) == 1, "expected one key")
    api.call("DeleteApiKey", apiKey=last(made))
    api.call("SignOut")
    api.identity = admin
    require(len(api.call("ListUsers").json["users"]) == 2, "expected two users")
    for session in api.call("ListSessions").json["sessions"]:
        api.call("RevokeSession", session=last(session["name"]))
    require(api.call("ListAudit").json["entries"], "the audit log is empty")
    api.call("DeleteUser", user="bob")


def camera(api):
    picture = lambda: api.ask("GetDepthPicture")  # noqa: E731
    wait_for("a picture", lambda: picture().status == 200)
    png = base64.b64decode(api.call("GetDepthPicture").json["png"])
    require(png.startswith(b"\x89PNG"), png[:20])


def the_rest(api):
    for name in ("GetHealth", "GetMetrics", "GetOpenApi"):
        api.call(name)


def ask_for_nothing(api, name):
    """Calls an operation for a resource that does not exist."""
    return api.ask(name, headers={"Upload-Offset": "0"}, **places_of(api, name))


def places_of(api, name):
    return {place: "999999" for place in re.findall(r"{([^}]*)}", api.operations[name][1])}


def wrong_calls(api):
    """Calls every operation for resources that do not exist, and without authentication."""
    for name in api.operations:
        if places_of(api, name):
            answer = ask_for_nothing(api, name)
            require(400 <= answer.status < 500, name, "for a missing resource:", answer.status, answer.body)
    api.identity = {}
    for name in api.operations.keys() - check_openapi.OPEN:
        answer = ask_for_nothing(api, name)
        require(answer.status == 401, name, "without authentication:", answer.status, answer.body)


def main():
    with programs.daemon_with_rig(*sys.argv[1:3]) as daemon:
        api = Api(daemon.http)
        asset = files(api)
        calibrations(api, asset)
        rig(api, jobs(api, asset))
        camera(api)
        people(api)
        the_rest(api)
        wrong_calls(api)
    missed = api.operations.keys() - api.done
    require(not missed, "never called:", sorted(missed))
    print(f"{len(api.done)} routes were called")


main()
