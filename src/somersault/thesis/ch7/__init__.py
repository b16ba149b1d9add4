"""Chapter 7, the conclusions: passive and active control of one somersault side by side, and a
replay rate that errors adjust."""

from functools import partial

from somersault.thesis._entries import Chapter, Entry

_entry = partial(Entry.of, __name__)

CHAPTER = Chapter(
    "ch7",
    "Conclusions",
    (
        _entry("sec7-2", "§7.2: the somersault too", "_somersault_control.somersault_control"),
        _entry("sec7-3", "§7.3: the replay rate of the rudi", "_replay.replay_rate"),
        _entry("sec7-4", "§7.4: passive, active, and both", "_together.passive_and_active"),
        _entry("sec7-4-maps", "§7.4: how late, how far off, how stiff", "_maps.maps"),
        _entry("sec7-1-legs", "§7.1: leg springs that correct the rate", "_legs.leg_springs", True),
        _entry("sec7-5-layout", "§7.5: the layout, chosen", "_layout_design.layout_design", True),
        _entry("sec7-5-doll", "§7.5: the doll, chosen", "_layout_design.doll_design", True),
        _entry("sec7-5-rudi", "§7.5: the rudi, chosen", "_rudi_design.rudi_design", True),
        _entry("sec7-5-together", "§7.5: motion and compliance", "_rudi_together.together", True),
    ),
)
