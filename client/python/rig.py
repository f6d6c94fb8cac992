#!/usr/bin/env python3
"""Prints the state of the rig; with --stop, stops it first (which needs no lease).

The build generates the stubs (target hydroprint_python):

    PYTHONPATH=build/release/python client/python/rig.py --stop

HYDROPRINT_SERVER is the daemon's address ("https://host:port" for TLS). HYDROPRINT_CA is a file with the certificate
of a private authority. HYDROPRINT_API_KEY is a key from `hydroprint keys add`; without it, the key that
`hydroprint login` stored is used.
"""

import argparse
import os
import sys

import grpc

from channel import explain, open_channel

try:
    from hydroprint.v1 import rig_pb2, rig_service_pb2, rig_service_pb2_grpc
except ImportError as error:
    sys.exit(f"{error}; build the target hydroprint_python and set PYTHONPATH to build/release/python")


def describe(rig):
    """Returns one line: state, position, speed, lease holder, fault."""
    parts = [rig_pb2.Rig.State.Name(rig.state)]
    if rig.HasField("position_mm"):
        parts.append(f"{rig.position_mm:.2f} mm  {rig.velocity_mm_per_s:.2f} mm/s")
    if rig.HasField("lease"):
        parts.append(f"lease: {rig.lease.holder} ({rig.lease.purpose})")
    return "  ".join(parts + [rig.trouble] if rig.trouble else parts)


def main():
    """Runs the example."""
    parser = argparse.ArgumentParser(description="Print the state of the rig, or stop it.")
    parser.add_argument("--server", default=os.environ.get("HYDROPRINT_SERVER", "127.0.0.1:50051"))
    parser.add_argument("--stop", action="store_true", help="stop any motion first")
    arguments = parser.parse_args()

    with open_channel(arguments.server) as channel:
        service = rig_service_pb2_grpc.RigServiceStub(channel)
        if arguments.stop:
            service.StopMotion(rig_service_pb2.StopMotionRequest())
        print(describe(service.GetRig(rig_service_pb2.GetRigRequest())))


if __name__ == "__main__":
    try:
        main()
    except OSError as error:
        sys.exit(str(error))
    except grpc.RpcError as error:
        sys.exit(explain(error))
