"""Arrays that are handed out are read-only, and those that are taken keep their units and their masks."""

import json

import gelbench as gb
import numpy as np
import pytest
from gelbench import corrector

SAID = dict(test="uniaxial", stress="nominal", strain="stretch")


@pytest.fixture(scope="module")
def plate():
    return gb.Plate(60, 20, 2, "neo-hooke", cells=(12, 4), settings={"finite_element": {"cells": [12, 4]}})


@pytest.fixture(scope="module")
def curve():
    stretch = np.linspace(1.02, 1.9, 30)
    noise = np.random.default_rng(3).normal(scale=2e-4, size=stretch.size)
    return np.column_stack([stretch, gb.Material.from_card("neo-hooke").stress(stretch) + noise])


def test_what_is_kept_cannot_be_written_into_nor_be_made_writeable(plate):
    solution = plate.solve("mass-spring", 0.2)
    field = plate.run([0.2]).fields["corrected"][0]
    table = gb.sweep(plate, {"plate.width": ["20 mm", "22 mm"]}, factors=[0.2])
    arrays = [solution.points, solution.displacement, solution.last.residual, solution.stress]
    arrays += [*solution.point_data.values(), *solution.cell_data.values(), *field.point_data.values(), field.points]
    arrays += [table["corrected.force_N@0.2"], table["plate.width"]]
    for own in arrays:
        base = own
        while isinstance(base, np.ndarray):
            assert not base.flags.writeable
            with pytest.raises(ValueError):
                base.flags.writeable = True
            base = base.base


def masked(array, *place):
    own = np.ma.array(array, mask=np.zeros(np.shape(array), dtype=bool))
    own[place] = np.ma.masked
    return own


def test_masked_rows_of_a_test_are_left_out(curve):
    spoilt = curve.copy()
    spoilt[3, 1] = 1e6
    left = gb.fit(np.delete(curve, 3, axis=0), "neo-hooke", **SAID).parameters
    assert gb.fit(masked(spoilt, 3, 1), "neo-hooke", **SAID).parameters == left
    columns = {"stretch [-]": curve[:, 0], "stress [MPa]": masked(spoilt[:, 1], 3)}
    assert gb.fit(columns, "neo-hooke", **SAID).parameters == left


def test_masked_markers_are_lost_ones(root):
    pandas = pytest.importorskip("pandas")
    table = pandas.read_csv(root / "examples/measured_plate.csv", comment="#")
    table = table[table["frame"] == table["frame"].max()][["x [mm]", "y [mm]", "ux [mm]", "uy [mm]"]].to_numpy()
    spoilt = table.copy()
    spoilt[7, 2] = 1e3
    said = dict(free=["top", "bottom"], rigid=["left", "right"], edge_gap=0, noise=0.25)
    without = gb.correct(np.delete(table, 7, axis=0), "pva-10", 2.0, **said)
    assert gb.correct(masked(spoilt, 7, 2), "pva-10", 2.0, **said).forces == without.forces


@pytest.mark.parametrize(
    ("wrong", "named"),
    [
        (lambda: gb.Material.from_card("neo-hooke").stress(masked([1.1, 1.2], 0)), "stretch"),
        (lambda: corrector.correct(masked([1.0, 2.0], 0), []), "field"),
        (lambda: gb.sweep(gb.Plate(), {"plate.width": masked([1.0, 2.0], 0)}), "plate.width"),
        (lambda: gb.sweep(gb.Plate(), points={"plate.width [mm]": masked([1.0, 2.0], 0)}), "plate.width"),
        (lambda: gb.Specimen.from_mesh(masked(np.zeros((4, 2)), 0, 0), {"quad": [[0, 1, 2, 3]]}, thickness=2,
                                       material="neo-hooke", supports={}, measured="right"), "points"),
        (lambda: gb.Specimen.from_mesh(np.zeros((4, 2)), {"quad": masked([[0, 1, 2, 3]], 0, 0)}, thickness=2,
                                       material="neo-hooke", supports={}, measured="right"), "cells"),
    ],
)  # fmt: skip
def test_masked_entries_are_refused_where_each_is_needed(wrong, named):
    with pytest.raises(gb.InputError, match=f"{named}.*masked"):
        wrong()


@pytest.fixture(scope="module")
def units():
    return pytest.importorskip("pint").UnitRegistry()


def test_percents_and_lists_of_quantities_are_converted(units):
    card = gb.Material.from_card("neo-hooke")
    assert card.stress(units.Quantity(150, "percent")) == card.stress(1.5)
    assert np.array_equal(card.stress([units.Quantity(150, "percent"), 1.2]), card.stress([1.5, 1.2]))
    with pytest.raises(gb.InputError, match="stretch"):
        card.stress(units.Quantity(1.5, "mm"))


def test_columns_of_quantities_keep_their_units(units, curve):
    usual = gb.fit(curve, "neo-hooke", **SAID).parameters["c10"].value
    stress = units.Quantity(1e3 * curve[:, 1], "kPa")
    for head in ("stress [MPa]", "stress"):
        found = gb.fit({"stretch [-]": curve[:, 0], head: stress}, "neo-hooke", **SAID)
        assert found.parameters["c10"].value == pytest.approx(usual, rel=1e-9)
    with pytest.raises(gb.InputError, match="one unit"):
        gb.fit(units.Quantity(curve, "MPa"), "neo-hooke", **SAID)


def test_markers_in_centimetres_are_those_in_millimetres(units, root):
    pandas = pytest.importorskip("pandas")
    table = pandas.read_csv(root / "examples/measured_plate.csv", comment="#")
    table = table[table["frame"] == table["frame"].max()][["x [mm]", "y [mm]", "ux [mm]", "uy [mm]"]].to_numpy()
    said = dict(free=["top", "bottom"], rigid=["left", "right"], edge_gap=0, noise=0.25)
    usual, own = (gb.correct(one, "pva-10", 2.0, **said) for one in (table, units.Quantity(table / 10, "cm")))
    assert own.forces["right"][0].value == pytest.approx(usual.forces["right"][0].value, rel=1e-9)


def test_quantities_of_any_unit_are_swept(units, plate):
    def settings(varied=None, **others):
        return gb.SweepPlan(plate, varied, **others).settings

    assert settings({"plate.width": units.Quantity(2.0, "cm")}).keys() == {"plate.width [cm]"}
    assert settings({"material.c10": [0.05 * units.N / units.mm**2]}).keys() == {"material.c10 [N/mm^2]"}
    in_mm = settings(points={"plate.width [mm]": units.Quantity([2.0, 3.0], "cm")})
    assert in_mm["plate.width [mm]"] == pytest.approx([20.0, 30.0])
    assert settings(points={"plate.width": units.Quantity([2.0, 3.0], "cm")}).keys() == {"plate.width [cm]"}


def test_each_test_may_be_said_apart(curve):
    stretch = curve[:, 0]
    card = gb.Material.from_card("neo-hooke")
    kinds = ["uniaxial", "planar", "equibiaxial"]
    noise = np.random.default_rng(4).normal(scale=2e-4, size=(3, stretch.size))
    data = [np.column_stack([stretch, card.stress(stretch, kind) + own]) for kind, own in zip(kinds, noise)]
    found = gb.fit(data, "neo-hooke", test=kinds, stress="nominal", strain="stretch")
    assert found.parameters["c10"].value == pytest.approx(card.parameters["c10"].value, rel=1e-2)
    with pytest.raises(gb.InputError, match="2 entries for 3 tests"):
        gb.fit(data, "neo-hooke", test=kinds[:2], stress="nominal", strain="stretch")


def test_bounds_have_units_and_are_checked(curve):
    found = gb.fit(curve, "neo-hooke", bounds={"c10": ("20 kPa", "60 kPa")}, **SAID)
    assert found.parameters["c10"].value == pytest.approx(0.05, rel=1e-2)
    for wrong in ((np.nan, 1.0), (1.0, 0.5), "20 kPa", (1.0,)):
        with pytest.raises(gb.InputError, match="bounds.c10"):
            gb.fit(curve, "neo-hooke", bounds={"c10": wrong}, **SAID)
    with pytest.raises(gb.InputError, match="starts"):
        gb.fit(curve, "neo-hooke", starts=-1, **SAID)


def test_fixed_parameters_are_stated(curve):
    found = gb.fit(curve, "mooney-rivlin", fixed={"c01": "2 kPa"}, **SAID)
    assert found.parameters["c01"].value == 0.002
    with pytest.raises(gb.InputError, match="fixed.c01"):
        gb.fit(curve, "mooney-rivlin", fixed={"c01": "2 mm"}, **SAID)


def test_plain_numbers_say_what_data_do_not(root, curve):
    pytest.importorskip("pint")
    forces = {"extension [mm]": 10 * (curve[:, 0] - 1), "force [N]": 8 * curve[:, 1]}
    said = dict(test="uniaxial", area=8, length=10, stress="nominal", strain="nominal")
    texts = {**said, "area": "8 mm^2", "length": "10 mm"}
    plain, own = gb.fit(forces, "neo-hooke", **said), gb.fit(forces, "neo-hooke", **texts)
    assert plain.parameters == own.parameters
    data = root / "examples/spring_dashpot.csv"
    forms = dict(stiffness="polynomial-3", damping="constant")
    told = []
    for own in ({}, {"length": "20 mm"}, {"length": 20.0}):
        try:
            told.append(json.dumps(gb.identify(data, **forms, **own).json["misfit"]))
        except gb.InputError as error:
            told.append(str(error).replace("20.0", "20"))
    assert told[1] == told[2]
