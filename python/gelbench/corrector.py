"""The corrective technique for any discretisation.

Of all fields that satisfy conditions, the one nearest to a given field is found, with Lagrange multipliers::

    minimise ½ ‖u − ū‖²_W   subject to   F(u) = 0,  T(u) = 0

F is the governing equation at some unknowns, T the other known conditions; both are `Condition` objects, whose values and
Jacobians come from any program. With as many conditions as unknowns, ū affects only the multipliers; with fewer, data and physics
together determine the field.

Examples
--------
The point of a parabola that is nearest to (0, 2):

>>> import numpy as np
>>> from gelbench import corrector
>>> parabola = corrector.Condition(
...     "parabola", lambda u: u[1] - u[0] ** 2, lambda u: np.array([[-2 * u[0], 1.0]]))
>>> corrector.correct([0.0, 2.0], [parabola], start=[1.0, 1.0]).field.round(6)
array([1.224745, 1.5     ])

References
----------
H. Mohammadi, W. Wan: A novel numerical corrective technique to mass spring systems.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any, Literal, NamedTuple, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _core
from ._errors import fault
from ._progress import Progress, callback
from ._quantities import Floats, array_of, finite, floats, whole

__all__ = ["Condition", "Corrected", "Estimate", "Matrix", "correct", "linear", "prescribed"]

Matrix: TypeAlias = Any
"""A sparse matrix or array of SciPy, or an array of two dimensions."""

Csr: TypeAlias = "tuple[NDArray[np.int64], NDArray[np.int64], Floats]"


class Condition:
    """Conditions c(u) = 0 on a field of n unknowns, with one multiplier per row.

    Parameters
    ----------
    name : str
        Name, for messages and multipliers.
    values : callable
        Of a field (n), the m values c(u). A NaN value marks the field as inadmissible: a shorter step is tried.
    jacobian : callable or matrix
        Of a field, ∂c/∂u, m × n, sparse or dense; a matrix if it is constant.
    curvature : callable, optional
        Of a field and m multipliers ψ, Σ ψᵢ ∂²cᵢ/∂u∂u, n × n; it saves steps if c is non-linear.
    unknowns : array_like of int, optional
        The unknown that each row belongs to, if each belongs to one. If all conditions together name each unknown once, the
        system is solved as a square one.
    """

    def __init__(
        self,
        name: str,
        values: Callable[[Floats], ArrayLike],
        jacobian: Callable[[Floats], Matrix] | Matrix,
        *,
        curvature: Callable[[Floats, Floats], Matrix] | None = None,
        unknowns: ArrayLike | None = None,
    ) -> None:
        self.name = name
        self._values = values
        self._jacobian: Callable[[Floats], Matrix] = jacobian if callable(jacobian) else lambda _: jacobian
        self._curvature = curvature
        self._unknowns = None if unknowns is None else _numbers(unknowns, f"unknowns of `{name}`")

    def values(self, u: ArrayLike) -> Floats:
        """The values at a field."""
        found = self._values(np.asarray(u, dtype=np.float64))
        what = f"the values of `{self.name}`"
        return floats(np.atleast_1d(array_of(found, what)), what, (None,))

    def jacobian(self, u: ArrayLike) -> Matrix:
        """The Jacobian at a field."""
        return self._jacobian(np.asarray(u, dtype=np.float64))

    def check(self, u: ArrayLike, *, step: float = 1e-6, seed: int = 0) -> float:
        """Compares the Jacobian with finite differences along a random direction.

        Parameters
        ----------
        u : array_like
            The field.
        step : float
            Length of the direction relative to that of the field, or to 1.

        Returns
        -------
        float
            The deviation relative to the larger of both; about 1e-8 if the Jacobian is right.
        """
        field = finite(floats(u, "u", (None,)), "u")
        direction = np.random.default_rng(seed).standard_normal(field.size)
        length = step * max(1.0, float(np.abs(field).max(initial=0.0)))
        difference = (self.values(field + length * direction) - self.values(field - length * direction)) / (2 * length)
        derivative = np.asarray(self.jacobian(field) @ direction).reshape(-1)
        size = max(float(np.linalg.norm(difference)), float(np.linalg.norm(derivative)), np.finfo(float).tiny)
        return float(np.linalg.norm(difference - derivative)) / size

    def _given(self, start: Floats) -> dict[str, Any]:
        rows = finite(self.values(start), f"the values of `{self.name}` at the start").size
        size = start.size

        # Behind the field the library's unknowns may have others, which the conditions do not know.
        def linearise(unknowns: Floats) -> tuple[Floats, Csr]:
            u = unknowns[:size]
            values = self.values(u)
            if values.size != rows:
                raise fault("conditions", f"`{self.name}` has {values.size} values, and had {rows}", "return equally many each time")
            return values, _csr(self._jacobian(u), (rows, size), f"the Jacobian of `{self.name}`")

        def curvature(unknowns: Floats, multipliers: Floats) -> Csr:
            assert self._curvature is not None
            begins, places, values = _csr(self._curvature(unknowns[:size], multipliers), (size, size), f"the curvature of `{self.name}`")
            return np.pad(begins, (0, unknowns.size - size), mode="edge"), places, values

        unknowns = None
        if self._unknowns is not None:
            if self._unknowns.size != rows or (self._unknowns < 0).any() or (self._unknowns >= size).any():
                raise fault("conditions", f"the unknowns of `{self.name}` do not fit", f"give one of {size} for each of {rows} rows")
            unknowns = self._unknowns.tolist()
        return {
            "name": self.name,
            "rows": rows,
            "linearise": linearise,
            "curvature": None if self._curvature is None else curvature,
            "unknowns": unknowns,
        }


def linear(name: str, matrix: Matrix, right_hand_side: ArrayLike, *, unknowns: ArrayLike | None = None) -> Condition:
    """Linear conditions B u − b = 0.

    Parameters
    ----------
    name : str
        Name.
    matrix : matrix
        B, m × n.
    right_hand_side : array_like
        b, m.
    unknowns : array_like of int, optional
        As of `Condition`.
    """
    given = finite(floats(right_hand_side, "right_hand_side", (None,)), "right_hand_side")
    if not hasattr(matrix, "shape"):
        matrix = floats(np.atleast_2d(np.asarray(matrix)), "matrix", (None, None))
    if matrix.shape[0] != given.size:
        raise fault("right_hand_side", f"has {given.size} entries, the matrix {matrix.shape[0]} rows", "give one a row")

    def values(u: Floats) -> Floats:
        found: Floats = np.asarray(matrix @ u).reshape(-1) - given
        return found

    return Condition(name, values, matrix, unknowns=unknowns)


def prescribed(name: str, size: int, known: Mapping[int, float]) -> Condition:
    """Known values uᵢ = gᵢ: supports, symmetry, measured entries.

    Parameters
    ----------
    name : str
        Name.
    size : int
        Unknowns of the field, n.
    known : mapping
        Values by the numbers of the unknowns.
    """
    unknowns = _numbers(list(known), "known")
    given = finite(floats(list(known.values()), "known", (None,)), "known")
    if (unknowns < 0).any() or (unknowns >= size).any():
        raise fault("known", "names unknowns that the field does not have", f"it has {size}, counted from 0")
    rows = _Selection(unknowns, size)

    def values(u: Floats) -> Floats:
        found: Floats = u[unknowns] - given
        return found

    return Condition(name, values, rows, unknowns=unknowns)


def _numbers(unknowns: Any, argument: str) -> NDArray[np.int64]:
    """Numbers of unknowns."""
    given: list[Any] = np.asarray(unknowns).reshape(-1).tolist()
    return np.array([whole(one, argument) for one in given], dtype=np.int64)


class _Selection:
    """The matrix that picks some unknowns."""

    def __init__(self, unknowns: NDArray[np.int64], size: int) -> None:
        self.shape = (unknowns.size, size)
        self.indptr = np.arange(unknowns.size + 1, dtype=np.int64)
        self.indices = unknowns
        self.data = np.ones(unknowns.size)

    def tocsr(self) -> _Selection:
        return self

    def __matmul__(self, u: Floats) -> Floats:
        found: Floats = u[self.indices]
        return found


class Estimate(NamedTuple):
    """An unknown with its uncertainty."""

    value: float
    """Its value."""
    standard_error: float
    """Its standard error."""
    interval: tuple[float, float]
    """Its 95 % interval."""


class Corrected(NamedTuple):
    """A corrected field and its iterations."""

    field: Floats
    """u, n."""
    multipliers: dict[str, Floats]
    """Multipliers by condition: −∂(½ ‖u − ū‖²_W)/∂b of each row c(u) = b."""
    residuals: Floats
    """The largest residual, as a distance relative to the largest entry, at the start and after each step."""
    lengths: Floats
    """The fraction of the linearised step taken in each step; 1 for the start."""
    estimates: dict[int, Estimate]
    """Requested unknowns with their uncertainty."""

    @property
    def steps(self) -> int:
        """Steps that were taken."""
        return len(self.residuals) - 1


def correct(
    field: ArrayLike,
    conditions: Condition | Sequence[Condition],
    *,
    start: ArrayLike | None = None,
    weights: ArrayLike | None = None,
    covariance: ArrayLike | None = None,
    estimate: Iterable[int] = (),
    tolerance: float = 1e-10,
    movement: float = 1e-9,
    max_steps: int = 40,
    solver: Literal["automatic", "dense", "cholesky", "kkt", "symmetric"] = "automatic",
    progress: Progress | None = None,
) -> Corrected:
    """Finds the field nearest to a given one that satisfies conditions.

    Parameters
    ----------
    field : array_like
        ū, n.
    conditions : sequence of Condition
        F and T.
    start : array_like, optional
        Start of the search, n; ū by default. Never start from noisy data: the conditions are linearised there.
    weights : array_like, optional
        The diagonal of W, n: inverse variances of ū; 1 by default. An entry with weight 0 has no data: it is a parameter
        that is estimated with the field.
    covariance : array_like, optional
        W⁻¹, n × n, symmetric and positive definite, in place of `weights`: of data whose errors are correlated, as those of overlapping
        subsets of an image. It is dense, and so is the time for it: seconds at 1,000 unknowns.
    estimate : iterable of int
        Unknowns whose uncertainty is requested; the variance of the data follows from their residuals.
    tolerance : float
        Largest residual, as a distance relative to the largest entry of the field.
    movement : float
        Largest remaining step that is not taken, relative to the largest entry.
    max_steps : int
        Largest number of steps.
    solver : {"automatic", "dense", "cholesky", "kkt", "symmetric"}
        How the linear system of each step is solved, with B the Jacobian of all conditions. "dense": QR of W^(−½) Bᵀ, up to some thousand
        unknowns, the most exact; "cholesky": sparse Cholesky of B W⁻¹ Bᵀ, with positive weights and few conditions; "kkt": sparse LU of the
        whole system, always possible; "symmetric": sparse Cholesky of a square B whose conditions are those of an energy.
        "automatic" chooses by size, weights and `unknowns`.
    progress : callable or tqdm bar, optional
        Reserved for long computations.

    Returns
    -------
    Corrected
        The field, the multipliers and the iterations.

    Raises
    ------
    gelbench.InputError
        If shapes do not match, or values are not finite.
    gelbench.SolveError
        If no field is found, or conditions are linearly dependent: the rows are named.
    """
    if isinstance(conditions, Condition):
        conditions = [conditions]
    given = finite(floats(field, "field", (None,)), "field")
    begin = given if start is None else finite(floats(start, "start", (given.size,)), "start")
    own = np.ones(given.size) if weights is None else finite(floats(weights, "weights", (given.size,)), "weights")
    if (own < 0.0).any():
        raise fault("weights", f"holds {own.min()}", "weights are inverse variances, or zero")
    if weights is not None and covariance is not None:
        raise fault("covariance", "is given beside weights", "give one of both: its inverse is their matrix")
    wanted = [whole(unknown, "estimate") for unknown in estimate]
    if any(unknown not in range(given.size) for unknown in wanted):
        raise fault("estimate", "names unknowns that the field does not have", f"it has {given.size}, counted from 0")
    _refuse_equal_names(conditions)
    settings = {
        "tolerance": _not_negative(tolerance, "tolerance"),
        "movement": _not_negative(movement, "movement"),
        "max_steps": whole(max_steps, "max_steps"),
        "solver": solver,
    }
    listed = [condition._given(begin) for condition in conditions]
    if not (own > 0.0).any() and sum(one["rows"] for one in listed) < given.size:
        hint = "give measured entries a positive weight, or state as many conditions as unknowns"
        raise fault("weights", "are all zero, and the conditions alone do not determine the field", hint)
    scale = 1.0
    if covariance is not None:
        root = _root(covariance, given.size)
        # The unknowns behind the field are in its unit: tolerances are relative to the largest entry of all.
        scale = float(np.linalg.norm(root) / np.sqrt(given.size))
        root = root / scale
        pairs = (np.concatenate([one, np.linalg.solve(root, one)]) for one in (given, begin, own))
        given, begin, own = (np.asarray(one, dtype=np.float64) for one in pairs)
        own[: given.size // 2], own[given.size // 2 :] = 0.0, 1.0
        listed.append(_link(root))
    if solver == "dense":
        _check_dense(given.size, sum(one["rows"] for one in listed))
    found = _core.corrected(given, begin, own, listed, settings, wanted, callback(progress))
    u, residuals, lengths, multipliers, estimates = found
    return Corrected(
        u if covariance is None else u[: u.size // 2],
        {name: values / scale**2 for name, values in multipliers if name != _LINK},
        np.array(residuals),
        np.array(lengths),
        {unknown: Estimate(*one) for unknown, one in zip(wanted, estimates, strict=True)},
    )


_LINK = "correlated errors"
"""The condition u = L v between a field with correlated errors and its uncorrelated part v, of which the data are."""


def _root(covariance: ArrayLike, size: int) -> Floats:
    """The Cholesky factor L of a covariance."""
    given = finite(floats(covariance, "covariance", (size, size)), "covariance")
    if not np.allclose(given, given.T, rtol=1e-9, atol=1e-12 * np.abs(given).max(initial=0.0)):
        raise fault("covariance", "is not symmetric", "give the covariance of the errors of the field's entries")
    try:
        return np.asarray(np.linalg.cholesky(given), dtype=np.float64)
    except np.linalg.LinAlgError:
        raise fault("covariance", "is not positive definite", "add the variance of each entry's own error to the diagonal") from None


def _link(root: Floats) -> dict[str, Any]:
    size = len(root)
    matrix = _csr(np.hstack([-np.eye(size), root]), (size, 2 * size), "the covariance")

    def linearise(unknowns: Floats) -> tuple[Floats, Csr]:
        return root @ unknowns[size:] - unknowns[:size], matrix

    unknowns = list(range(size, 2 * size))
    return {"name": _LINK, "rows": size, "linearise": linearise, "curvature": None, "unknowns": unknowns}


def _check_dense(unknowns: int, rows: int) -> None:
    """Refuses matrices that no memory holds."""
    gigabytes = 8e-9 * unknowns * (unknowns + rows)
    if gigabytes > 4.0:
        message = f"would need {gigabytes:.0f} GB for {unknowns} unknowns and {rows} conditions"
        raise fault("solver", message, 'leave it "automatic", or take "kkt"')


def _refuse_equal_names(conditions: Sequence[Condition]) -> None:
    names = [condition.name for condition in conditions]
    twice = next((name for name in names if names.count(name) > 1), None)
    if twice is not None:
        message = f"two are named `{twice}`"
        raise fault("conditions", message, "give each its own name: multipliers are accessed by name")


def _not_negative(value: float, argument: str) -> float:
    found = float(array_of(value, argument).reshape(-1)[0])
    if not 0.0 <= found < np.inf:
        raise fault(argument, f"is {value!r}", "it must be a number that is not negative")
    return found


def _csr(matrix: Matrix, shape: tuple[int, int], what: str) -> Csr:
    if not hasattr(matrix, "tocsr"):
        matrix = _Dense(floats(np.atleast_2d(np.asarray(matrix)), what, (None, None)))
    if tuple(matrix.shape) != shape:
        raise fault("conditions", f"{what} has the shape {tuple(matrix.shape)}", f"it must be {shape[0]} × {shape[1]}")
    rows = matrix.tocsr()
    data = finite(np.ascontiguousarray(rows.data, dtype=np.float64), what)
    return np.asarray(rows.indptr, dtype=np.int64), np.asarray(rows.indices, dtype=np.int64), data


class _Dense:
    """A dense matrix by rows."""

    def __init__(self, matrix: Floats) -> None:
        self.shape = matrix.shape
        rows, columns = np.nonzero(matrix)
        counts = np.bincount(rows, minlength=matrix.shape[0])
        self.indptr = np.concatenate([[0], np.cumsum(counts)]).astype(np.int64)
        self.indices = columns.astype(np.int64)
        self.data = matrix[rows, columns]

    def tocsr(self) -> _Dense:
        return self
