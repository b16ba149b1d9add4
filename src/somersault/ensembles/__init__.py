"""Many flights: what varies, what is told, where it is kept, what it adds up to."""

from somersault.ensembles._ensemble import Ensemble, ensemble
from somersault.ensembles._landings import landing_derivatives, landing_map, landing_target
from somersault.ensembles._report import ENDINGS, Report, landing_error
from somersault.ensembles._sensitivity import sensitivity
from somersault.ensembles._summary import failed, fraction, quantiles, within
from somersault.ensembles._vary import Vary

__all__ = [
    "ENDINGS",
    "Ensemble",
    "Report",
    "Vary",
    "ensemble",
    "failed",
    "fraction",
    "landing_derivatives",
    "landing_error",
    "landing_map",
    "landing_target",
    "quantiles",
    "sensitivity",
    "within",
]
