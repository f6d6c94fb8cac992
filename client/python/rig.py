#!/usr/bin/env python3
"""Says how the rig is; with --stop, stops it first (which needs no lease).

The stubs are made by the build (target hydroprint_python):

    PYTHONPATH=build/release/python client/python/rig.py --stop

HYDROPRINT_SERVER says where the daemon is ("https://host:port": over TLS), HYDROPRINT_CA which authority signed its
certificate if that is one of your own, and HYDROPRINT_API_KEY (hydroprint keys add) who asks, in place of the key that
`hydroprint login` keeps.
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
    """One line: state, position, speed, who has the lease, what is wrong."""
    parts = [rig_pb2.Rig.State.Name(rig.state)]
    if rig.HasField("position_mm"):
        parts.append(f"{rig.position_mm:.2f} mm  {rig.velocity_mm_per_s:.2f} mm/s")
    if rig.HasField("lease"):
        parts.append(f"lease: {rig.lease.holder} ({rig.lease.purpose})")
    return "  ".join(parts + [rig.trouble] if rig.trouble else parts)


def main():
    """Runs the example."""
    parser = argparse.ArgumentParser(description="Says how the rig is, or stops it.")
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
