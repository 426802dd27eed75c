"""Test curves, recordings and measured fields: the figures of the command."""

import json

import gelbench as gb
import numpy as np
import pytest


def test_a_fit_has_the_commands_figures_to_the_bit(command, root, tmp_path):
    data = root / "materials/data/pva_10_uniaxial.csv"
    code, _, told = command("materials", "fit", data, "--law", "yeoh", "--name", "gel", "--output", tmp_path, cwd=root)
    assert code == 0, told
    theirs = json.loads((tmp_path / "gel.json").read_text())
    fit = gb.fit(data, "yeoh", name="gel")
    own = dict(fit.json)
    own.pop("data"), theirs.pop("data")
    assert own == theirs
    assert (tmp_path / "gel.png").read_bytes() == fit.picture
    card = gb.Material.from_card(tmp_path / "gel.toml")
    assert card.stress(1.5) == fit.material.stress(1.5)


def test_arrays_and_tables_are_fitted_alike():
    pandas = pytest.importorskip("pandas")
    truth = gb.Material.from_card("pva-10-yeoh")
    stretch = np.linspace(1.02, 1.9, 60)
    stress = truth.stress(stretch) + np.random.default_rng(0).normal(scale=2e-4, size=stretch.size)
    said = dict(test="uniaxial", stress="nominal", strain="stretch")
    array = gb.fit(np.column_stack([stretch, stress]), "yeoh", **said)
    table = gb.fit(pandas.DataFrame({"stretch [-]": stretch, "stress [MPa]": stress}), "yeoh", **said)
    assert array.parameters == table.parameters
    assert array.verdict == "white noise"
    for key, own in array.parameters.items():
        low, high = own.interval
        width = high - low
        assert low - width < truth.parameters[key].value < high + width
    assert np.sqrt(np.diag(array.covariance)) == pytest.approx([own.standard_error for own in array.parameters.values()])


def test_a_parameter_that_a_bound_holds_has_no_interval():
    stretch = np.linspace(1.02, 1.9, 60)
    stress = 0.1 * (stretch - stretch**-2) + np.random.default_rng(1).normal(scale=2e-4, size=stretch.size)
    said = dict(test="uniaxial", stress="nominal", strain="stretch", bounds={"c10": (0.06, 0.1)})
    found = gb.fit(np.column_stack([stretch, stress]), "neo-hooke", **said)
    assert found.parameters["c10"].interval is None
    assert "c10" in repr(found)


@pytest.mark.parametrize(
    "data",
    [np.ones((3, 3)), [[1.0, np.nan]] * 20, {"stretch [-]": [1.0, 1.1], "stress [MPa]": [0.0]}, "no_such_file.csv"],
)
def test_data_that_are_none_are_refused(data):
    with pytest.raises(gb.InputError):
        gb.fit(data, "yeoh", test="uniaxial", stress="nominal", strain="stretch")


def test_a_recording_is_identified_as_by_the_command(command, root, tmp_path):
    data = root / "examples/spring_dashpot.csv"
    arguments = ["--stiffness", "polynomial-3", "--damping", "constant"]
    code, _, told = command("identify", data, *arguments, "--output", tmp_path / "out", cwd=root)
    # A constant dashpot leaves the recording in doubt.
    assert code == 1, told
    theirs = json.loads((tmp_path / "out/spring_dashpot.json").read_text())
    own = dict(gb.identify(data, stiffness="polynomial-3", damping="constant").json)
    own.pop("data", None), theirs.pop("data", None)
    assert own == theirs


@pytest.fixture(scope="module")
def corrected(root):
    return gb.correct(root / "examples/measured_plate.csv", "pva-10", "2 mm", conditions=root / "examples/measured_plate.toml")


def test_measured_markers_are_corrected_as_by_the_command(command, root, tmp_path, corrected):
    code, _, told = command(
        "correct", "examples/measured_plate.csv", "--material", "pva-10", "--thickness", "2 mm",
        "--study", "examples/measured_plate.toml", "--output", tmp_path / "out", cwd=root,
    )  # fmt: skip
    assert code == 0, told
    theirs = json.loads((tmp_path / "out/report.json").read_text())
    own = dict(corrected.json)
    own.pop("times_s"), theirs.pop("times_s")
    assert own == theirs
    corrected.write(tmp_path / "own")
    for path in (tmp_path / "out").rglob("*"):
        if path.suffix in (".vtu", ".csv", ".pvd", ".py"):
            assert (tmp_path / "own" / path.relative_to(tmp_path / "out")).read_bytes() == path.read_bytes(), path


def test_a_correction_has_forces_with_intervals_and_a_verdict(corrected):
    assert corrected.explained
    force = corrected.forces["right"][0]
    assert force.interval[0] < force.value < force.interval[1]
    assert 0.2 < corrected.noise < 0.3
    assert corrected.field.displacement.shape == (len(corrected.field.points), 2)


def test_markers_in_arrays_are_those_of_the_file(root, corrected):
    pandas = pytest.importorskip("pandas")
    table = pandas.read_csv(root / "examples/measured_plate.csv", comment="#")
    table = table[table["frame"] == table["frame"].max()]
    own = gb.correct(
        table[["x [mm]", "y [mm]", "ux [mm]", "uy [mm]"]].to_numpy(), "pva-10", 2.0,
        free=["top", "bottom"], rigid=["left", "right"], robust="tukey", edge_gap=0,
    )  # fmt: skip
    assert own.forces["right"][0].value == pytest.approx(corrected.forces["right"][0].value, rel=1e-6)


def test_a_table_of_forces_in_memory_is_that_of_the_file(root):
    pandas = pytest.importorskip("pandas")
    file = root / "examples/measured_plate_forces.csv"
    table = pandas.read_csv(file, comment="#")
    kinds = [file, table, {name: table[name].to_numpy() for name in table}]
    known = dict(rigid=["left", "right"], free=["top", "bottom"], edge_gap=0, force={"right": {"x_column": "force"}})
    found = [gb.correct(root / "examples/measured_plate.csv", "pva-10", 2, forces=own, **known).json for own in kinds]
    for one in found:
        del one["times_s"]
    assert found[0]["steps"] == found[1]["steps"] == found[2]["steps"]
    measured = found[0]["steps"][-1]["corrected"]["measured_forces"]
    assert [force["measured_N"] for force in measured] == [12.87]


@pytest.mark.parametrize("scale_error", ["0.5 %", 0.005])
def test_intervals_hold_a_scale_that_is_stated(root, corrected, scale_error):
    found = gb.correct(
        root / "examples/measured_plate.csv", "pva-10", 2.0,
        free=["top", "bottom"], rigid=["left", "right"], robust="tukey", edge_gap=0, scale_error=scale_error,
    )  # fmt: skip
    own, plain = (one.forces["right"][0] for one in (found, corrected))
    assert own.value == pytest.approx(plain.value, rel=1e-6)
    assert np.diff(own.interval)[0] > 1.2 * np.diff(plain.interval)[0]


@pytest.mark.parametrize("markers", [np.ones(4), np.ones((5, 3)), np.full((30, 4), np.nan), "no_such_file.csv"])
def test_markers_that_are_none_are_refused(markers):
    with pytest.raises(gb.InputError):
        gb.correct(markers, "pva-10", 2.0, free=["top", "bottom"])


def test_a_force_that_the_field_cannot_have_is_told_and_no_interval_is_given(root):
    pandas = pytest.importorskip("pandas")
    table = pandas.read_csv(root / "examples/measured_plate.csv", comment="#")
    table = table[table["frame"] == 1].drop(columns="frame")
    found = gb.correct(
        table, "pva-10", "2 mm", free=["top", "bottom"], rigid=["left", "right"], edge_gap=0,
        force={"right": {"x": "6.5 N", "x_deviation": 0.065}},
    )  # fmt: skip
    assert not found.explained and not found.passed
    assert found.forces["right"][0].interval is None
    assert any("6.5" in doubt for doubt in found.doubts)


@pytest.mark.parametrize(
    ("data", "option", "more"),
    [
        ("ramp_and_hold.csv", "--relaxation", {"relaxation": True}),
        ("cyclic_loading.csv", "--softening", {"softening": True}),
    ],
)
def test_what_depends_on_the_history_has_the_commands_figures_to_the_bit(command, root, tmp_path, data, option, more):
    data = root / "examples" / data
    code, _, told = command(
        "materials", "fit", data, "--law", "neo-hooke", option, "--name", "gel", "--output", tmp_path, cwd=root
    )
    assert code == 0, told
    theirs = json.loads((tmp_path / "gel.json").read_text())
    fit = gb.fit(data, "neo-hooke", name="gel", **more)
    own = dict(fit.json)
    own.pop("data"), theirs.pop("data")
    assert own == theirs
    assert fit.parameters["c10"].interval is not None


def test_what_data_do_not_say_is_said_by_keywords(command, root, tmp_path):
    data = tmp_path / "cycles.csv"
    data.write_text((root / "examples/cyclic_loading.csv").read_text().replace("; cycle: all", ""))
    arguments = ["--law", "yeoh", "--cycle", "last", "--name", "gel", "--output", tmp_path]
    code, _, told = command("materials", "fit", data, *arguments, cwd=root)
    assert code == 0, told
    theirs = json.loads((tmp_path / "gel.json").read_text())
    fit = gb.fit(data, "yeoh", name="gel", cycle="last")
    own = dict(fit.json)
    own.pop("data"), theirs.pop("data")
    assert own == theirs
    with pytest.raises(gb.InputError, match="strain ratio"):
        gb.fit(data, "yeoh", strain_ration="1")
    with pytest.raises(TypeError):
        gb.fit(data)


def test_a_history_needs_a_law_and_is_of_one_kind(root):
    data = root / "examples/cyclic_loading.csv"
    with pytest.raises(gb.InputError, match="name it"):
        gb.fit(data, None, softening=True)
    with pytest.raises(gb.InputError, match="fitted together"):
        gb.fit(data, "neo-hooke", softening=True, relaxation=2)
    with pytest.raises(gb.InputError, match="number of terms"):
        gb.fit(root / "examples/ramp_and_hold.csv", "neo-hooke", relaxation=9)


@pytest.mark.parametrize(
    ("said", "told"),
    [
        ({"force": {"right": {"x": 2.88, "x_devation": 0.5}}}, "x_devation.*x, x_column, x_deviation, y"),
        ({"force": {"right": {"x_deviation": 0.5}}}, "give x too"),
        ({"force": {"right": 2.88}}, "force.right"),
        ({"known": {"left": "fixed"}}, "known.left"),
        ({"thickness": 0}, "thickness"),
        ({"thickness": "-2 mm"}, "thickness"),
    ],
)
def test_what_is_known_of_markers_is_checked_by_name(root, said, told):
    given = {"thickness": "2 mm", "free": ["top", "bottom"], "rigid": ["left", "right"], **said}
    with pytest.raises(gb.InputError, match=told):
        gb.correct(root / "examples/measured_plate.csv", "pva-10", **given)


def test_parameters_that_are_found_with_a_field_are_told(root):
    force = {"right": {"x": 6.0, "x_deviation": 0.2}}
    said = dict(free=["top", "bottom"], rigid=["left", "right"], edge_gap=0, force=force)
    pandas = pytest.importorskip("pandas")
    table = pandas.read_csv(root / "examples/measured_plate.csv", comment="#")
    last = table[table["frame"] == table["frame"].max()][["x [mm]", "y [mm]", "ux [mm]", "uy [mm]"]].to_numpy()
    one, listed = (gb.correct(last, "neo-hooke", 2, fit=fit, **said) for fit in ("c10", ["c10"]))
    found = one.parameters["c10"]
    assert found.unit == "MPa" and 0.01 < found.value < 1.0
    assert listed.parameters["c10"] == found


def test_regions_have_materials_of_their_own(tmp_path):
    mesh = tmp_path / "strip.msh"
    mesh.write_text(strip_of_two_parts())
    places = np.array([(x, y) for x in np.linspace(0, 16, 33) for y in np.linspace(0, 8, 17)])
    noise = 0.001 * np.random.default_rng(1).standard_normal(places.shape)
    moved = places * (0.4, 1.4**-0.5 - 1) + noise
    soft, stiff = (gb.Material.from_card(name) for name in ("neo-hooke", "meunier-yeoh"))
    found = gb.correct(
        np.hstack([places, moved]), soft, 0.5, mesh=mesh, free=["bottom", "top"], regions={"upper": stiff}
    )
    expected = 0.5 * 4 * sum(one.stress(np.array([1.4]))[0] for one in (soft, stiff))
    assert found.forces["right"][0].value == pytest.approx(expected, rel=2e-3)
    with pytest.raises(gb.InputError, match="no region `inclusion`"):
        gb.correct(np.hstack([places, moved]), soft, 0.5, mesh=mesh, regions={"inclusion": stiff})


def strip_of_two_parts():
    """Gmsh's file of 8 × 4 squares of 2 mm, whose lower and upper half are regions."""
    nodes = [f"{5 * i + j + 1} {2 * i} {2 * j} 0" for i in range(9) for j in range(5)]
    cells = [
        f"{4 * i + j + 1} 3 2 {1 if j < 2 else 2} 1 {5 * i + j + 1} {5 * i + j + 6} {5 * i + j + 7} {5 * i + j + 2}"
        for i in range(8)
        for j in range(4)
    ]
    names = ["2", '2 1 "lower"', '2 2 "upper"']
    parts = {"MeshFormat": ["2.2 0 8"], "PhysicalNames": names, "Nodes": ["45", *nodes], "Elements": ["32", *cells]}
    return "".join("\n".join([f"${name}", *lines, f"$End{name}", ""]) for name, lines in parts.items())


def _pattern(shift=(0.0, 0.0), stretch=1.0, size=(90, 120)):
    """Random waves that move about the middle of an image."""
    random = np.random.default_rng(3)
    y, x = np.mgrid[: size[0], : size[1]].astype(float)
    x = (x - shift[0] - size[1] / 2) / stretch
    y = y - shift[1] - size[0] / 2
    image = np.zeros(size)
    for _ in range(60):
        k = random.normal(scale=0.45, size=2)
        image += np.sin(k[0] * x + k[1] * y + random.uniform(0, 2 * np.pi))
    return np.clip(128 + 9 * image, 0, 255).round().astype(np.uint8)


def test_images_in_memory_are_followed():
    first, other = _pattern(), _pattern((1.3, -0.7), 1.02)
    tracked = gb.track([first, other], 0.1)
    found = tracked.markers.dropna()
    # Subsets that the images' rim cuts are biased by some hundredths of a pixel.
    found = found[found["x [mm]"].between(2, 10) & found["y [mm]"].between(2, 7)]
    x, deviation = found["x [mm]"].to_numpy(), found["standard_deviation [mm]"].to_numpy()
    for off in (found["ux [mm]"] - (0.13 + 0.02 * (x - 6.0)), found["uy [mm]"] - 0.07):
        assert np.abs(off / deviation).max() < 5.0 and np.sqrt(np.mean(off**2)) < 0.003
    # Fractions of white, a stack, and a mask say the same.
    again = gb.track(np.stack([first, other]) / 255.0, "0.1 mm", mask=np.ones(first.shape) - (np.indices(first.shape)[1] > 60))
    assert 10 < len(again.markers) < len(tracked.markers)
    assert "points" in repr(tracked)


def test_images_become_stress():
    pytest.importorskip("pandas")
    first, other = _pattern(), _pattern((0.0, 0.0), 1.03)
    edge = [[1.0, 1.0], [10.9, 1.0], [10.9, 7.9], [1.0, 7.9]]
    known = dict(unit=0.1, outline=edge, material="neo-hooke", thickness=1)
    # Without free edges any homogeneous stretch is in equilibrium.
    found = gb.correct(images=[first, other], **known)
    assert found.explained
    stretch = 1 + np.polyfit(found.field.points[:, 0], found.field.displacement[:, 0], 1)[0]
    assert stretch == pytest.approx(1.03, abs=1e-3)


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda a: gb.track([a], 0.1), "too few images"),
        (lambda a: gb.track(a, 0.1), r"images\[0\]"),
        (lambda a: gb.track([a, a[:40]], 0.1), "pixels"),
        (lambda a: gb.track([a, a], 0.1, subset_shape="cubic"), "subset_shape"),
        (lambda a: gb.correct(images=[a, a], unit=0.1, material="pva-10"), "thickness"),
        (lambda a: gb.correct(np.zeros((2, 9, 9)), "pva-10", 2), "images="),
        (lambda a: gb.correct(np.zeros((5, 4)), "pva-10", 2, images=[a, a]), "beside images"),
        (lambda a: gb.correct(np.zeros((5, 4)), "pva-10", 2, mesh=object()), "not a mesh"),
        (lambda a: gb.correct(np.zeros((5, 4)), "pva-10", 2, outline=[[1, 2, 3]]), "outline"),
    ],
)
def test_images_and_lines_that_are_none_are_refused(call, words):
    with pytest.raises(gb.InputError, match=words):
        call(_pattern())


def test_the_edge_of_a_mask_is_that_of_the_specimen(root):
    images = [root / "examples/gel_0.png", root / "examples/gel_1.png"]
    known = dict(images=images, unit="0.05 mm", material="pva-10", thickness=2, free=["top", "bottom"])
    # 420 × 240 pixels, y up from the centre of the lower left one; the edge of examples/gel_edge.csv.
    y, x = 0.05 * np.mgrid[239:-1:-1, 0:420]
    mask = (x > 1.0) & (x < 16.0) & (y > 1.95) & (y < 9.95)
    outlined = gb.correct(outline=root / "examples/gel_edge.csv", **known)
    masked = gb.correct(mask=mask, **known)
    assert masked.explained and masked.forces["right"][0].value == pytest.approx(outlined.forces["right"][0].value, rel=1e-3)


def test_lists_of_paths_and_arrays_without_heads_are_fitted(root, tmp_path):
    stretch = np.linspace(1.01, 1.6, 30)
    stress = 60 * (stretch - stretch**-2)
    for number in (1, 2):
        rows = np.column_stack([stretch, (1 + 1e-4 * number) * stress])
        np.savetxt(tmp_path / f"{number}.csv", rows, delimiter=",", header="stretch [-],nominal stress [kPa]", comments="")
    said = dict(law="neo-hooke", test="uniaxial")
    with pytest.raises(gb.InputError, match="given twice"):
        gb.fit([str(tmp_path / "1.csv")] * 2, **said)
    of_files = gb.fit([str(tmp_path / "1.csv"), str(tmp_path / "2.csv")], **said)
    of_array = gb.fit(np.column_stack([stretch - 1, stress]), **said, strain="nominal", stress="nominal", stress_unit="kPa")
    for found in (of_files, of_array):
        assert found.parameters["c10"].value == pytest.approx(0.03, rel=1e-3)


def test_a_mesh_of_meshio_is_that_of_a_field():
    meshio = pytest.importorskip("meshio")
    x, y = np.meshgrid(np.linspace(0, 16, 17), np.linspace(0, 8, 9), indexing="ij")
    number = np.arange(x.size).reshape(x.shape)
    quads = np.stack([number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]], axis=-1).reshape(-1, 4)
    places = np.column_stack([x.ravel(), y.ravel()])
    mesh = meshio.Mesh(np.column_stack([places, 0 * places[:, 0]]), [("quad", quads)], point_data={"displacement": places})
    markers = np.hstack([places, places * (0.4, 1.4**-0.5 - 1)])
    found = gb.correct(markers, "neo-hooke", 0.5, mesh=mesh, free=["bottom", "top"])
    expected = 0.5 * 8 * gb.Material.from_card("neo-hooke").stress(1.4)
    assert found.forces["right"][0].value == pytest.approx(expected, rel=2e-3)
    with pytest.raises(gb.InputError, match="cell_size"):
        gb.correct(markers, "neo-hooke", 0.5, cell_size=-1)
