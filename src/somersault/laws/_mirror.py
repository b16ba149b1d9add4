"""A law as it is on the other side of the body."""

from __future__ import annotations

from somersault.laws._formula import Formula
from somersault.model import Model, mirror_images

_TURNED = ("tilt", "twist", "tilt_rate", "twist_rate")


def mirrored(law: Formula, model: Model, sign: float) -> Formula:
    """The law that commands the mirror image, where the body moves as its own mirror image does.

    Parameters
    ----------
    law : Formula
    model : Model
        Of the body.
    sign : float
        Of what is commanded: ±1.

    Returns
    -------
    Formula
    """
    turned = [*_TURNED, *(f"angular_velocity_{axis}" for axis in model.axes[1:])]
    images = {name: f"-{name}" for name in turned}
    for name, (image, factor, offset) in mirror_images(model).items():
        images[name] = f"({offset!r} + {factor!r} * {image!r})"
        images[f"{name}_rate"] = f"({factor!r} * {image + '_rate'!r})"
    return law.renamed(images, sign)


def mirrored_name(name: str, model: Model) -> str:
    """The name of what is sensed on the other side.

    Parameters
    ----------
    name : str
        Of something that is sensed.
    model : Model

    Returns
    -------
    str
    """
    for one, (image, _, _) in mirror_images(model).items():
        if name in (one, f"{one}_rate"):
            return image + name[len(one) :]
    return name
