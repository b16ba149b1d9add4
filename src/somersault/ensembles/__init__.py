"""Many runs of anything that can be run with different numbers: what varies, where they are kept,
what they add up to."""

from somersault.ensembles._carried_out import carried_out
from somersault.ensembles._endings import ended_by, failed
from somersault.ensembles._ensemble import ensemble
from somersault.ensembles._kept import workers_kept
from somersault.ensembles._landings import landing_derivatives, landing_map
from somersault.ensembles._plan import Plan, check_name, plan
from somersault.ensembles._result import Ensemble, check_out
from somersault.ensembles._scheduler import tls_files
from somersault.ensembles._sensitivity import quick_sensitivity, sensitivity
from somersault.ensembles._spec import EnsembleSpec, parse_ensemble, read_ensemble
from somersault.ensembles._summary import fraction, quantiles, summary, within
from somersault.ensembles._vary import DISTRIBUTIONS, Vary

__all__ = [
    "DISTRIBUTIONS",
    "Ensemble",
    "EnsembleSpec",
    "Plan",
    "Vary",
    "carried_out",
    "check_name",
    "check_out",
    "ended_by",
    "ensemble",
    "failed",
    "fraction",
    "landing_derivatives",
    "landing_map",
    "parse_ensemble",
    "plan",
    "quantiles",
    "quick_sensitivity",
    "read_ensemble",
    "sensitivity",
    "summary",
    "tls_files",
    "within",
    "workers_kept",
]
