"""What an ensemble was: its dataset, and what it adds up to."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from somersault._core.checks import shown
from somersault._core.errors import SomersaultError
from somersault._core.places import check_file, check_folder
from somersault.ensembles import _netcdf, _store
from somersault.ensembles._metadata import require_whole
from somersault.simulation import ENDED

if TYPE_CHECKING:
    import os

    import xarray as xr
    from matplotlib.figure import Figure

    from somersault.ensembles._plan import Plan


@dataclass(frozen=True, eq=False)
class Ensemble:
    """Flights that differ in what was varied: `dataset` over the varied quantities.

    Made by `ensemble`, or by `Ensemble.open` from a file, which holds no `plan`: what was flown.
    """

    dataset: xr.Dataset
    plan: Plan | None = None

    @staticmethod
    def open(path: str | Path) -> Ensemble:
        """An ensemble that was written before, whole or in part.

        Parameters
        ----------
        path : str or Path
            A Zarr store, whose values are read when they are used, or a NetCDF file.

        Returns
        -------
        Ensemble

        Raises
        ------
        SomersaultError
            Where there is none, and where one is damaged.

        Examples
        --------
        >>> from tempfile import TemporaryDirectory
        >>> import somersault as so
        >>> vary = {"leant": so.Vary(adds_to="takeoff.tilt", normal=[0.0, 0.05])}
        >>> with TemporaryDirectory() as folder:
        ...     file = f"{folder}/leant.nc"
        ...     _ = so.ensemble("furrer", so.Takeoff(spin=8.64), 1.0, vary, size=4, out=file)
        ...     dict(so.Ensemble.open(file).dataset.sizes)
        {'sample': 4}
        """
        file = store_path("path", path)
        if not os.path.exists(file):  # which, unlike pathlib, takes any name
            raise SomersaultError(f"there is no ensemble {str(path)!r}; check the path")
        if file.suffix.lower() == ".nc":
            return Ensemble(_netcdf.read(file))
        require_whole(file)
        return Ensemble(_store.opened(file))

    def save(self, path: str | Path) -> None:
        """Write the dataset as a NetCDF file, whole or not at all.

        Parameters
        ----------
        path : str or Path
            It ends in .nc.

        Raises
        ------
        SomersaultError
            For another ending, and for a place where it cannot be written.

        Examples
        --------
        >>> from tempfile import TemporaryDirectory
        >>> import somersault as so
        >>> vary = {"leant": so.Vary(adds_to="takeoff.tilt", normal=[0.0, 0.05])}
        >>> flights = so.ensemble("furrer", so.Takeoff(spin=8.64), 1.0, vary, size=4)
        >>> with TemporaryDirectory() as folder:
        ...     flights.save(f"{folder}/leant.nc")
        """
        _netcdf.save(self.dataset, check_file(path, (".nc",)))

    def fraction(
        self,
        good: Any = None,
        tolerance: float | None = None,
        *,
        ended: str | None = None,
        over: str | Sequence[str] = "sample",
        confidence: float = 0.95,
    ) -> xr.Dataset:
        """The share of flights that came out right, with its confidence interval.

        One of `good`, `tolerance` and `ended` says which those are.

        Parameters
        ----------
        good : xarray.DataArray of bool, optional
            For each flight, like `found.dataset.tilt < 0.1`. One that failed was not
            good.
        tolerance : float, optional
            The flights whose landing error is at most so much, rad.
        ended : str, optional
            The flights that ended so: "duration", "event", "too many steps" …
        over : str or sequence of str
            The dimensions over which flights are counted.
        confidence : float
            That the interval holds the true share, between 0 and 1.

        Returns
        -------
        xarray.Dataset
            `fraction`, `low`, `high`, and `flights`, how many counted.

        Raises
        ------
        SomersaultError
            For what does not fit.

        Examples
        --------
        >>> import somersault as so
        >>> vary = {"leant": so.Vary(adds_to="takeoff.tilt", normal=[0.0, 0.05])}
        >>> found = so.ensemble("furrer", so.Takeoff(spin=8.64), 1.0, vary, size=20)
        >>> float(found.fraction(ended="duration")["fraction"])
        1.0
        """
        from somersault.ensembles._endings import ended_by, run_already
        from somersault.ensembles._summary import fraction, share, within

        given = sum(x is not None for x in (good, tolerance, ended))
        if given != 1:
            raise SomersaultError(
                f"fraction is given {given} of good, tolerance and ended; give one of them, to say "
                "which flights came out right"
            )
        codes = self.dataset[ENDED]
        if ended is not None:
            return share(ended_by(codes, ended), run_already(codes), over, confidence)
        chosen = within(self.dataset, tolerance) if good is None else good
        return fraction(chosen, codes, over, confidence)

    def quantiles(
        self, name: str, q: Sequence[float] = (0.05, 0.5, 0.95), **options: Any
    ) -> xr.Dataset:
        """Quantiles of a reported quantity, over the flights that did not fail.

        Parameters
        ----------
        name : str
            One of the variables.
        q : sequence of float
            From 0 to 1.
        **options
            `over`, as for `ensembles.quantiles`.

        Returns
        -------
        xarray.Dataset
            As `ensembles.quantiles` gives it.

        Raises
        ------
        SomersaultError
            For what does not fit.

        Examples
        --------
        >>> import somersault as so
        >>> vary = {"leant": so.Vary(adds_to="takeoff.tilt", normal=[0.0, 0.05])}
        >>> flights = so.ensemble("furrer", so.Takeoff(spin=8.64), 1.0, vary, size=20)
        >>> dict(flights.quantiles("tilt", [0.05, 0.95]).sizes)
        {'quantile': 2}
        """
        from somersault.ensembles._summary import quantiles

        return quantiles(self.dataset, name, q, **options)

    def sensitivity(self, name: str, **options: Any) -> xr.Dataset:
        """How much of the scatter of a reported quantity comes from each drawn one.

        Parameters
        ----------
        name : str
            One of the variables.
        **options
            `confidence` and `seed`, as for `ensembles.sensitivity`.

        Returns
        -------
        xarray.Dataset
            As `ensembles.sensitivity` gives it.

        Raises
        ------
        SomersaultError
            Where nothing is drawn, or there are too few samples.

        Examples
        --------
        >>> import somersault as so
        >>> vary = {
        ...     "leant": so.Vary(adds_to="takeoff.tilt", normal=[0.0, 0.05]),
        ...     "turned": so.Vary(adds_to="takeoff.twist", normal=[0.0, 0.05]),
        ... }
        >>> flights = so.ensemble("furrer", so.Takeoff(spin=8.64), 1.0, vary, size=500)
        >>> ranked = flights.sensitivity("tilt")
        """
        from somersault.ensembles._sensitivity import sensitivity

        return sensitivity(self.dataset, name, **options)

    def plot(self, name: str | None = None) -> Figure:
        """A picture of a reported quantity: a map over two grids, a band over one, or a histogram.

        Parameters
        ----------
        name : str, optional
            One of the variables; by default the landing error, or the first.

        Returns
        -------
        matplotlib.figure.Figure

        Raises
        ------
        SomersaultError
            For more than two grids, or where all flights failed.

        Examples
        --------
        >>> from tempfile import TemporaryDirectory
        >>> import somersault as so
        >>> vary = {"leant": so.Vary(adds_to="takeoff.tilt", normal=[0.0, 0.05])}
        >>> flights = so.ensemble("furrer", so.Takeoff(spin=8.64), 1.0, vary, size=20)
        >>> with TemporaryDirectory() as folder:
        ...     flights.plot("tilt").savefig(f"{folder}/tilt.svg")
        """
        from somersault.ensembles._plot import plot

        return plot(self.dataset, name)

    def landings(
        self,
        path: str | os.PathLike[str],
        good: Any = None,
        tolerance: float | None = None,
        *,
        plan: Plan | None = None,
        most: int = 100,
        **options: Any,
    ) -> None:
        """Write one picture of how flights landed: a body for each, coloured by what became of it.

        The flights that are drawn are flown once more. A map over two grids is drawn as a map, the
        second grid from left to right; others go by their landing error, if they have one.

        Parameters
        ----------
        path : path-like
            A .png file.
        good : xarray.DataArray of bool, optional
            Of each flight whether it landed, as for `fraction`.
        tolerance : float, optional
            Those landed whose landing error is at most so much, rad. Without it and without `good`
            colours say how flights ended.
        plan : Plan, optional
            What was flown, for an ensemble that was opened from a file, as
            `ensembles.read_ensemble(SPEC).plan` gives it.
        most : int
            Bodies that are drawn, evenly from all, at most 240.
        **options
            columns, superimposed, size, camera, ground: see `view.landings_picture`.

        Raises
        ------
        SomersaultError
            Without a plan, or with that of another ensemble, and for what does not fit.

        Examples
        --------
        >>> from tempfile import TemporaryDirectory
        >>> import somersault as so
        >>> vary = {"leant": so.Vary(adds_to="takeoff.tilt", normal=[0.0, 0.05])}
        >>> twist = so.arm_tilt()
        >>> flights = so.ensemble(twist, vary=vary, size=6, against=twist.fly())
        >>> with TemporaryDirectory() as folder:
        ...     flights.landings(f"{folder}/landings.png", tolerance=0.1)
        """
        from somersault.ensembles._landed import landings

        landings(
            self.dataset,
            self.plan if plan is None else plan,
            path,
            good,
            tolerance,
            most,
            **options,
        )


def check_out(given: str | Path) -> bool:
    """Whether the dataset is written in one piece, as NetCDF, at the end.

    Parameters
    ----------
    given : str or Path
        The name of a file that ends in .nc, or of a Zarr store: it ends in .zarr, has no ending,
        or is there already.

    Returns
    -------
    bool

    Raises
    ------
    SomersaultError
        For any other name, and for a place where it cannot be written.
    """
    path = store_path("out", given)
    whole = path.suffix.lower() == ".nc"
    if whole:
        check_file(path, (".nc",))
    elif path.suffix.lower() not in (".zarr", "") and not os.path.lexists(path):
        raise SomersaultError(
            f"{path} would be a Zarr store, a folder of files; let it end in .zarr, or in .nc for "
            "a NetCDF file"
        )
    elif not os.path.isfile(path):  # which is refused when it is opened as a store
        check_folder(path)
    return whole


def store_path(what: str, given: str | Path) -> Path:
    """The path of a store or a NetCDF file; SomersaultError naming `what` for what is none."""
    if not isinstance(given, str | Path) or str(given) in ("", ".") or "\0" in str(given):
        raise SomersaultError(
            f"{what} must be the path of a Zarr store or of a .nc file, and is {shown(given)}"
        )
    return Path(given)
