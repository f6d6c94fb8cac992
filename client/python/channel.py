"""Opens the connection to hydroprintd; shared by the examples."""

import os
import stat
import sys
import tomllib

import grpc

_TLS = "https://"
_PORT = ":50051"


class _Bearer(
    grpc.UnaryUnaryClientInterceptor,
    grpc.UnaryStreamClientInterceptor,
    grpc.StreamUnaryClientInterceptor,
):
    """Adds an API key to every call."""

    def __init__(self, key):
        self._metadata = ("authorization", f"Bearer {key}")

    def _intercept(self, continuation, details, request):
        metadata = list(details.metadata or []) + [self._metadata]
        return continuation(details._replace(metadata=metadata), request)

    intercept_unary_unary = _intercept
    intercept_unary_stream = _intercept
    intercept_stream_unary = _intercept


def _kept_key(address):
    """Returns the key that `hydroprint login` stored for host:port; None if there is none."""
    folder = os.environ.get("XDG_CONFIG_HOME") or os.path.join(os.path.expanduser("~"), ".config")
    path = os.path.join(folder, "hydroprint", "credentials.toml")
    try:
        with open(path, "rb") as file:
            if stat.S_IMODE(os.fstat(file.fileno()).st_mode) & 0o077:
                sys.exit(f"{path}: other users can read the keys in this file; run chmod 600 on it, "
                         "and create new keys")
            return tomllib.load(file).get(address, {}).get("api_key")
    except FileNotFoundError:
        return None
    except tomllib.TOMLDecodeError as error:
        sys.exit(f"{path}: not valid TOML ({error}); correct or delete the file")


def _is_loopback(address):
    host = address.rpartition(":")[0].strip("[]")
    return host in ("localhost", "::1") or (host.startswith("127.") and host.replace(".", "").isdigit())


def open_channel(server):
    """Opens a channel to "host:port", or "https://host:port" for TLS.

    HYDROPRINT_CA (a PEM file of trusted authorities) implies TLS. Uses the API key from HYDROPRINT_API_KEY or from
    `hydroprint login`, if there is one.
    """
    ca_file = os.environ.get("HYDROPRINT_CA")
    is_tls = server.startswith(_TLS) or bool(ca_file)
    address = server.removeprefix(_TLS).rstrip("/")
    if server.startswith(_TLS) and not address.rpartition("]")[2].count(":"):
        address += _PORT
    key = os.environ.get("HYDROPRINT_API_KEY") or _kept_key(address)
    if key and not is_tls and not _is_loopback(address):
        sys.exit(f"{address} is another machine, and without TLS the key could be intercepted; "
                 f"use {_TLS}{address}")
    options = [("grpc.enable_http_proxy", 0)]
    if is_tls:
        authorities = None
        if ca_file:
            with open(ca_file, "rb") as file:
                authorities = file.read()
        channel = grpc.secure_channel(address, grpc.ssl_channel_credentials(authorities), options)
    else:
        channel = grpc.insecure_channel(address, options)
    return grpc.intercept_channel(channel, _Bearer(key)) if key else channel


def explain(error):
    """Describes a failed call in one line."""
    text = f"{error.code().name}: {error.details()}"
    if error.code() == grpc.StatusCode.UNAVAILABLE:
        text += ("; check the address, whether the server uses TLS (https://host:port), and whether its certificate is "
                 "for this name and signed by an authority in HYDROPRINT_CA. `hydroprint status` names the cause")
    return text
