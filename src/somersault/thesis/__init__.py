"""The thesis of Playter (1994), figure by figure: pictures, and claims that are checked."""

from somersault.thesis._claims import Claim, number, statement
from somersault.thesis._entries import Entry, Result, Table
from somersault.thesis._errata import ERRATA, Erratum
from somersault.thesis._motion import Motion
from somersault.thesis._page import verdict
from somersault.thesis._registry import ENTRIES
from somersault.thesis._reproduce import reproduce

__all__ = [
    "ENTRIES",
    "ERRATA",
    "Claim",
    "Entry",
    "Erratum",
    "Motion",
    "Result",
    "Table",
    "number",
    "reproduce",
    "statement",
    "verdict",
]
