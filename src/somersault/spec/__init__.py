"""TOML files: read into frozen dataclasses, and written from them."""

from somersault.spec._tables import (
    Misplaced,
    Unfit,
    plain,
    plain_fields,
    read_as,
    structured,
    structured_within,
    written_as,
)
from somersault.spec._toml import model_beside, read_toml, require_table, write_toml

__all__ = [
    "Misplaced",
    "Unfit",
    "model_beside",
    "plain",
    "plain_fields",
    "read_as",
    "read_toml",
    "require_table",
    "structured",
    "structured_within",
    "write_toml",
    "written_as",
]
