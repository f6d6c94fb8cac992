#!/usr/bin/env python3
"""Submits a simulation to hydroprintd and fetches its film image.

The build generates the stubs (target hydroprint_python):

    PYTHONPATH=build/release/python client/python/submit_and_fetch.py \
        --mesh globe.obj --texture globe.png --out result

HYDROPRINT_SERVER is the daemon's address ("https://host:port" for TLS). HYDROPRINT_CA is a file with the certificate
of a private authority. HYDROPRINT_API_KEY is a key from `hydroprint keys add`; without it, the key that
`hydroprint login` stored is used.
"""

import argparse
import hashlib
import os
import sys
import uuid

import grpc

from channel import explain, open_channel

try:
    from hydroprint.v1 import artifact_service_pb2, artifact_service_pb2_grpc
    from hydroprint.v1 import asset_service_pb2, asset_service_pb2_grpc
    from hydroprint.v1 import job_pb2, job_service_pb2, job_service_pb2_grpc, spec_pb2
except ImportError as error:
    sys.exit(f"{error}; build the target hydroprint_python and set PYTHONPATH to build/release/python")

CHUNK_BYTES = 64 * 1024


def upload(channel, path):
    """Uploads a file unless the daemon already has its bytes; returns it as a job input."""
    assets = asset_service_pb2_grpc.AssetServiceStub(channel)
    with open(path, "rb") as file:
        content = file.read()
    answer = assets.StartUpload(
        asset_service_pb2.StartUploadRequest(
            size_bytes=len(content),
            sha256=hashlib.sha256(content).hexdigest(),
            request_id=str(uuid.uuid4()),
        )
    )
    if answer.HasField("upload"):
        answer = assets.UploadChunk(chunks(answer.upload, content))
    return spec_pb2.InputFile(name=os.path.basename(path), asset=answer.asset.name)


def chunks(upload_, content):
    """Yields the messages that send the missing part of `content`."""
    for offset in range(upload_.received_bytes, max(len(content), 1), CHUNK_BYTES):
        yield asset_service_pb2.UploadChunkRequest(
            upload=upload_.name, offset=offset, data=content[offset : offset + CHUNK_BYTES]
        )


def submit(channel, spec):
    """Queues a job; returns its name."""
    jobs = job_service_pb2_grpc.JobServiceStub(channel)
    request = job_service_pb2.CreateJobRequest(
        job=job_pb2.Job(simulate=spec), request_id=str(uuid.uuid4())
    )
    return jobs.CreateJob(request).name


def wait(channel, name):
    """Prints a job's progress until it is finished; returns the job."""
    jobs = job_service_pb2_grpc.JobServiceStub(channel)
    for message in jobs.WatchJob(job_service_pb2.WatchJobRequest(name=name)):
        if message.HasField("event"):
            event = message.event
            print(f"{name}: {event.progress_fraction:4.0%}  {event.phase}")
    return jobs.GetJob(job_service_pb2.GetJobRequest(name=name))


def fetch(channel, name, folder):
    """Downloads one artifact into `folder` and checks it; returns its path."""
    artifacts = artifact_service_pb2_grpc.ArtifactServiceStub(channel)
    artifact = artifacts.GetArtifact(artifact_service_pb2.GetArtifactRequest(name=name))
    pieces = artifacts.DownloadArtifact(artifact_service_pb2.DownloadArtifactRequest(name=name))
    content = b"".join(piece.data for piece in pieces)
    if hashlib.sha256(content).hexdigest() != artifact.sha256:
        sys.exit(f"{name}: SHA-256 does not match the bytes received; run this again")
    os.makedirs(folder, exist_ok=True)
    path = os.path.join(folder, name.rsplit("/", 1)[1])
    with open(path + ".part", "wb") as file:
        file.write(content)
    os.replace(path + ".part", path)
    return path


def main():
    """Runs the example."""
    parser = argparse.ArgumentParser(description="Submit a simulation and fetch its film image.")
    parser.add_argument("--server", default=os.environ.get("HYDROPRINT_SERVER", "127.0.0.1:50051"))
    parser.add_argument("--mesh", required=True, help="OBJ, STL, PLY, glTF or GLB that refers to no other files")
    parser.add_argument("--texture", help="texture of the mesh: PNG, JPEG or TIFF")
    parser.add_argument("--project", help="projection of the texture, such as box, instead of texture coordinates")
    parser.add_argument("--dpi", type=float, help="resolution of the film image")
    parser.add_argument("--out", default=".", help="folder for film.png")
    arguments = parser.parse_args()

    with open_channel(arguments.server) as channel:
        spec = spec_pb2.SimulateSpec(mesh=upload(channel, arguments.mesh), dpi=arguments.dpi, project=arguments.project)
        if arguments.texture:
            spec.texture.CopyFrom(upload(channel, arguments.texture))
        job = wait(channel, submit(channel, spec))
        if job.state != job_pb2.Job.SUCCEEDED:
            sys.exit(f"{job.name}: {job_pb2.Job.State.Name(job.state)} {job.error.message}")
        print(fetch(channel, f"{job.name}/artifacts/film.png", arguments.out))


if __name__ == "__main__":
    try:
        main()
    except OSError as error:
        sys.exit(str(error))
    except grpc.RpcError as error:
        sys.exit(explain(error))
