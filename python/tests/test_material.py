"""Materials: curves of cards, and laws written in Python."""

import pickle

import gelbench as gb
import numpy as np
import pytest


def neo_hooke(i1, i2):
    return gb.Derivatives(energy=0.05 * (i1 - 3), d1=0.05)


@pytest.fixture(scope="module")
def in_python():
    return gb.Material.from_law(neo_hooke, name="neo-Hooke in Python", quiet=True)


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


def test_a_law_in_python_says_that_it_is_slow():
    with pytest.warns(gb.PerformanceWarning, match="slower"):
        gb.Material.from_law(neo_hooke)


def test_derivatives_that_are_not_those_of_the_energy_are_refused():
    def wrong(i1, i2):
        return gb.Derivatives(energy=0.05 * (i1 - 3) ** 2, d1=0.1 * (i1 - 3), d11=0.2)

    with pytest.raises(gb.InputError, match="d11 is 0.2"):
        gb.Material.from_law(wrong, quiet=True)
    with pytest.raises(gb.InputError, match="d1 has the shape"):
        gb.Material.from_law(lambda i1, i2: gb.Derivatives(0.05 * (i1 - 3), np.ones(3)), quiet=True)


def test_what_a_law_in_python_raises_comes_out_of_the_models():
    calls = 0

    def fails(i1, i2):
        nonlocal calls
        calls += 1
        if calls > 50:
            raise LookupError("no such state")
        return neo_hooke(i1, i2)

    material = gb.Material.from_law(fails, quiet=True)
    with pytest.raises(LookupError, match="no such state"):
        gb.Plate(30, 10, 2, material, cells=(6, 2)).solve("finite-element", 0.4)
    with pytest.raises(LookupError, match="no such state"):
        material.stress([1.1, 1.2])


def with_energy_at_rest(i1, i2):
    return gb.Derivatives(0.05 * (i1 - 3) + 1.0, 0.05)


def negative(i1, i2):
    return gb.Derivatives(-0.05 * (i1 - 3), -0.05)


def wrong_far_out(i1, i2):
    """The derivative stays behind the energy from stretches of about 2 on."""
    far = np.maximum(i1 - 6, 0)
    return gb.Derivatives(0.05 * (i1 - 3) + 0.01 * far**2, 0.05)


def wrong_where_both_are_stretched(i1, i2):
    far = np.maximum(i2 - 20, 0)
    return gb.Derivatives(0.05 * (i1 - 3) + 0.01 * far**2, 0.05)


@pytest.mark.parametrize(
    ("law", "told"),
    [
        (with_energy_at_rest, "energy at rest"),
        (negative, "shear modulus"),
        (wrong_far_out, "d1 is"),
        (wrong_where_both_are_stretched, "d2 is"),
        (lambda i1, i2: gb.Derivatives(-0.5 * np.log(1 - (i1 - 3) / 5), 0.5 / (5 - (i1 - 3)), d11=0.5 / (8 - i1) ** 2), "stretch_range"),
    ],
)
@pytest.mark.filterwarnings("ignore:invalid value")
def test_a_law_is_checked_over_its_whole_range_and_at_rest(law, told):
    with pytest.raises(gb.InputError, match=told):
        gb.Material.from_law(law, quiet=True)


@pytest.mark.parametrize("wrong", [(3.0, 0.5), (-0.5, 3.0), (0.5, np.inf), (1.0, 1.0), (1.0,), "wide", None])
def test_a_range_that_is_none_is_refused(wrong):
    with pytest.raises(gb.InputError, match="stretch_range"):
        gb.Material.from_law(neo_hooke, stretch_range=wrong, quiet=True)


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
