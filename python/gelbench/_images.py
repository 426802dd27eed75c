"""Camera images."""

from __future__ import annotations

import os
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np
from numpy.typing import ArrayLike

from . import _core
from ._errors import fault
from ._given import GivenFiles, paths_of
from ._progress import Progress, callback
from ._quantities import PathLike, Quantity, text, whole
from ._results import Results

if TYPE_CHECKING:
    import pandas

__all__ = ["Images", "Tracked", "image_options", "images_of", "track"]

Images: TypeAlias = "PathLike | Sequence[PathLike] | ArrayLike"
"""Files, folders and patterns, or arrays: frames × rows × columns, or a list of rows × columns."""

LUMINANCE = np.array([0.2126, 0.7152, 0.0722], dtype=np.float32)
"""Weights of red, green and blue."""


class Tracked(Results):
    """The pattern of a first image, followed through the others."""

    @property
    def markers(self) -> pandas.DataFrame:
        """All points of all frames: frame, number, position at rest, displacement and its standard deviation [mm]; `gelbench.correct` takes
        it as it is."""
        return self.tables["markers.csv"]


def track(
    images: Images,
    unit: Quantity,
    *,
    spacing: int = 8,
    subset: int | None = None,
    subset_shape: str = "affine",
    mask: PathLike | ArrayLike | None = None,
    outline: PathLike | ArrayLike | None = None,
    progress: Progress | None = None,
    allow_large: bool = False,
) -> Tracked:
    """Follows the pattern of the first image through all others.

    Parameters
    ----------
    images : path, list of paths or array_like
        The images, the first one of the specimen at rest: files, folders and patterns such as ``"frames/*.tif"``; or an array frames × rows
        × columns, or a list of arrays rows × columns. Values are grey values, or fractions of white.
    unit : quantity
        Length of a pixel [mm].
    spacing : int
        Distance of the points in pixels.
    subset : int, optional
        Width of the subsets in pixels; five speckles if omitted, and wide enough for the images' noise.
    subset_shape : {"affine", "quadratic"}
        The displacement in a subset.
    mask : path or array_like, optional
        The specimen's region, white on black, as an image or an array rows × columns.
    outline : path or array_like, optional
        The specimen's edge instead: a table, an array n × 2, or a list of these of which the inner ones are holes [mm]; x to the right and y up
        from the centre of the lower left pixel.
    progress : callable or tqdm bar, optional
        Is called for each frame.
    allow_large : bool
        Whether to allow computations beyond a common machine.

    Returns
    -------
    Tracked
        Points with displacements and standard deviations, pictures, report.

    Raises
    ------
    gelbench.InputError
        If an image cannot be read, or shows no pattern that can be followed.
    """
    files, frames = images_of(images)
    given = GivenFiles()
    edge = given.outline(outline)
    options = image_options(frames, spacing, subset, subset_shape, mask)
    size = text(unit, "mm", "unit")
    return Tracked(_core.track(files, size, edge, given.files, options, callback(progress), allow_large))


def images_of(images: Any) -> tuple[list[str], list[Any]]:
    """Files, or arrays."""
    files = paths_of(images)
    if files is not None:
        return files, []
    frames = list(images) if np.iterable(images) else []
    if not frames:
        raise fault("images", "holds no image", "give at least two, the first one of the specimen at rest")
    return [], [_grey(frame, f"images[{number}]") for number, frame in enumerate(frames)]


def image_options(frames: list[Any], spacing: int, subset: int | None, subset_shape: str, mask: Any) -> dict[str, Any]:
    """How images are followed."""
    is_file = mask is None or isinstance(mask, (str, os.PathLike))
    return {
        "frames": frames,
        "spacing": whole(spacing, "spacing", 1),
        "subset": None if subset is None else whole(subset, "subset", 5),
        "subset_shape": subset_shape,
        "mask": mask if is_file else _grey(mask, "mask"),
    }


def _grey(image: Any, argument: str) -> Any:
    """An image as an array of floats; of colours the luminance."""
    try:
        array = np.asarray(image, dtype=np.float32)
    except (TypeError, ValueError):
        raise fault(argument, "is not an array of numbers", "give rows × columns of grey values") from None
    if array.ndim == 3 and array.shape[2] in (3, 4):
        array = array[:, :, :3] @ LUMINANCE
    if array.ndim != 2:
        raise fault(argument, f"has the shape {array.shape}", "an image is rows × columns, or rows × columns × 3 of red, green and blue")
    return np.ascontiguousarray(array)
