"""Threads, processes and clusters that a command may use."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any


def add_cluster(parser: argparse.ArgumentParser) -> None:
    """Declare where runs are carried out."""
    parser.add_argument("--threads", type=int, metavar="N", help="threads (default: one per core)")
    parser.add_argument(
        "--workers", type=int, metavar="N", help="processes of dask.distributed on this machine"
    )
    parser.add_argument(
        "--scheduler", metavar="ADDRESS", help="the dask scheduler whose workers fly"
    )
    for option, what in (
        ("--tls-ca", "certificate of the authority that signed the scheduler's and the workers'"),
        ("--tls-cert", "certificate to show a scheduler at tls://"),
        ("--tls-key", "its key, unless that is in the same file"),
    ):
        parser.add_argument(option, type=Path, metavar="FILE", help=what)


def security(chosen: argparse.Namespace) -> Any:
    """The certificates that are given; None leaves them to dask's configuration."""
    from somersault._core.errors import SomersaultError
    from somersault.ensembles import tls_files

    if chosen.tls_ca is None and chosen.tls_cert is None and chosen.tls_key is None:
        return None
    if chosen.scheduler is None:
        raise SomersaultError(
            "--tls-ca, --tls-cert and --tls-key go with --scheduler; give its address, tls://…, "
            "or leave them out"
        )
    if chosen.tls_ca is None or chosen.tls_cert is None:
        raise SomersaultError("--tls-ca and --tls-cert go together; give both, and --tls-key")
    return tls_files(chosen.tls_ca, chosen.tls_cert, chosen.tls_key)
