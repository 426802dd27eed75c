"""Materials and solutions that are in memory alone: studies name them rightly, and what cannot be handed over says so."""

import copy
import pickle

import gelbench as gb
import numpy as np
import pytest

SMALL = dict(length=60, width=20, thickness=2, cells=(12, 4), settings={"finite_element": {"cells": [12, 4]}})
FORCE = "corrected.force_N@0.2"


@pytest.fixture
def gel():
    own = gb.Material.from_card("neo-hooke").text.replace("neo-Hooke, C10 = 0.05 MPa (verification)", "A gel")
    return gb.Material.from_text(own.replace("[0.5, 3.0]", "[0.5, 1.3]"), name="gel")


def energy(i1, i2):
    return 0.05 * (i1 - 3)


def test_a_study_never_names_a_card_that_is_not_the_materials(gel):
    changed = gb.Material.from_card("pva-10-yeoh").with_parameters(c10=0.03)
    for material in (gel, changed):
        with pytest.raises(gb.InputError, match="write_study"):
            gb.Plate(material=material).study()
        assert 'card = "own.toml"' in gb.Plate(material=material).study(card="own.toml")
    with pytest.raises(gb.InputError, match=r"\.toml"):
        gb.Plate(material=gel).study(card="own")
    assert 'card = "neo-hooke"' in gb.Plate(material="neo-hooke").study()


def problems(material):
    strip = gb.Specimen(
        "strip", length=60, width=20, thickness=2, material=material, cells=4, measured="right",
        supports={"left": "clamp", "right": {"x": 6, "y": 0}},
    )  # fmt: skip
    return [gb.Plate(material=material, **SMALL), strip]


@pytest.mark.parametrize("number", [0, 1])
def test_the_study_that_is_written_is_computed_by_the_command_to_the_same_bits(gel, tmp_path, command, number):
    problem = problems(gel)[number]
    written = problem.write_study(tmp_path / "own.toml", [0.1, 0.2])
    assert [path.name for path in written] == ["own.toml", "own-card.toml"]
    code, _, told = command("run", "own.toml", "--output", "out", cwd=tmp_path)
    assert code in (0, 1), told
    theirs, own = gb.run(tmp_path / "own.toml").json["steps"], problem.run([0.1, 0.2]).json["steps"]
    assert own == theirs
    with pytest.raises(gb.WriteError, match="nowhere"):
        problem.write_study(tmp_path / "nowhere" / "own.toml")


def test_reports_and_warnings_are_those_of_the_material(gel):
    results = gb.Plate(material=gel, **SMALL).run([0.2, 0.5])
    assert results.title == "Clamped plate of A gel"
    assert results.json["steps"][0]["corrected"] and "pva" not in (results.markdown + " ".join(results.warnings)).lower()
    assert any("gel.toml" in warning for warning in results.warnings)
    in_python = gb.Material.from_energy(energy, name="My law", stretch_range=(0.5, 1.3))
    results = gb.Plate(material=in_python, **SMALL).run([0.2, 0.5])
    assert results.title == "Clamped plate of My law"
    assert results.warnings and "pva" not in " ".join(results.warnings)


def test_a_solution_tells_what_deserves_attention(gel):
    far = gb.Plate(material=gel, **SMALL).solve("mass-spring", [0.2, 0.5])
    assert any("gel.toml" in warning for warning in far.warnings) and "warning" in repr(far)
    assert gb.Plate(material=gel, **SMALL).solve("mass-spring", 0.2).warnings == []


def test_a_card_in_memory_is_solved_in_plane_strain_as_from_its_file(tmp_path):
    own = gb.Material.from_card("neo-hooke").text + "\n[volume]\npoisson_ratio = 0.4\n"
    (tmp_path / "gel.toml").write_text(own)
    settings = {**SMALL["settings"], "material": {"sheet": "plane-strain"}}
    cards = [gb.Material.from_text(own), gb.Material.from_card(tmp_path / "gel.toml")]
    plates = [gb.Plate(material=card, **{**SMALL, "settings": settings}) for card in cards]
    (tmp_path / "plate.toml").write_text(plates[1].study([0.1]))
    theirs = gb.run(tmp_path / "plate.toml").json["steps"]
    for plate in plates:
        assert plate.run([0.1]).json["steps"] == theirs
        solution = plate.solve("corrected", 0.1)
        assert solution.force == theirs[0]["corrected"]["force_N"]
        stretches = solution.at([30.0, 10.0]).stretches
        assert stretches[2] == pytest.approx(1.0)


def test_a_material_that_softens_runs_with_its_memory_and_is_refused_by_one_model():
    own = gb.Material.from_card("neo-hooke").text + '\n[softening]\nr = 2.0\nm = "0.02 MPa"\nbeta = 0.1\n'
    settings = {**SMALL["settings"], "corrector": {"method": "direct"}}
    plate = gb.Plate(material=gb.Material.from_text(own), **{**SMALL, "settings": settings})
    found = plate.run([0.3, 0.1, 0.3]).json["steps"]
    assert [step["at"] for step in found] == [0.3, 0.1, 0.3]
    assert found[0]["finite_element"]["force_N"] > 0
    with pytest.raises(gb.InputError, match="memory"):
        plate.solve("mass-spring", 0.3)


def test_a_card_is_read_once(tmp_path):
    path = tmp_path / "gel.toml"
    gb.Material.from_card("neo-hooke").save(path)
    plate = gb.Plate(material=path, **SMALL)
    before, study = plate.run([0.2]).json["steps"], plate.study([0.2])
    assert str(path) in study
    varied = {"plate.width": ["20 mm", "25 mm"]}
    swept = gb.sweep(plate, varied, factors=[0.2])[FORCE]
    for change in (lambda: path.write_text("changed"), path.unlink):
        change()
        assert plate.run([0.2]).json["steps"] == before
        assert np.array_equal(gb.sweep(plate, varied, factors=[0.2])[FORCE], swept)
        with pytest.raises(gb.InputError, match="changed since"):
            plate.study()
    with pytest.raises(gb.WriteError):
        plate.material.save(tmp_path / "nowhere" / "gel.toml")


@pytest.mark.parametrize(
    ("settings", "remedy"),
    [
        ({"material": {"card": "neo-hooke"}}, "material="),
        ({"load": {"stretches": ["10 %"]}}, "factors="),
        ({"plate": {"width": "3 mm"}}, "width="),
        ({"kind": "motion"}, "gelbench.run"),
    ],
)
def test_settings_of_a_plate_that_arguments_say_are_refused(settings, remedy):
    with pytest.raises(gb.InputError, match=remedy):
        gb.Plate(settings=settings)


@pytest.mark.parametrize(
    ("settings", "told"),
    [
        ({"support": [{"group": "left", "kind": "clamp"}]}, "supports="),
        ({"load": []}, "loads="),
        ({"path": {"factors": [1.0]}}, "factors="),
        ({"path": {"measured_group": "left"}}, "measured="),
        ({"path": {"foo": 3}}, "foo"),
    ],
)
def test_settings_of_a_specimen_have_an_effect_or_are_refused(settings, told):
    with pytest.raises(gb.InputError, match=told):
        gb.Specimen(
            "strip", length=60, width=20, thickness=2, material="neo-hooke", cells=4, measured="right",
            supports={"left": "clamp", "right": {"x": 6, "y": 0}}, settings=settings,
        ).solve()  # fmt: skip


def test_keys_without_a_section_are_settings_too():
    assert gb.Plate(**{**SMALL, "settings": {"title": "Mine"}}).run([0.1]).title == "Mine"


@pytest.mark.parametrize(
    ("wrong", "told"),
    [
        (lambda: gb.Plate(material=None), "material"),
        (lambda: gb.Plate(cells=12), "cells"),
        (lambda: gb.Plate(cells=(12.7, 4)), "cells"),
        (lambda: gb.Plate(settings={"title": {1, 2}.__class__}).study(), "settings"),
        (lambda: problems("neo-hooke")[1].__class__("strip", thickness=2, material="neo-hooke", measured="right",
                                                   supports={"left": None}, length=9, width=3), "supports.left"),
    ],
)  # fmt: skip
def test_arguments_that_are_none_are_named(wrong, told):
    with pytest.raises(gb.InputError, match=told):
        wrong()


def test_changed_parameters_are_a_card_that_is_saved_pickled_and_swept(tmp_path):
    card = gb.Material.from_card("pva-10-yeoh")
    changed = card.with_parameters(c10="40 kPa")
    assert changed.parameters["c10"].value == pytest.approx(0.04) and "[fit]" in card.text and "[fit]" not in changed.text
    assert changed.parameters["c20"] == card.parameters["c20"] and changed.stretch_range == card.stretch_range
    changed.save(tmp_path / "gel.toml")
    copies = [gb.Material.from_card(tmp_path / "gel.toml"), pickle.loads(pickle.dumps(changed)), copy.deepcopy(changed)]
    for own in copies:
        assert own == changed and own.stress(1.4) == changed.stress(1.4)
    table = gb.sweep(gb.Plate(material=changed, **SMALL), {"material.c10": ["0.04 MPa", "0.05 MPa"]}, factors=[0.2])
    assert table[FORCE][0] == gb.Plate(material=changed, **SMALL).run([0.2]).json["steps"][0]["corrected"]["force_N"]
    with pytest.raises(gb.InputError):
        card.with_parameters(c10=np.nan)
    with pytest.raises(gb.InputError, match="no parameter `c10`"):
        gb.Material.from_energy(energy).with_parameters(c10=1.0)


def test_materials_are_equal_where_their_cards_are():
    one, same, other = (gb.Material.from_card(name) for name in ("neo-hooke", "neo-hooke", "pva-10"))
    assert one == same and hash(one) == hash(same) and one != other and one != "neo-hooke"
    mine = gb.Material.from_energy(energy)
    assert mine == mine and mine == gb.Material.from_energy(energy) and len({mine, one, same}) == 2


def test_one_stretch_has_one_stress():
    card = gb.Material.from_card("neo-hooke")
    assert type(card.stress(1.5)) is float and card.stress([1.5]).shape == (1,)


def test_solutions_and_results_are_pickled_copied_and_saved(tmp_path):
    plate = gb.Plate(material="neo-hooke", **SMALL)
    solution, results = plate.solve("corrected", [0.1, 0.2], reference=True), plate.run([0.2])
    solution.save(tmp_path / "solution.npz"), results.save(tmp_path / "results.npz")
    copies = [pickle.loads(pickle.dumps(solution)), copy.deepcopy(solution), gb.load(tmp_path / "solution.npz")]
    for one in [*copies, pickle.loads(pickle.dumps(copies[2]))]:
        assert (one.model, len(one), one.force, one.error) == (solution.model, 2, solution.force, solution.error)
        assert (one[0].displacement == solution[0].displacement).all()
        assert (one.point_data["displacement_mm"] == solution.point_data["displacement_mm"]).all()
        assert (one.groups["right"].force == solution.groups["right"].force).all()
        assert repr(one) == repr(solution) and one._repr_html_()
    with pytest.raises(gb.InputError, match="solve it again"):
        copies[2].at([[1.0, 1.0]])
    assert copies[1].at([[1.0, 1.0]]).displacement.shape == (1, 2)
    for one in (pickle.loads(pickle.dumps(results)), gb.load(tmp_path / "results.npz")):
        assert one.json == results.json and repr(one) == repr(results)
        assert dict(one.pictures) == dict(results.pictures)
        field, own = one.fields["corrected"][0], results.fields["corrected"][0]
        assert (field.displacement == own.displacement).all() and field.cells.keys() == own.cells.keys()
        assert {path.name for path in one.write(tmp_path / f"out{id(one)}")} == {path.name for path in results.write(tmp_path / "own")}
    field = pickle.loads(pickle.dumps(results.fields["corrected"][0]))
    assert (field.points == results.fields["corrected"][0].points).all()
    with pytest.raises(gb.InputError, match="cannot be read"):
        gb.load(tmp_path / "own" / "report.json")


def test_solutions_come_from_other_processes():
    from concurrent.futures import ProcessPoolExecutor
    from multiprocessing import get_context

    plate = gb.Plate(material="neo-hooke", **SMALL)
    with ProcessPoolExecutor(1, mp_context=get_context("spawn")) as pool:
        found = pool.submit(plate.solve, "mass-spring", 0.2).result()
    assert found.force == plate.solve("mass-spring", 0.2).force


def test_errors_travel():
    strip = gb.Specimen(
        "strip", length=90, width=30, thickness=2, material="mooney-rivlin", cells=6, measured="right",
        supports={"left": "clamp", "right": {"kind": "grip", "x_force": 1e4, "y": 0}},
    )  # fmt: skip
    with pytest.raises(gb.SolveError) as caught:
        strip.solve("finite-element", 1.0)
    error = caught.value
    travelled = pickle.loads(pickle.dumps(error))
    for name in ("model", "step", "cause", "cell", "advice", "load_factor"):
        assert getattr(travelled, name) == getattr(error, name), name
    assert str(travelled) == str(error) and len(travelled.solution) == len(error.solution) == 0
    for what in ("displacement", "force", "last"):
        with pytest.raises(IndexError, match="no load factor was reached"):
            getattr(error.solution, what)
    faults = pytest.raises(gb.InputError, gb.Plate, width="5 kg").value
    assert pickle.loads(pickle.dumps(faults)).faults == faults.faults


def test_what_a_state_has_a_solution_has_too():
    solution = gb.Plate(material="neo-hooke", **SMALL).solve("corrected", [0.1, 0.2])
    own = {name for name in vars(gb.State) if not name.startswith("_")} - {"factor", "solution"}
    assert own <= {name for name in vars(gb.Solution)}
    assert solution.energy == solution.last.energy and set(solution.groups) == {"left", "right"}


def test_messages_name_arguments_where_the_command_names_options():
    stretch = np.linspace(1.0, 2.0, 12)
    with pytest.raises(gb.InputError) as caught:
        gb.fit({"force [N]": stretch, "displacement [mm]": stretch}, "yeoh", test="uniaxial")
    assert 'give length="2 mm"' in str(caught.value) and "--" not in str(caught.value)
    assert all("--" not in f"{fault} {fault.hint}" for fault in caught.value.faults)
    with pytest.raises(gb.InputError, match='give test="uniaxial"'):
        gb.fit({"stretch": stretch, "nominal stress [MPa]": stretch}, "yeoh")


def test_a_copy_is_a_sheet_of_its_own():
    plate = gb.Plate(material="neo-hooke", **{**SMALL, "thickness": 1})
    other = copy.copy(plate)
    other.thickness = 3
    assert (plate.thickness, other.thickness) == (1, 3) and isinstance(plate.cells, tuple)
    with pytest.raises(AttributeError, match="no attribute thicknes"):
        plate.thicknes = 3
    ring = gb.Specimen(
        "ring-sector", inner_radius=10, outer_radius=20, angle="90 deg", thickness=1, material="neo-hooke", cells=4,
        supports={"start": "clamp", "end": {"x": 1, "y": 0}}, measured="end",
    )  # fmt: skip
    assert ring.angle == pytest.approx(np.pi / 2)
    ring.angle = 1.5
    assert ring.angle == 1.5


def test_pickled_arrays_are_read_only_and_files_are_named_by_their_kind(tmp_path):
    solution = gb.Plate(material="neo-hooke", **SMALL).solve(factors=0.1)
    with pytest.raises(ValueError, match="read-only"):
        pickle.loads(pickle.dumps(solution)).displacement[:] = 0
    for name in ("s.vtk", "s.csv"):
        with pytest.raises(gb.InputError, match="another kind"):
            solution.save(tmp_path / name)
    with pytest.raises(gb.WriteError):
        solution.save(tmp_path / "none" / "s.npz")
    solution.save(tmp_path / "s.npz")
    whole = (tmp_path / "s.npz").read_bytes()
    np.savez(tmp_path / "foreign.npz", x=np.zeros(3))
    for content in (b"", whole[: len(whole) // 2], (tmp_path / "foreign.npz").read_bytes()):
        (tmp_path / "wrong.npz").write_bytes(content)
        with pytest.raises(gb.InputError, match="save has written"):
            gb.load(tmp_path / "wrong.npz")


@pytest.mark.parametrize(
    ("call", "told"),
    [
        (lambda: gb.Plate(thickness=True), "thickness"),
        (lambda: gb.Plate(settings="gauss"), "settings"),
        (lambda: gb.Plate(cells=(6, 2)).solve(None), "model"),
        (lambda: gb.Material("yeoh", c10=1, c20=0), "^c30: is missing \\(add c30=…\\)$"),
        (lambda: gb.Material("neo-hooke", c10=1).with_properties(viscosity="5 Pa*s"), "viscosity"),
        (lambda: gb.run(None), "give the path of a study"),
        (lambda: gb.track(None, 1), "images"),
        (lambda: gb.track([np.eye(60), np.eye(60)], -1), "greater than zero"),
        (lambda: gb.Plate(thickness="thin", settings={"title": ""}), "^(?!.*thin sheet)"),
    ],
)
def test_what_is_no_argument_is_refused_by_its_name(call, told):
    with pytest.raises(gb.InputError, match=told):
        call()


def test_one_model_warns_as_the_study_does():
    gel = gb.Material("neo-hooke", c10=0.05).with_properties(viscosity={"relaxation": {"share": 0.3, "time": "2 s"}})
    plate = gb.Plate(material=gel, **SMALL)
    viscous = [one for one in plate.run(0.1).warnings if "viscosity" in one]
    assert viscous and set(viscous) <= set(plate.solve(factors=0.1).warnings)
