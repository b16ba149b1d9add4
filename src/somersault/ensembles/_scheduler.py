"""The dask scheduler whose workers run an ensemble, reached by TLS or in the clear.

dask runs whatever it is sent. By TLS a scheduler takes only those whose certificate its authority
has signed; in the clear it takes everybody who reaches it.
"""

from __future__ import annotations

import gc
import ipaddress
import logging
import os
import socket
import ssl
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

from somersault._core.checks import file_path, shown
from somersault._core.errors import SomersaultError
from somersault._core.files import check_is_file
from somersault._core.notes import note

if TYPE_CHECKING:
    from distributed import Client
    from distributed.security import Security

_PORT = 8786  # a scheduler's, where none is given
_PATIENCE = 10.0  # s to find a scheduler
_CERTIFICATES = "--tls-ca, --tls-cert and --tls-key (in Python, security)"


def tls_files(
    ca: str | os.PathLike[str],
    cert: str | os.PathLike[str],
    key: str | os.PathLike[str] | None = None,
) -> Security:
    """How to reach a scheduler by TLS, with certificates in files (PEM).

    Parameters
    ----------
    ca : path-like
        The certificate of the authority that signed the scheduler's and the workers'.
    cert : path-like
        The program's own, signed by it too.
    key : path-like, optional
        Of `cert`, unless it stands in the same file.

    Returns
    -------
    distributed.security.Security

    Raises
    ------
    SomersaultError
        For a file that is not there, or holds no certificate or no key.
    """
    from distributed.security import Security

    given = {
        "tls_ca_file": str(file_path("ca", ca)),
        "tls_client_cert": str(file_path("cert", cert)),
    }
    if key is not None:
        given["tls_client_key"] = str(file_path("key", key))
    for file in given.values():
        check_is_file("certificate or key file", file)
    security = Security(require_encryption=True, **given)
    _context(security)
    return security


def check_security(security: Any) -> None:
    """SomersaultError for what is no `distributed.security.Security`."""
    from distributed.security import Security

    if not isinstance(security, Security):
        raise SomersaultError(
            f"security must be a distributed.security.Security, and is {shown(security)}"
        )


def check_scheduler(address: str, security: Security | None) -> None:
    """SomersaultError unless a scheduler answers at an address."""
    with unlogged():
        connected(address, security).close()


def note_open_door(address: str) -> None:
    """Note a scheduler on another machine that is reached in the clear."""
    from distributed.comm.addressing import parse_address

    try:
        scheme, place = parse_address(address)
        host = place.rpartition(":")[0] or place
        alone = host == "localhost" or ipaddress.ip_address(host.strip("[]")).is_loopback
    except ValueError:  # a name of a machine, or nothing that can be reached
        alone = False
    if scheme == "tcp" and not alone:
        note(
            f"{address} is reached in the clear, and dask runs code for whoever reaches it: keep "
            "it to a network of your own, or use tls:// with certificates"
        )


@contextmanager
def unlogged() -> Iterator[None]:
    """What goes wrong is said in one sentence, and not in dask's log as well."""
    logs = [logging.getLogger(name) for name in ("distributed", "distributed.client")]
    levels = [log.level for log in logs]
    for log in logs:
        log.setLevel(logging.CRITICAL + 1)
    try:
        yield
    finally:
        for log, level in zip(logs, levels, strict=True):
            log.setLevel(level)


def connected(address: str, security: Security | None) -> Client:
    """A client of the scheduler at an address; SomersaultError if none answers or trusts us.

    Without `security` certificates are those of dask's own configuration.
    """
    from distributed import Client
    from distributed.security import Security

    chosen = Security() if security is None else security
    try:
        _try(address, chosen)
        # A client that came to nothing must not be swept up while another is being made:
        # distributed holds one lock for both.
        gc.collect()
        return Client(address, timeout=_PATIENCE, security=chosen)
    except SomersaultError:
        raise
    except ssl.SSLError as trouble:
        raise SomersaultError(_untrusted(address, trouble)) from None
    except Exception as trouble:  # every kind of address has its own
        if _wants_tls(address):
            raise SomersaultError(
                f"what answers at {address!r} speaks TLS; write tls:// in front, and give "
                f"{_CERTIFICATES}"
            ) from None
        raise SomersaultError(
            f"no scheduler answers at {address!r} ({type(trouble).__name__}); start one with "
            "'dask scheduler' and give its address, like tcp://127.0.0.1:8786 (tls:// if it has "
            "certificates)"
        ) from None


def _try(address: str, security: Security) -> None:
    """OSError or ValueError unless something listens at an address, and trusts our certificate."""
    from distributed.comm.addressing import parse_address, parse_host_port

    scheme, place = parse_address(address)
    if scheme == "tcp" and security.require_encryption:
        raise SomersaultError(
            f"{address!r} is reached in the clear, and certificates are given; write tls:// in "
            "front, or leave them out"
        )
    if scheme not in ("tcp", "tls"):
        return
    with socket.create_connection(parse_host_port(place, _PORT), _PATIENCE) as line:
        if scheme == "tls":
            with _context(security).wrap_socket(line) as safe:
                safe.recv(1)  # a scheduler greets; only now does TLS 1.3 say what it thinks of us


def _wants_tls(address: str) -> bool:
    """Whether what answers at an address in the clear would rather speak TLS."""
    from distributed.comm.addressing import parse_address, parse_host_port

    asking = ssl.SSLContext(ssl.PROTOCOL_TLS_CLIENT)
    asking.check_hostname, asking.verify_mode = False, ssl.CERT_NONE  # nothing is told to it
    try:
        scheme, place = parse_address(address)
        if scheme != "tcp":
            return False
        with socket.create_connection(parse_host_port(place, _PORT), _PATIENCE) as line:
            asking.wrap_socket(line).close()
    except ssl.SSLError as trouble:
        return "ALERT" in (trouble.reason or "")  # which says in TLS that it wants a certificate
    except (OSError, ValueError):
        return False
    return True


def _context(security: Security) -> ssl.SSLContext:
    try:
        context = security.get_connection_args("client")["ssl_context"]
    except (OSError, ValueError) as trouble:  # ssl.SSLError among them
        reason = getattr(trouble, "reason", None) or getattr(trouble, "strerror", None) or trouble
        raise SomersaultError(
            f"the certificates and the key cannot be used ({reason}); give PEM files that belong "
            f"together as {_CERTIFICATES}"
        ) from None
    if context is None:
        raise SomersaultError(
            f"a scheduler at tls:// needs certificates; give {_CERTIFICATES}, or set "
            "distributed.comm.tls in dask's configuration"
        )
    return context


def _untrusted(address: str, trouble: ssl.SSLError) -> str:
    if isinstance(trouble, ssl.SSLCertVerificationError):
        return (
            f"the scheduler at {address!r} has a certificate that your authority has not signed "
            f"({trouble.verify_message}); give the certificate of the one that has, as --tls-ca"
        )
    if "ALERT" in (trouble.reason or ""):
        return (
            f"the scheduler at {address!r} does not take your certificate "
            f"({trouble.reason}); give one that its authority has signed, as --tls-cert"
        )
    return (
        f"what answers at {address!r} speaks no TLS ({trouble.reason}); start the scheduler with "
        "--protocol tls and its certificates, or write tcp:// in front"
    )
