"""Specimens: shapes, and meshes from memory."""

import json

import gelbench as gb
import numpy as np
import pytest

SUPPORTS = {"left": "clamp", "right": {"x": 18, "y": 0}}


def strip(**changes):
    given = dict(
        length=90, width=30, hole_diameter=12, thickness=2, material="pva-10", cells=8, measured="right",
        supports=SUPPORTS,
    )  # fmt: skip
    return gb.Specimen("strip-with-hole", **(given | changes))


@pytest.mark.parametrize("model", ["mass-spring", "corrected", "finite-element"])
def test_a_model_alone_has_the_commands_force_to_the_bit(command, tmp_path, model):
    # On fewer cells the command halves the finite elements' once more, to judge the corrected field.
    specimen = strip(cells=16)
    (tmp_path / "strip.toml").write_text(specimen.study([0.5, 1.0]))
    command("run", "strip.toml", "--output", "output", cwd=tmp_path)
    report = json.loads((tmp_path / "output/report.json").read_text())
    key = model.replace("-", "_")
    theirs = [step[key]["groups"]["right"]["force_N"][0] for step in report["steps"]]
    solution = specimen.solve(model, [0.5, 1.0])
    assert solution.forces.tolist() == theirs


def grid(nx=6, ny=2, size=(60.0, 20.0)):
    x, y = np.meshgrid(np.linspace(0, size[0], nx + 1), np.linspace(0, size[1], ny + 1), indexing="ij")
    number = np.arange((nx + 1) * (ny + 1)).reshape(nx + 1, ny + 1)
    cells = np.stack([number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]], axis=-1).reshape(-1, 4)
    return np.column_stack([x.ravel(), y.ravel()]), cells


def of_mesh(*mesh, **changes):
    given = dict(thickness=2, material="pva-10", supports=SUPPORTS, measured="right")
    return gb.Specimen.from_mesh(*mesh, **(given | changes))


def test_a_mesh_in_memory_is_the_strip_of_the_same_measures():
    points, cells = grid(9, 3, (90.0, 30.0))
    same = gb.Specimen("strip", length=90, width=30, thickness=2, material="pva-10", cells=4, measured="right", supports=SUPPORTS)
    own = of_mesh(points, {"quad": cells}).solve("finite-element").force
    assert own == pytest.approx(same.solve("finite-element").force, rel=1e-3)


def test_arrays_of_any_layout_make_the_same_mesh():
    points, cells = grid()
    usual = of_mesh(points, {"quad": cells}).solve("mass-spring")
    others = [
        (points.astype(">f8"), cells.astype(">i4")),
        (np.asfortranarray(points), np.asfortranarray(cells)),
        (np.column_stack([points, np.full(len(points), 3.0)])[:, :3], cells.astype(np.uint16)),
        (np.repeat(points, 2, axis=0)[::2], np.repeat(cells, 2, axis=0)[::2]),
    ]
    for own in others:
        assert np.array_equal(of_mesh(own[0], {"quad": own[1]}).solve("mass-spring").displacement, usual.displacement)


def test_groups_are_nodes_or_lines():
    points, cells = grid()
    end = np.flatnonzero(points[:, 0] == 60.0)
    lines = np.column_stack([end[:-1], end[1:]])
    supports = {"left": "clamp", "end": {"x": 18, "y": 0}}
    forces = [
        of_mesh(points, {"quad": cells}, {"end": group}, supports=supports, measured="end").solve("mass-spring").force
        for group in (end, lines)
    ]
    assert forces[0] == forces[1] == of_mesh(points, {"quad": cells}).solve("mass-spring").force


def test_meshes_of_meshio_and_pyvista_pass_straight_in():
    meshio = pytest.importorskip("meshio")
    points, cells = grid()
    usual = of_mesh(points, {"quad": cells}).solve("mass-spring")
    end = np.flatnonzero(points[:, 0] == 60.0)
    mesh = meshio.Mesh(points, [("quad", cells)], point_sets={"end": end})
    supports = {"left": "clamp", "end": {"x": 18, "y": 0}}
    own = of_mesh(mesh, supports=supports, measured="end").solve("mass-spring")
    assert np.array_equal(own.displacement, usual.displacement)
    back = usual.to_meshio()
    assert np.array_equal(back.points[:, :2], points) and np.array_equal(back.cells[0].data, cells)
    assert np.array_equal(back.point_data["displacement_mm"][:, :2], usual.displacement)
    pyvista = pytest.importorskip("pyvista")
    picture = usual.to_pyvista()
    assert isinstance(picture, pyvista.UnstructuredGrid) and picture.n_cells == len(cells)
    assert np.array_equal(of_mesh(picture).solve("mass-spring").displacement, usual.displacement)


@pytest.fixture
def gmsh():
    """The module gmsh with a strip of 60 × 20 mm, whose right side is named `end`."""
    try:
        import gmsh
    except (ImportError, OSError) as error:  # its library needs those of a desktop
        pytest.skip(f"gmsh: {error}")
    gmsh.initialize(interruptible=False)
    gmsh.option.setNumber("General.Terminal", 0)
    rectangle = gmsh.model.occ.addRectangle(0, -10, 0, 60, 20)
    gmsh.model.occ.synchronize()
    end = gmsh.model.getEntitiesInBoundingBox(59, -11, -1, 61, 11, 1, 1)
    gmsh.model.addPhysicalGroup(1, [tag for _, tag in end], name="end")
    gmsh.model.addPhysicalGroup(2, [rectangle], name="gel")
    gmsh.option.setNumber("Mesh.MeshSizeMax", 5)
    gmsh.model.mesh.generate(2)
    yield gmsh
    gmsh.finalize()


@pytest.mark.parametrize("order", [1, 2])
def test_the_model_of_gmsh_is_a_mesh_as_is_its_file(gmsh, tmp_path, order):
    gmsh.model.mesh.setOrder(order)
    gmsh.write(str(tmp_path / "strip.msh"))
    supports = {"left": "clamp", "end": {"x": 18, "y": 0}}
    solve = dict(model="finite-element", factors=[1.0])
    meshes = (gmsh, tmp_path / "strip.msh", str(tmp_path / "strip.msh"))
    in_memory, *of_files = (of_mesh(mesh, supports=supports, measured="end").solve(**solve) for mesh in meshes)
    for solution in of_files:
        assert solution.force == pytest.approx(in_memory.force, rel=1e-9)
    places = np.array([(x, y) for x in np.linspace(0, 60, 31) for y in np.linspace(-10, 10, 11)])
    markers = np.hstack([places, places * (0.4, 1.4**-0.5 - 1)])
    found = gb.correct(markers, "neo-hooke", 0.5, mesh=gmsh, free=["bottom", "top"])
    force = 0.5 * 20 * gb.Material.from_card("neo-hooke").stress(1.4)
    assert found.forces["end"][0].value == pytest.approx(force, rel=1e-3)


@pytest.mark.parametrize(
    ("change", "told"),
    [
        (lambda points, cells: (points[:, :1], {"quad": cells}), "points"),
        (lambda points, cells: (points, {"quad": cells + 1}), "no node"),
        (lambda points, cells: (points, {"quad": cells - 1}), "no node -1"),
        (lambda points, cells: (points, {"quad": cells * 1.0}), "numbers of nodes"),
        (lambda points, cells: (points, {"quad": cells[:, :3]}), "wrong number of nodes"),
        (lambda points, cells: (points, {"hexahedron": cells}), "hexahedron"),
        (lambda points, cells: (np.where(points == 60.0, np.nan, points), {"quad": cells}), "not a number"),
        (lambda points, cells: (points, {"quad": cells}, {"end": [[1, 2, 3]]}), "end"),
        (lambda points, cells: ("mesh.msh",), "mesh.msh"),
        (lambda points, cells: (cells.tolist,), "not a mesh"),
    ],
)
def test_what_is_no_mesh_is_refused_in_words(change, told):
    with pytest.raises(gb.InputError, match=told):
        of_mesh(*change(*grid())).solve("mass-spring")


def test_faults_of_supports_and_groups_are_told():
    with pytest.raises(gb.InputError, match="riht"):
        strip(supports={"left": "clamp", "riht": {"x": 1}}).solve()
    with pytest.raises(gb.InputError, match="hole_size"):
        strip(hole_size=3)


def test_a_gel_swells_between_its_grips(root):
    gel = gb.Material.from_card(root / "examples/gel.toml")
    stretch = gel.swelling_stretch
    assert stretch == pytest.approx(1.026663, abs=1e-6)
    assert gb.Material("gent", mu=0.05, jm=30).swelling_stretch == 1
    # Grips that stay where the gel was prepared, across as well: the force is that of a strip held back by 1/stretch in its plane.
    held = {axis: f"{1 / stretch - 1} * {axis.upper()}" for axis in "xy"}
    size = dict(length=100 * stretch, width=40 * stretch, thickness=2 * stretch)
    sheet = gb.Specimen("strip", **size, material=gel, cells=8, measured="right", supports={"left": held, "right": held, "bottom": held, "top": held})
    stress = gel.stress(1 / stretch, test="equibiaxial")
    force = sheet.solve("finite-element", [1.0]).forces[-1]
    assert force == pytest.approx(stress * size["width"] * size["thickness"], rel=1e-9)


def test_the_force_of_a_load_is_that_of_its_group():
    sheet = gb.Specimen(
        "strip", length=20, width=10, thickness=1, material="neo-hooke", cells=8, measured="right",
        supports={"left": "roller", "bottom-left": "clamp"}, loads={"right": {"kind": "traction", "x": 0.05}},
    )  # fmt: skip
    solution = sheet.solve("finite-element", [0.5, 1.0])
    np.testing.assert_allclose(solution.forces, [0.25, 0.5], rtol=1e-12)
    neo_hooke = gb.Material.from_card("neo-hooke")
    displacement = solution.last.groups["right"].displacement[0]
    assert neo_hooke.stress(1 + displacement / 20) == pytest.approx(0.05, rel=1e-9)
