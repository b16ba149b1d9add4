"""Pictures and report pages."""

from somersault.view._plots import root_loci, stability_chart

__all__ = ["root_loci", "stability_chart"]
