"""Joints that follow joints that follow others: each made to follow the one that leads them all."""

from __future__ import annotations

from collections.abc import Collection, Mapping

from somersault._core.errors import SomersaultError
from somersault.model._bodies import Follow


def leaders(file: str, follows: Mapping[str, Follow], joints: Collection[str]) -> dict[str, Follow]:
    """What each joint follows in the end, through all that stand between.

    Parameters
    ----------
    file : str
        Its name, for what is refused.
    follows : mapping of str to Follow
        What each joint follows by the file.
    joints : collection of str
        The joints there are.

    Raises
    ------
    SomersaultError
        If one follows a joint that is not there, or in the end itself.
    """
    result = {}
    for name in follows:
        factor, offset, at = 1.0, 0.0, name
        passed = {name}
        while at in follows:
            link = follows[at]
            if link.leader not in joints:
                raise SomersaultError(
                    f"{file}: joint {at!r} mimics {link.leader!r}, which is no joint of it; "
                    "correct the name"
                )
            if link.leader in passed:
                raise SomersaultError(
                    f"{file}: joint {name!r} mimics itself through {at!r}; let one of them lead"
                )
            # q_name = factor q_at + offset, and q_at = link.factor q_leader + link.offset
            factor, offset = factor * link.factor, offset + factor * link.offset
            at = link.leader
            passed.add(at)
        result[name] = Follow(at, factor, offset)
    return result
