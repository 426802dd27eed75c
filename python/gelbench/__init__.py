"""gelbench: sheets of soft tissue and hydrogel at large strains.

A sheet is solved with a lattice of springs, with hyperelastic finite elements, and with the *corrector*, which takes any
displacement field and finds the nearest one that satisfies equilibrium and what is known at the boundary.

>>> import gelbench as gb
>>> plate = gb.Plate(length=150, width=50, thickness=2, material="pva-10")
>>> plate.solve(model="corrected", factors=[0.5]).force

Plain numbers are mm, N, MPa; texts with a unit and pint quantities are accepted too.
"""

from . import corrector
from ._core import __version__
from ._errors import Fault, InputError, SolveError, WriteError
from ._images import Tracked, track
from ._load import load
from ._markers import Correction, correct
from ._material import Material, Parameter, laws, materials
from ._motion import Motion
from ._plate import Plate
from ._results import Field, Results
from ._solution import AtPoints, GroupForce, Solution, State
from ._specimen import Specimen
from ._study import check, run
from ._sweep import SweepPlan, salib_problem, sweep
from ._sweep_table import Band, SweepTable
from ._tests import Estimate, Fit, Identification, biaxial, fit, identify

__all__ = [
    "AtPoints",
    "Band",
    "Correction",
    "Estimate",
    "Fault",
    "Field",
    "Fit",
    "GroupForce",
    "Identification",
    "InputError",
    "Material",
    "Parameter",
    "Motion",
    "Plate",
    "Results",
    "Solution",
    "SolveError",
    "Specimen",
    "State",
    "SweepPlan",
    "SweepTable",
    "Tracked",
    "WriteError",
    "__version__",
    "biaxial",
    "check",
    "correct",
    "corrector",
    "fit",
    "identify",
    "laws",
    "load",
    "materials",
    "run",
    "salib_problem",
    "sweep",
    "track",
]
