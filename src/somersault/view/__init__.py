"""Pictures of models, of their motions and of their stability.

What is drawn of a motion is a `somersault.history.History`, whatever made it.
"""

from somersault.view._contact_sheet import contact_sheet, strip
from somersault.view._figure import camera, draw_pose
from somersault.view._histories import time_histories
from somersault.view._plots import root_loci, stability_chart

__all__ = [
    "camera",
    "contact_sheet",
    "draw_pose",
    "root_loci",
    "stability_chart",
    "strip",
    "time_histories",
]
