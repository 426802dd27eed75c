"""Materials: curves of cards, and laws written in Python."""

import math
import pickle

import gelbench as gb
import numpy as np
import pytest


@pytest.fixture(scope="module")
def in_python():
    return gb.Material.from_energy(lambda i1, i2: 0.05 * (i1 - 3), name="neo-Hooke in Python")


@pytest.fixture(scope="module")
def in_rust():
    return gb.Material.from_card("neo-hooke")


def test_every_card_has_a_curve_that_begins_at_rest():
    assert "pva-10" in gb.materials() and "yeoh" in gb.laws()
    for name in gb.materials():
        material = gb.Material.from_card(name)
        assert material.stress(1.0) == pytest.approx(0.0, abs=1e-12)
        slope = (material.stress(1 + 1e-5) - material.stress(1 - 1e-5)) / 2e-5
        assert slope == pytest.approx(material.youngs_modulus, rel=1e-3), name


def test_neo_hookes_curves_are_the_textbooks(in_rust):
    c10 = in_rust.parameters["c10"].value
    stretch = np.array([[0.7, 1.0], [1.5, 2.0]])
    closed = {
        "uniaxial": stretch - stretch**-2,
        "planar": stretch - stretch**-3,
        "equibiaxial": stretch - stretch**-5,
        "shear": stretch - 1,
    }
    for test, curve in closed.items():
        assert in_rust.stress(stretch, test) == pytest.approx(2 * c10 * curve, rel=1e-12, abs=1e-15), test


def test_arrays_of_any_layout_are_taken_and_nan_stays_nan(in_rust):
    stretch = np.linspace(1.0, 2.0, 12).reshape(3, 4)
    usual = in_rust.stress(stretch)
    for other in (np.asfortranarray(stretch), stretch.astype(">f8"), np.repeat(stretch, 2, axis=1)[:, ::2], stretch.tolist()):
        assert np.array_equal(in_rust.stress(other), usual)
    assert np.isnan(in_rust.stress([1.5, np.nan])).tolist() == [False, True]


@pytest.mark.parametrize("stretch", [[0.0], [-1.0, 2.0], "soft", [[1.0], [1.0, 2.0]]])
def test_stretches_that_are_none_are_refused(in_rust, stretch):
    with pytest.raises(gb.InputError, match="stretch"):
        in_rust.stress(stretch)


def test_an_unknown_test_comes_with_the_known_ones(in_rust):
    with pytest.raises(gb.InputError, match="uniaxial, planar, equibiaxial"):
        in_rust.stress(1.5, "biaxial")


def test_a_card_with_faults_tells_all_of_them():
    with pytest.raises(gb.InputError) as caught:
        gb.Material.from_text("law = 'yeoh'\n[parameters]\nc10 = 3\n")
    assert len(caught.value.faults) > 2


def test_cards_go_through_files_and_pickles(in_rust, tmp_path):
    in_rust.save(tmp_path / "gel.toml")
    for copy in (gb.Material.from_card(tmp_path / "gel.toml"), pickle.loads(pickle.dumps(in_rust))):
        assert copy.stress(1.7) == in_rust.stress(1.7)


@pytest.mark.parametrize("model", ["mass-spring", "corrected", "finite-element"])
def test_a_law_in_python_gives_what_the_same_law_gives(in_python, in_rust, model):
    own = gb.Material.from_text(in_rust.text.replace(f"{in_rust.parameters['c10'].value}", "0.05"))
    assert own.parameters["c10"].value == pytest.approx(0.05)
    forces = [
        gb.Plate(30, 10, 2, material, cells=(6, 2), settings={"finite_element": {"cells": [12, 4]}})
        .solve(model, [0.2, 0.4])
        .forces
        for material in (in_python, own)
    ]
    assert forces[0] == pytest.approx(forces[1], rel=1e-9)


def test_parameters_are_changed_by_their_keys(in_rust):
    c10 = in_rust.parameters["c10"].value
    twice = in_rust.with_parameters(c10=2 * c10)
    assert twice.stress(1.5) == pytest.approx(2 * in_rust.stress(1.5), rel=1e-14)
    assert in_rust.with_parameters(c10=f"{1e3 * c10!r} kPa").stress(1.5) == pytest.approx(in_rust.stress(1.5))
    assert in_rust.with_parameters().stress(1.5) == in_rust.stress(1.5)
    with pytest.raises(gb.InputError, match="c10"):
        in_rust.with_parameters(c01=1.0)


def test_a_material_with_other_parameters_does_not_claim_the_source_of_the_first():
    fitted = gb.Material.from_card("treloar-ogden-3")
    assert "R²" in fitted.note and fitted.doi
    changed = fitted.with_parameters(mu_2=0.5)
    assert "treloar-ogden-3" in changed.citation and "mu_2 = 0.5" in changed.citation
    assert changed.doi == "" and changed.note == ""
    assert not any(claim in changed.text for claim in ("R²", "Treloar", "standard error", "[fit]", "refit"))
    assert fitted.with_parameters() == fitted


ENERGIES = {
    "mooney-rivlin": lambda i1, i2: 0.03 * (i1 - 3) + 0.01 * (i2 - 3),
    "gent": lambda i1: -0.5 * 0.05 * 30 * np.log1p(-(i1 - 3) / 30),
    "fung-demiray": lambda i1: 0.05 / (2 * 0.4) * np.expm1(0.4 * (i1 - 3)),
    "neo-hooke": lambda F: 0.05 * (np.trace(F.T @ F) - 3),
    "fung": lambda C: 0.01 * np.expm1(0.9 * (0.5 * (C[0, 0] - 1)) ** 2 + 0.5 * (0.5 * (C[1, 1] - 1)) ** 2
                                      + 0.6 * 0.25 * (C[0, 0] - 1) * (C[1, 1] - 1) + 0.4 * C[0, 1] ** 2),
}  # fmt: skip
CARDS = {
    "mooney-rivlin": dict(c10=0.03, c01=0.01),
    "gent": dict(mu=0.05, jm=30),
    "fung-demiray": dict(mu=0.05, b=0.4),
    "neo-hooke": dict(c10=0.05),
    "fung": dict(c=0.02, a1=0.9, a2=0.5, a3=0.3, a4=0.4, angle="0 deg"),
}


@pytest.mark.parametrize("law", ENERGIES)
def test_an_energy_in_python_is_the_law_of_the_same_energy(law):
    energy, card = gb.Material.from_energy(ENERGIES[law]), gb.Material(law, **CARDS[law])
    stretch = np.linspace(0.6, 2.0, 15)
    for test in ("uniaxial", "planar", "equibiaxial", "shear"):
        assert energy.stress(stretch, test) == pytest.approx(card.stress(stretch, test), rel=1e-8, abs=1e-12), test
    force = [gb.Plate(30, 10, 2, one, cells=(6, 2)).solve("finite-element", [0.2, 0.4]).forces for one in (energy, card)]
    assert force[0] == pytest.approx(force[1], rel=1e-9)


def test_an_energy_in_python_is_saved_pickled_and_named_by_studies(tmp_path):
    material = gb.Material.from_energy(lambda i1, i2: 0.03 * (i1 - 3) + 0.01 * np.maximum(i1 - 4, 0) ** 3, name="kinked")
    material.save(tmp_path / "kinked.toml")
    for copy in (gb.Material.from_card(tmp_path / "kinked.toml"), pickle.loads(pickle.dumps(material))):
        assert np.array_equal(copy.stress([0.7, 1.7]), material.stress([0.7, 1.7]))
    plate = gb.Plate(30, 10, 2, material, cells=(6, 2))
    plate.write_study(tmp_path / "plate.toml", [0.4])
    assert gb.run(tmp_path / "plate.toml").json["steps"] == plate.run([0.4]).json["steps"]
    swept = gb.sweep(plate, {"plate.width": "10 mm,12 mm"}, factors=[0.4])
    assert swept["corrected.force_N@0.4"][0] == pytest.approx(plate.solve("corrected", 0.4).force, rel=1e-9)


@pytest.mark.parametrize(
    ("energy", "expected"),
    [
        (lambda i1, i2: 0.05 * (i1 - 3) + 1.0, "is 1 MPa at rest"),
        (lambda i1, i2: -0.05 * (i1 - 3), "shear modulus"),
        (lambda C: 0.05 * (C[0, 0] - 1), "stress of"),
        (lambda F: 0.05 * (F[0, 0] - 1) ** 2, "turned"),
        (lambda i1, i2: 0.05 * (i1 - 3) if i1 > 3 else 0.0, "takes numpy.greater"),
        (lambda i1, i2: math.exp(i1 - 3), "module math"),
        (lambda i1, i2: np.interp(i1, [3, 9], [0, 1]), "energy"),
        (lambda i1, i2: np.arctan(i1 - 3), "numpy.arctan"),
        (lambda i1, i2: None, "returns nothing"),
        (lambda i1, i2, i3: i1, "i1, i2, i3"),
        (lambda i1: -0.5 * np.log(1 - (i1 - 3) / 5), "stretch_range"),
    ],
)
def test_what_is_no_energy_is_refused(energy, expected):
    with pytest.raises((gb.InputError, TypeError), match=expected):
        gb.Material.from_energy(energy)


@pytest.mark.parametrize("wrong", [(3.0, 0.5), (-0.5, 3.0), (0.5, np.inf), (1.0, 1.0), (1.0,), "wide", None])
def test_a_range_that_is_none_is_refused(wrong):
    with pytest.raises(gb.InputError, match="stretch_range"):
        gb.Material.from_energy(lambda i1: 0.05 * (i1 - 3), stretch_range=wrong)


def test_a_material_is_made_of_a_law_and_its_parameters():
    gent = gb.Material("gent", mu=0.05, jm=30)
    assert gent == gb.Material("gent", mu="50 kPa", jm="30") or gent.parameters == gb.Material("gent", mu="50 kPa", jm="30").parameters
    assert gent.shear_modulus == pytest.approx(0.05)
    assert gb.Material("gent", shear_modulus="50 kPa", jm=30).parameters["mu"].value == pytest.approx(0.05)
    for wrong, words in (({"mu": 0.05}, "jm"), ({"mu": -1, "jm": 3}, "greater than zero"), ({"mu": 1, "jm": 3, "x": 1}, "no parameter x")):
        with pytest.raises(gb.InputError, match=words):
            gb.Material("gent", **wrong)
    with pytest.raises(gb.InputError, match="did you mean `gent`"):
        gb.Material("gnt", mu=1)


def test_a_material_gets_more_properties_which_its_card_states_once():
    plain = gb.Material("neo-hooke", c10=0.05)
    soft = plain.with_properties(density="1020 kg/m^3", softening={"r": 2.0, "m": "0.02 MPa", "beta": 0.1})
    assert soft.stress(1.5) == plain.stress(1.5) and soft.density == pytest.approx(1.02e-9) and "[softening]" in soft.text
    with pytest.raises(gb.InputError, match="softening"):
        soft.with_properties(softening={"r": 3.0, "m": "0.02 MPa", "beta": 0.1})
    strained = plain.with_properties(volume={"poisson_ratio": 0.4})
    plates = [gb.Plate(30, 10, 2, strained, cells=(6, 2), settings={"material": {"sheet": own}}) for own in ("plane-stress", "plane-strain")]
    forces = [plate.solve("finite-element", 0.1).force for plate in plates]
    assert forces[1] > 1.05 * forces[0]
    with pytest.raises(gb.InputError, match="share"):
        plain.with_properties(viscosity={"relaxation": [{"share": 2.0, "time": "2 s"}]})
