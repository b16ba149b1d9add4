"""Pictures and films of models, of their motions and of their stability.

What is drawn of a motion is a `somersault.history.History`, whatever made it.
"""

from somersault.view._contact_sheet import contact_sheet, strip
from somersault.view._figure import camera, draw_pose
from somersault.view._film import check_film, film
from somersault.view._filmed import Filmed
from somersault.view._histories import time_histories
from somersault.view._look import Look
from somersault.view._page import check_page, page
from somersault.view._plots import root_loci, stability_chart
from somersault.view._stills import frame, picture, stroboscopic_picture

__all__ = [
    "Filmed",
    "Look",
    "camera",
    "check_film",
    "check_page",
    "contact_sheet",
    "draw_pose",
    "film",
    "frame",
    "page",
    "picture",
    "root_loci",
    "stability_chart",
    "strip",
    "stroboscopic_picture",
    "time_histories",
]
