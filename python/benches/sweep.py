"""Times a sweep of plates beside one loop of FElupe over the same: plates, mesh, law, stretches.

Both solve neo-Hookean plates of random stiffness and thickness in plane stress, clamped at both ends, in five steps to twice their
length, with biquadratic elements on one mesh. They take turns, a few plates each, so that a busy machine slows down both.

    pip install felupe
    python benches/sweep.py --plates 1000 --turn 25 --models sweep
"""

from __future__ import annotations

import argparse
import os
import time
from concurrent.futures import ThreadPoolExecutor

import felupe
import gelbench as gb
import numpy as np

LENGTH, WIDTH = 150.0, 50.0
STRETCHES = [0.15, 0.3, 0.5, 0.75, 1.0]
OWN = {
    "sweep": "gelbench, sweep: three models, three meshes, own errors",
    "finite-element": "gelbench, finite elements alone",
    "corrected": "gelbench, corrected alone",
}
SETTINGS = {"finite_element": {"cells": [60, 20]}, "output": {"report": False}}


def plate(c10=0.05, thickness=2.0):
    material = gb.Material.from_card("neo-hooke").with_parameters(c10=c10)
    return gb.Plate(LENGTH, WIDTH, thickness, material, settings=SETTINGS)


class PlaneStressNeoHooke:
    """Ψ = C₁₀ (tr C + 1/det C − 3) of an incompressible sheet, with derivatives by hand."""

    x = [np.zeros((2, 2)), np.zeros(0)]

    def __init__(self, c10):
        self.c10 = c10

    def gradient(self, x):
        f, state = x[0], x[-1]
        inverse = felupe.math.transpose(felupe.math.inv(f))
        return [2 * self.c10 * (f - inverse / felupe.math.det(f) ** 2), state]

    def hessian(self, x):
        f = x[0]
        inverse = felupe.math.transpose(felupe.math.inv(f))
        pairs = 2 * np.einsum("ij...,kl...->ijkl...", inverse, inverse) + np.einsum("il...,kj...->ijkl...", inverse, inverse)
        unit = np.einsum("ik,jl->ijkl", np.eye(2), np.eye(2))[..., None, None]
        return [2 * self.c10 * (unit + pairs / felupe.math.det(f) ** 2)]


class Loop:
    """FElupe's plate, its mesh and everything that can be kept made once."""

    def __init__(self):
        solution = plate().solve("finite-element", [0.01])
        ((_, cells),) = solution.cells.values()
        mesh = felupe.Mesh(np.array(solution.points), np.array(cells), cell_type="quad9")
        self.region = felupe.RegionBiQuadraticQuad(mesh)

    def force(self, c10, thickness):
        field = felupe.FieldContainer([felupe.Field(self.region, dim=2)])
        boundaries, loadcase = felupe.dof.uniaxial(field, clamped=True, sym=False, right=LENGTH, return_loadcase=True)
        solid = felupe.SolidBody(PlaneStressNeoHooke(c10), field)
        for stretch in STRETCHES:
            boundaries["move"].update(stretch * LENGTH)
            loadcase["ext0"] = felupe.dof.apply(field, boundaries, loadcase["dof0"])
            felupe.newtonraphson(items=[solid], verbose=0, **loadcase)
        return thickness * abs(felupe.tools.force(field, solid.results.force, boundaries["move"])[0])


def timed(work):
    start = time.perf_counter()
    found = np.array(work())
    return time.perf_counter() - start, found


def main():
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    arguments.add_argument("--plates", type=int, default=100, help="plates of each")
    arguments.add_argument("--turn", type=int, default=10, help="plates in a turn")
    arguments.add_argument("--models", nargs="+", choices=OWN, default=list(OWN), help="what of gelbench runs beside FElupe")
    given = arguments.parse_args()
    count, turn = given.plates, given.turn
    rng = np.random.default_rng(1)
    c10, thickness = rng.uniform(0.03, 0.07, count), rng.uniform(1.0, 3.0, count)
    loop, workers = Loop(), ThreadPoolExecutor(os.cpu_count())
    base = gb.Plate(LENGTH, WIDTH, 2.0, "neo-hooke", settings=SETTINGS)

    def swept(own):
        points = {"material.c10 [MPa]": c10[own], "plate.thickness [mm]": thickness[own]}
        return gb.sweep(base, points=points, factors=STRETCHES)["finite_element.force_N@1"]

    def single(model):
        one = lambda values: plate(*values).solve(model, STRETCHES).force  # noqa: E731
        return lambda own: list(workers.map(one, zip(c10[own], thickness[own])))

    runners = {"FElupe, one loop": lambda own: [loop.force(*values) for values in zip(c10[own], thickness[own])]}
    runners |= {OWN[model]: swept if model == "sweep" else single(model) for model in given.models}
    for run in runners.values():
        run(slice(0, 1))
    seconds, forces = {name: [] for name in runners}, {name: [] for name in runners}
    for first in range(0, count, turn):
        for name, run in runners.items():
            took, found = timed(lambda: run(slice(first, first + turn)))  # noqa: B023
            seconds[name].append(took)
            forces[name].append(found)
    reference = next(iter(runners))
    other = np.concatenate(forces[reference])
    print(f"{count} plates, {turn} in a turn; {os.cpu_count()} cores")
    for name in runners:
        ratios = np.array(seconds[reference]) / np.array(seconds[name])
        low, middle, high = np.quantile(ratios, [0.0, 0.5, 1.0])
        apart = np.abs(np.concatenate(forces[name]) / other - 1).max()
        print(
            f"{name:56} {sum(seconds[name]) / count:7.3f} s a plate, {middle:5.2f} times as fast ({low:.2f} … {high:.2f}), "
            f"forces within {apart:.1e}"
        )


if __name__ == "__main__":
    main()
