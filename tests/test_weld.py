"""Welding against clouds of point masses that know nothing of welding."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from somersault.model import GROUND, Body, Joint, as_matrix, as_vector, merge_welded

Moments = tuple[float, np.ndarray, np.ndarray]  # mass, com, inertia about it


@dataclass
class Tree:
    """Bodies made of point masses, some on hinges, and where the points are."""

    bodies: list[Body]
    masses: np.ndarray  # (bodies, points)
    points: np.ndarray  # (bodies, points, 3), in each body's axes


def random_tree(seed: int, size: int = 12, points: int = 6) -> Tree:
    random = np.random.default_rng(seed)
    masses = random.uniform(0, 1, (size, points))
    places = random.normal(size=(size, points, 3))
    bodies = []
    for number in range(size):
        mass, com, inertia = moments(masses[number], places[number])
        axis = random.normal(size=3)
        hinge = Joint(f"j{number}", "hinge", as_vector(axis / np.linalg.norm(axis)))
        bodies.append(
            Body(
                name=f"b{number}",
                parent=int(random.integers(number)) if number else GROUND,
                mass=mass,
                com=as_vector(com),
                inertia=as_matrix(inertia),
                position=as_vector(random.normal(size=3)),
                rotation=as_matrix(Rotation.random(rng=random).as_matrix()),
                joints=(hinge,) if number and random.random() < 0.4 else (),
            )
        )
    return Tree(bodies, masses, places)


def moments(masses: np.ndarray, points: np.ndarray) -> Moments:
    """Mass, com and inertia about it of point masses."""
    com = masses @ points / masses.sum()
    arms = points - com
    squares = np.einsum("p,pi,pj->ij", masses, arms, arms)
    return float(masses.sum()), com, np.trace(squares) * np.eye(3) - squares


def frames(bodies: list[Body], angles: dict[str, float]) -> list[tuple[np.ndarray, np.ndarray]]:
    """Rotation and origin of each body at a pose, in the axes of the ground."""
    found: list[tuple[np.ndarray, np.ndarray]] = []
    for body in bodies:
        turn, origin = (np.eye(3), np.zeros(3)) if body.parent == GROUND else found[body.parent]
        origin = origin + turn @ body.position
        turn = turn @ body.rotation
        for joint in body.joints:
            hinge = Rotation.from_rotvec(angles[joint.name] * np.array(joint.axis))
            turn = turn @ hinge.as_matrix()
        found.append((turn, origin))
    return found


def whole(bodies: list[Body], angles: dict[str, float]) -> Moments:
    """Mass, com and inertia of bodies; each stands in as six points on its principal axes."""
    masses, points = [], []
    for body, (turn, origin) in zip(bodies, frames(bodies, angles), strict=True):
        size, axes = np.linalg.eigh(body.inertia)
        reach = np.sqrt(np.maximum(size.sum() / 2 - size, 0) * 3 / body.mass)
        for sign in (-1, 1):
            masses += [body.mass / 6] * 3
            points += [
                origin + turn @ (body.com + sign * r * a)
                for r, a in zip(reach, axes.T, strict=True)
            ]
    return moments(np.array(masses), np.array(points))


def cloud(tree: Tree, angles: dict[str, float], keep: list[bool]) -> Moments:
    """The same from the point masses of the kept bodies."""
    at = frames(tree.bodies, angles)
    points = [tree.points[n] @ at[n][0].T + at[n][1] for n, kept in enumerate(keep) if kept]
    return moments(tree.masses[keep].ravel(), np.concatenate(points))


def random_angles(tree: Tree, seed: int) -> dict[str, float]:
    random = np.random.default_rng(seed)
    return {joint.name: random.uniform(-3, 3) for body in tree.bodies for joint in body.joints}


@pytest.mark.parametrize("seed", range(20))
def test_welding_keeps_mass_com_and_inertia_at_every_pose(seed: int) -> None:
    tree = random_tree(seed)
    merged = merge_welded(tree.bodies, free=True)
    for pose in range(3):
        angles = random_angles(tree, pose)
        expected = cloud(tree, angles, [True] * len(tree.bodies))
        for ours, theirs in zip(whole(list(merged), angles), expected, strict=True):
            np.testing.assert_allclose(ours, theirs, rtol=1e-9, atol=1e-9)


@pytest.mark.parametrize("seed", range(20))
def test_what_stands_on_the_ground_is_dropped_and_the_rest_stays_put(seed: int) -> None:
    tree = random_tree(seed)
    moves: list[bool] = []
    for body in tree.bodies:
        moves.append(bool(body.joints) or (body.parent != GROUND and moves[body.parent]))
    merged = merge_welded(tree.bodies, free=False)
    angles = random_angles(tree, seed)
    for ours, theirs in zip(whole(list(merged), angles), cloud(tree, angles, moves), strict=True):
        np.testing.assert_allclose(ours, theirs, rtol=1e-9, atol=1e-9)


@pytest.mark.parametrize("free", [True, False])
def test_the_bodies_that_remain_keep_their_names_joints_and_order(free: bool) -> None:
    bodies = random_tree(4).bodies
    merged = merge_welded(bodies, free)
    remaining = [body for body in bodies if body.joints or (free and body is bodies[0])]
    assert [body.name for body in merged] == [body.name for body in remaining]
    assert [body.joints for body in merged] == [body.joints for body in remaining]
    assert all(GROUND <= body.parent < number for number, body in enumerate(merged))
    assert [body.parent for body in merged].count(GROUND) == 1 or not free


def test_a_body_to_which_nothing_is_welded_keeps_its_numbers_exactly() -> None:
    bodies = [body for body in random_tree(1).bodies if body.joints]
    chain = [
        Body(b.name, n - 1, b.mass, b.com, b.inertia, joints=b.joints) for n, b in enumerate(bodies)
    ]
    assert merge_welded(chain, free=False) == tuple(chain)


def test_a_body_without_mass_takes_over_what_is_welded_to_it() -> None:
    slide = Joint("s", "slide")
    carrier = Body("carrier", GROUND, 0.0, (0, 0, 0), ((0,) * 3,) * 3, joints=(slide,))
    load = Body("load", 0, 2.0, (0, 0, 1), as_matrix(np.diag([1.0, 1, 1])), position=(0, 3, 0))
    nothing = Body("nothing", 1, 0.0, (9, 9, 9), ((0,) * 3,) * 3)
    (merged,) = merge_welded([carrier, load, nothing], free=False)
    assert (merged.mass, merged.com) == (2, (0, 3, 1))
    np.testing.assert_array_equal(merged.inertia, np.eye(3))
