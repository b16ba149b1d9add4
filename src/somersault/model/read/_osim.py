"""`.osim` files, OpenSim's models, as a `Model`.

Meanings follow OpenSim's sources (opensim-org/opensim-core). Its own library would read the
format, but takes 280 MB and cannot be loaded into one process with CasADi, of which it has a copy.
"""

from __future__ import annotations

from collections import Counter, deque
from dataclasses import replace
from pathlib import Path

import numpy as np

from somersault._core.errors import SomersaultError
from somersault._core.notes import note
from somersault.model._base import Base, root, rooted
from somersault.model._bodies import GROUND, Body
from somersault.model._model import FileCoordinates, Model
from somersault.model._strange import Strange
from somersault.model._vectors import as_matrix, as_vector
from somersault.model.read._drawn import Drawn
from somersault.model.read._osim_functions import Line
from somersault.model.read._osim_gears import Gears
from somersault.model.read._osim_joints import FREE, Coordinate, Links, Move
from somersault.model.read._osim_left_out import add_left_out, no_part_in_flight
from somersault.model.read._osim_parts import GROUND_NAME, Part, parts_and_links
from somersault.model.read._osim_shapes import body_shapes, geometry_folders
from somersault.model.read._osim_words import Words
from somersault.model.read._xml import read_xml


def read_osim(path: Path, base: Base | None = None) -> Model:
    """The model in a `.osim` file, of OpenSim 2 to 4.

    Joints are named as the file's coordinates; their zeros are the file's, and the model is drawn
    with each at its default value. A body on a joint to the ground that moves in all six ways is
    the free base.

    Parameters
    ----------
    path : Path
    base : {"free", "planar", "fixed"}, optional
        Let the model go, or hold it by its base.

    Raises
    ------
    SomersaultError
        With the line, for what cannot be read or cannot be flown.
    """
    document = read_xml(path, latin=True)
    model = document if document.tag == "Model" else document.first("Model")
    if model is None:
        raise SomersaultError(f"{path.name} has no Model element, so it is no model of OpenSim")
    words = Words(path.name, model)
    parts, links, frames = parts_and_links(words, model)
    links = _outward(words, parts, _own_names([*links, *_let_go(parts, links)]))
    gears = Gears(words, model, links)
    strange = Strange()
    drawn = body_shapes(words, model, frames, Drawn(path.parent, strange, geometry_folders(path)))
    bodies = _bodies(parts, links, gears, drawn)
    on = rooted(path.name, bodies, free=False, base=base)
    if not on.bodies:
        raise SomersaultError(f"{path.name}: nothing in it moves, so nothing can fly")
    add_left_out(strange, model, links, gears)
    for sentence in strange.sentences():
        note(f"{path.name}: {sentence}")
    ignored = no_part_in_flight(model) + [f"body {name}, fixed to the ground" for name in on.still]
    if any(joint.stiffness or joint.damping for joint in on.let_go):
        ignored.append("the springs and dampers of the base")
    held = root(bodies, on.bodies[0].name) if on.free and on.let_go else ()
    coordinates = FileCoordinates(held, gears.geared)
    return Model(path.stem, on.free, on.bodies, tuple(ignored), on.axes, on.plane, coordinates)


def _let_go(parts: dict[str, Part], links: list[Links]) -> list[Links]:
    """Free joints for what no joint ties to the ground, as OpenSim adds them.

    Of several bodies that are joined together the first that is no joint's child is the base.
    """
    joined: dict[str, list[str]] = {name: [] for name in (GROUND_NAME, *parts)}
    for link in links:
        joined[link.parent].append(link.child)
        joined[link.child].append(link.parent)
    children = {link.child for link in links}
    placed: set[str] = set()

    def place(start: str) -> None:
        waiting = [start]
        while waiting:
            name = waiting.pop()
            if name not in placed:
                placed.add(name)
                waiting += joined[name]

    place(GROUND_NAME)
    added = []
    for name in sorted(parts, key=lambda name: name in children):
        if name not in placed:
            place(name)
            coordinates = [Coordinate(f"free_{name}_coord_{k}") for k in range(6)]
            moves = tuple(
                Move(coordinate.name, turns, axis, coordinate, Line(1.0))
                for (turns, axis), coordinate in zip(FREE, coordinates, strict=True)
            )
            shifts_first = tuple(sorted(moves, key=lambda move: move.turns))
            added.append(
                Links(f"free_{name}", GROUND_NAME, name, np.eye(4), np.eye(4), shifts_first, None)
            )
    return added


def _own_names(links: list[Links]) -> list[Links]:
    """The links, with coordinates of one name in two joints told apart by the joints' names."""
    joints = [{m.coordinate.name for m in link.moves if m.coordinate} for link in links]
    counts = Counter(name for names in joints for name in names)
    return [
        replace(
            link,
            moves=tuple(
                replace(
                    move,
                    coordinate=replace(move.coordinate, name=f"{link.name}_{move.coordinate.name}"),
                )
                if move.coordinate and counts[move.coordinate.name] > 1
                else move
                for move in link.moves
            ),
        )
        for link in links
    ]


# ------------------------------------------------------------------------------- bodies


def _outward(words: Words, parts: dict[str, Part], links: list[Links]) -> list[Links]:
    """The links seen from the ground outward, parents first; whatever moves in six ways on the
    ground before all others."""
    at: dict[str, list[tuple[int, Links]]] = {name: [] for name in (GROUND_NAME, *parts)}
    for number, link in enumerate(links):
        at[link.parent].append((number, link))
        at[link.child].append((number, link.backwards))
    at[GROUND_NAME].sort(key=lambda numbered: -len(numbered[1].moves))
    outward: list[Links] = []
    placed, used = {GROUND_NAME}, set[int]()
    waiting = deque([GROUND_NAME])
    while waiting:
        for number, link in at[waiting.popleft()]:
            if number in used:
                continue
            used.add(number)
            if link.child in placed:
                raise words.error(
                    f"joins {link.parent!r} and {link.child!r}, which other joints join already; a "
                    "body in the air is a tree, so cut the loop",
                    link.element,
                )
            placed.add(link.child)
            waiting.append(link.child)
            outward.append(link)
    return outward


def _bodies(parts: dict[str, Part], links: list[Links], gears: Gears, drawn: Drawn) -> list[Body]:
    """The body at the end of each link."""
    places = {GROUND_NAME: GROUND} | {link.child: n for n, link in enumerate(links)}
    bodies = [_body(parts[link.child], link, places[link.parent], gears) for link in links]
    return [replace(body, shapes=drawn.of(body.name)) for body in bodies]


def _body(part: Part, link: Links, parent: int, gears: Gears) -> Body:
    """A body with the joints that move it, drawn in the default pose.

    The frames P of the parent and B of the body are joined by P F · E₁ … E_n · (B M)⁻¹ with F and
    M the joint's frames in them and E_k the moves. A joint of a `Model` turns or shifts what comes
    after it: its axis and anchor are those of the frame before E_k, seen from B where all later
    moves stand as they are drawn.
    """
    frame = np.linalg.inv(link.in_child)  # B in the frame after the move
    joints = []
    for move in reversed(link.moves):
        frame = move.transform(gears.stands(move)) @ frame
        turn = frame[:3, :3].T
        joint = gears.joint(move, as_vector(turn @ move.axis), as_vector(-turn @ frame[:3, 3]))
        if joint is not None:
            joints.append(joint)
    frame = link.in_parent @ frame
    return Body(
        part.name,
        parent,
        part.mass,
        part.com,
        part.inertia,
        position=as_vector(frame[:3, 3]),
        rotation=as_matrix(frame[:3, :3]),
        joints=tuple(reversed(joints)),
    )
