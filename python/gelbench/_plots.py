"""Pictures with matplotlib."""

from __future__ import annotations

import base64
import io
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from ._errors import fault
from ._fields import Cells
from ._quantities import Floats

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from ._material import Material
    from ._solution import Solution, State
    from ._sweep_table import Band

__all__ = ["deformed", "forces", "image", "inline", "material_curves"]

CORNERS = {
    "triangle": [(0, 1, 2)],
    "triangle6": [(0, 3, 5), (3, 1, 4), (5, 4, 2), (3, 4, 5)],
    "quad": [(0, 1, 2), (0, 2, 3)],
    "quad8": [(0, 4, 7), (4, 1, 5), (5, 2, 6), (6, 3, 7), (4, 5, 6), (4, 6, 7)],
    "quad9": [(0, 4, 8), (0, 8, 7), (4, 1, 5), (4, 5, 8), (8, 5, 2), (8, 2, 6), (7, 8, 6), (7, 6, 3)],
}
"""Triangles of each kind of cells."""


def axes(ax: Axes | None) -> Axes:
    """The axes given, or new ones."""
    if ax is not None:
        return ax
    import matplotlib.pyplot as plt

    found: Axes = plt.subplots(layout="constrained")[1]
    return found


def image(png: bytes) -> str:
    """A picture in a notebook."""
    return f'<img style="max-width:100%" src="data:image/png;base64,{base64.b64encode(png).decode()}">'


def inline(draw: Callable[[Axes], object]) -> str:
    """A picture for a notebook, if matplotlib is installed."""
    try:
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from matplotlib.figure import Figure
    except ImportError:
        return ""
    figure: Any = Figure(figsize=(6.0, 3.2), layout="constrained")
    FigureCanvasAgg(figure)
    draw(figure.subplots())
    file = io.BytesIO()
    figure.savefig(file, format="png", dpi=110)
    return image(file.getvalue())


def triangles(cells: Cells) -> Any:
    """All cells as triangles of their nodes."""
    parts = [points[:, corner] for name, (_, points) in cells.items() for corner in CORNERS.get(name, [])]
    return np.concatenate(parts)


AXES = {2: ["x", "y"], 4: ["11", "22", "33", "12"], 5: ["11", "21", "12", "22", "33"]}
"""Names of the components of vectors and tensors, by their number."""


def label(name: str, component: str = "") -> str:
    """The label from an array's name: ``von_mises_stress_at_nodes_MPa`` → ``von mises stress [MPa]``."""
    words = name.replace("_at_nodes", "").split("_")
    known = {"MPa", "mm", "N"}
    unit = f" [{words.pop()}]" if words[-1] in known else ""
    text = " ".join([*words, component]).rstrip() + unit
    return text.replace("von mises", "von Mises").replace("cauchy", "Cauchy").replace("green lagrange", "Green–Lagrange")


def _limits(places: Floats, values: Floats) -> tuple[float, float, str]:
    """The values between which all but 0.2 % of the area lies at either end, and the ends that values far exceed, as at corners."""
    sides = places[:, 1:] - places[:, :1]
    areas = np.abs(sides[:, 0, 0] * sides[:, 1, 1] - sides[:, 0, 1] * sides[:, 1, 0])
    means = values.mean(axis=1)
    order = np.argsort(means)
    passed = np.cumsum(areas[order]) / areas.sum()
    low, high = (float(means[order][min(np.searchsorted(passed, share), order.size - 1)]) for share in (0.002, 0.998))
    far = 0.15 * (high - low)
    beyond = (low - values.min() > far, values.max() - high > far)
    low, high = (low if beyond[0] else float(values.min())), (high if beyond[1] else float(values.max()))
    return low, high, {(True, True): "both", (True, False): "min", (False, True): "max"}.get(beyond, "neither")


def deformed(state: State, quantity: str, component: int, ax: Axes | None, options: dict[str, Any]) -> Axes:
    """The deformed sheet, coloured by an array at its nodes."""
    data = state.point_data
    if quantity not in data:
        raise fault("quantity", f"there is no array `{quantity}`", f"arrays are {', '.join(data)}")
    own: Any = axes(ax)
    values = data[quantity]
    count = 1 if values.ndim == 1 else values.shape[1]
    if not 0 <= component < count:
        raise fault("component", f"is {component}, and {quantity} has {count}", f"give one from 0 to {count - 1}")
    values = values if values.ndim == 1 else values[:, component]
    words = label(quantity, "" if count == 1 else AXES.get(count, [str(one) for one in range(count)])[component])
    place = state.solution.points + state.displacement
    corners = triangles(state.solution.cells)
    low, high, extend = _limits(place[corners], values[corners])
    settings: dict[str, Any] = {"shading": "gouraud", "cmap": "viridis", "vmin": low, "vmax": high, **options}
    drawn = own.tripcolor(place[:, 0], place[:, 1], corners, values, **settings)
    own.set_aspect("equal")
    own.set_xlabel("x [mm]")
    own.set_ylabel("y [mm]")
    own.set_title(f"{state.solution.model}, load factor {state.factor:g}")
    extend = "neither" if {"vmin", "vmax", "norm"} & options.keys() else extend
    own.figure.colorbar(drawn, ax=own, label=words, shrink=0.8, extend=extend)
    found: Axes = own
    return found


def forces(solution: Solution, ax: Axes | None) -> Axes:
    """Force over load factor."""
    own = axes(ax)
    own.plot(solution.factors, solution.forces, "o-", label=solution.model)
    own.set_xlabel("load factor")
    own.set_ylabel("force [N]")
    own.grid(alpha=0.3)
    own.legend()
    return own


def band_over_steps(bands: Mapping[str, Band], ax: Axes | None) -> Axes:
    """Medians and bands of 5 … 95 % of the runs."""
    own: Any = axes(ax)
    for name, band in bands.items():
        (line,) = own.plot(band.at, band.median, "o-", label=f"{name}, median")
        own.fill_between(band.at, band.low, band.high, alpha=0.25, color=line.get_color(), label="5 … 95 %")
    own.set_xlabel("stretch, load factor, or time in s")
    own.set_ylabel(", ".join(dict.fromkeys(label(name.rpartition(".")[2]) for name in bands)))
    own.grid(alpha=0.3)
    own.legend()
    found: Axes = own
    return found


def material_curves(material: Material, ax: Axes | None, tests: tuple[str, ...], stretch: ArrayLike | None) -> Axes:
    """Nominal stress over stretch."""
    own = axes(ax)
    low, high = material.stretch_range
    at: Floats = np.linspace(low, high, 101) if stretch is None else np.asarray(stretch, dtype=np.float64)
    for test in tests:
        own.plot(at, material.stress(at, test), label=test)
    own.set_xlabel("stretch λ; 1 + γ of shear" if "shear" in tests else "stretch λ")
    own.set_ylabel("nominal stress [MPa]")
    own.set_title(material.title)
    own.grid(alpha=0.3)
    own.legend()
    return own
