"""The way to hydroprintd that the examples share."""

import os

import grpc


class _Bearer(
    grpc.UnaryUnaryClientInterceptor,
    grpc.UnaryStreamClientInterceptor,
    grpc.StreamUnaryClientInterceptor,
):
    """Gives every call an API key."""

    def __init__(self, key):
        self._metadata = ("authorization", f"Bearer {key}")

    def _intercept(self, continuation, details, request):
        metadata = list(details.metadata or []) + [self._metadata]
        return continuation(details._replace(metadata=metadata), request)

    intercept_unary_unary = _intercept
    intercept_unary_stream = _intercept
    intercept_stream_unary = _intercept


def open_channel(server):
    """A channel to host:port, with the API key that HYDROPRINT_API_KEY has, if it has one."""
    channel = grpc.insecure_channel(server, [("grpc.enable_http_proxy", 0)])
    key = os.environ.get("HYDROPRINT_API_KEY")
    return grpc.intercept_channel(channel, _Bearer(key)) if key else channel
