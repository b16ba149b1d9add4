"""Choosing the passive body: numbers that make it reliable over a scatter of starts."""

from somersault.designs._choose import Choose
from somersault.designs._design import design
from somersault.designs._limit import Limit
from somersault.designs._mean import Mean
from somersault.designs._objective import Objective
from somersault.designs._pareto import TradeOff
from somersault.designs._quantile import Quantile
from somersault.designs._result import Design
from somersault.designs._share import Share
from somersault.designs._spec import DesignSpec, parse_design, read_design
from somersault.designs._trade_off import trade_off

__all__ = [
    "Choose",
    "Design",
    "DesignSpec",
    "Limit",
    "Mean",
    "Objective",
    "Quantile",
    "Share",
    "TradeOff",
    "design",
    "parse_design",
    "read_design",
    "trade_off",
]
