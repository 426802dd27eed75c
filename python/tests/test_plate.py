"""Plates: the figures of the command, the exceptions, progress and interruption."""

import json
import signal
import subprocess
import sys
import textwrap
import threading
import time

import gelbench as gb
import numpy as np
import pytest

SMALL = {"cells": (12, 4), "settings": {"finite_element": {"cells": [24, 8]}}}


@pytest.fixture(scope="module")
def plate():
    return gb.Plate(60, 20, 2, "pva-10", **SMALL)


@pytest.fixture(scope="module")
def reports(plate, command, tmp_path_factory):
    """What the command makes of the plate's study."""
    folder = tmp_path_factory.mktemp("plate")
    (folder / "plate.toml").write_text(plate.study([0.2, 0.5]))
    command("run", "plate.toml", "--output", "output", cwd=folder)
    return folder / "output"


def without_times(report):
    return {key: value for key, value in report.items() if key not in ("times_s", "name")}


@pytest.mark.parametrize("model", ["mass-spring", "corrected", "finite-element"])
def test_a_model_alone_has_the_commands_forces_and_fields_to_the_bit(plate, reports, model):
    meshio = pytest.importorskip("meshio")
    report = json.loads((reports / "report.json").read_text())
    solution = plate.solve(model, [0.2, 0.5])
    key = model.replace("-", "_")
    for number, (state, step) in enumerate(zip(solution, report["steps"]), 1):
        assert state.factor == step["at"]
        assert state.force == step[key]["force_N"]
        assert state.energy == step[key]["energy_mJ"]
        written = meshio.read(reports / "vtk" / f"{key}_{number:03}.vtu")
        assert np.array_equal(written.points[:, :2], solution.points)
        assert np.array_equal(written.point_data["displacement_mm"][:, :2], state.displacement)
        name = "von_mises_stress_at_nodes_MPa"
        # What follows from the displacements is written in single precision.
        assert np.array_equal(written.point_data[name], state.point_data[name].astype(np.float32))


def test_all_models_together_give_the_commands_report(plate, reports):
    report = json.loads((reports / "report.json").read_text())
    results = plate.run([0.2, 0.5])
    assert without_times(results.json) == without_times(report)
    assert results.passed == report["passed"]
    # The result comes first.
    title, _, table = repr(results).split("\n", 2)
    assert title.startswith(results.title)
    force = f"{report['steps'][0]['finite_element']['force_N']:.4f}"
    assert force in table.split("deviation from")[0]


def test_a_model_alone_warns_as_all_models_do():
    """A sheet as thin as a foil wrinkles."""
    foil = gb.Plate(60, 20, 0.005, "neo-hooke", **SMALL)
    wrinkles = [told for told in foil.run([0.5]).warnings if "wrinkl" in told]
    assert wrinkles
    assert [told for told in foil.solve("finite-element", [0.5]).warnings if "wrinkl" in told] == wrinkles


def test_errors_are_those_of_the_report(plate, reports):
    report = json.loads((reports / "report.json").read_text())
    state = plate.solve("corrected", [0.2, 0.5], reference=True)[1]
    assert state.error["departure_percent"] == report["steps"][1]["corrected"]["departure_percent"]


def test_a_study_file_gives_the_files_of_the_command(reports, tmp_path):
    results = gb.run(reports.parent / "plate.toml")
    results.write(tmp_path / "own")
    own = {path.relative_to(tmp_path / "own") for path in (tmp_path / "own").rglob("*") if path.is_file()}
    theirs = {path.relative_to(reports) for path in reports.rglob("*") if path.is_file()}
    assert {str(path) for path in own ^ theirs} <= {".gelbench-manifest.json"}
    for path in own:
        if path.suffix in (".vtu", ".pvd", ".png", ".py"):
            assert (tmp_path / "own" / path).read_bytes() == (reports / path).read_bytes(), path


def test_quantities_may_have_units(plate):
    pint = pytest.importorskip("pint")
    units = pint.UnitRegistry()
    same = gb.Plate("6 cm", 2 * units.cm, units.Quantity(0.002, "m"), gb.Material.from_card("pva-10"), **SMALL)
    force = plate.solve("mass-spring", [0.5]).force
    assert same.solve("mass-spring", ["50 %"]).force == pytest.approx(force, rel=1e-12)


def test_states_are_asked_at_points(plate):
    state = plate.solve("finite-element", 0.5).last
    at = state.at([[30.0, 10.0], [60.0, 5.0]])
    assert at.displacement[1] == pytest.approx([30.0, 0.0], abs=1e-12)
    assert at.displacement[0, 1] == pytest.approx(0.0, abs=1e-9)
    assert at.stretches[0].prod() == pytest.approx(1.0, rel=1e-12)
    assert state.at([30.0, 10.0]).stress.shape == (3,)
    with pytest.raises(gb.InputError, match="not on the sheet"):
        state.at([61.0, 5.0])
    for wrong in ([[1.0, 2.0, 3.0]], [[np.nan, 1.0]]):
        with pytest.raises(gb.InputError, match="points"):
            state.at(wrong)


def test_supports_hold_what_the_grip_pulls(plate):
    groups = plate.solve("finite-element", 0.5).last.groups
    assert groups["left"].force == pytest.approx(-groups["right"].force, rel=1e-9, abs=1e-9)
    assert groups["right"].displacement == pytest.approx([30.0, 0.0])


def test_fields_are_the_librarys_memory_and_read_only(plate):
    solution = plate.solve("mass-spring", 0.5)
    first, second = solution.displacement, solution.displacement
    assert np.shares_memory(first, second)
    with pytest.raises(ValueError, match="read-only"):
        first[0, 0] = 1.0
    del solution
    assert np.isfinite(second).all()


def test_all_faults_are_told_at_once_with_their_keys():
    with pytest.raises(gb.InputError) as caught:
        gb.Plate(-150, "5 kg", 2)
    keys = {fault.key for fault in caught.value.faults}
    assert keys == {"plate.length", "plate.width"}
    assert all(fault.hint and fault.line for fault in caught.value.faults)


@pytest.mark.parametrize("factors", [[0.5, 0.2], [np.nan], [[0.1, 0.2]], [], ["half"]])
def test_factors_that_are_none_are_refused(plate, factors):
    with pytest.raises(gb.InputError):
        plate.solve(factors=factors)


def test_arrays_of_any_kind_are_factors(plate):
    usual = plate.solve("mass-spring", [0.2, 0.5]).forces
    others = [np.array([0.2, 9.0, 0.5])[::2], np.array([0.2, 0.5], dtype=">f8"), (0.2, 0.5), ["20 %", 0.5]]
    for other in others:
        assert np.array_equal(plate.solve("mass-spring", other).forces, usual)


def test_unknown_names_come_with_the_known_ones(plate):
    with pytest.raises(gb.InputError, match="mass-spring, corrected, finite-element"):
        plate.solve("springs")
    with pytest.raises(gb.InputError, match="pva-10"):
        gb.Material.from_card("pva-11")


def test_a_path_that_ends_tells_where_why_and_what_was_reached():
    strip = gb.Specimen(
        "strip", length=90, width=30, thickness=2, material="mooney-rivlin", cells=6, measured="right",
        supports={"left": "clamp", "right": {"kind": "grip", "x_force": 1e4, "y": 0}},
    )  # fmt: skip
    with pytest.raises(gb.SolveError) as caught:
        strip.solve("finite-element", [1e-5, 1.0])
    error = caught.value
    assert error.load_factor == 1.0 and error.model.startswith("finite elements")
    assert error.cause and error.advice and error.step.startswith("load factor 1")
    assert str(error).endswith(error.cause)
    assert len(error.solution) == 1 and error.solution.factors[0] == 1e-5


def test_progress_is_told_and_may_stop_the_computation(plate):
    told = []
    plate.solve("mass-spring", [0.2, 0.5], progress=told.append)
    assert told == ["mass-spring, 20 % stretch", "mass-spring, 50 % stretch"]

    def stop(what):
        raise LookupError(what)

    with pytest.raises(LookupError, match="20 % stretch"):
        plate.solve("mass-spring", [0.2, 0.5], progress=stop)


def test_bars_of_tqdm_move(plate):
    tqdm = pytest.importorskip("tqdm")
    with tqdm.tqdm(disable=False, file=open("/dev/null", "w")) as bar:
        plate.solve("mass-spring", [0.2, 0.5], progress=bar)
    assert bar.n == 2


def test_other_threads_go_on_while_a_model_is_solved(counted_meanwhile):
    large = gb.Plate(cells=(120, 40))
    assert counted_meanwhile(lambda: large.solve("mass-spring", [0.5])) > 10


def test_threads_solve_side_by_side(plate):
    forces = []
    workers = [threading.Thread(target=lambda: forces.append(plate.solve("corrected", 0.5).force)) for _ in range(4)]
    for worker in workers:
        worker.start()
    for worker in workers:
        worker.join()
    assert len(set(forces)) == 1 and len(forces) == 4


@pytest.mark.skipif(sys.platform == "win32", reason="signals")
def test_an_interrupt_stops_the_computation_at_once():
    program = """
        import signal, gelbench as gb
        # A job in the background is started with interrupts ignored.
        signal.signal(signal.SIGINT, signal.default_int_handler)
        print("begun", flush=True)
        try:
            gb.Plate(cells=(300, 100)).solve("mass-spring", [0.01 * n for n in range(1, 100)])
        except KeyboardInterrupt:
            print("stopped", flush=True)
    """
    process = subprocess.Popen([sys.executable, "-c", textwrap.dedent(program)], stdout=subprocess.PIPE, text=True)
    assert process.stdout.readline() == "begun\n"
    time.sleep(1.0)
    start = time.monotonic()
    process.send_signal(signal.SIGINT)
    assert process.communicate(timeout=60)[0] == "stopped\n"
    assert process.returncode == 0
    assert time.monotonic() - start < 20.0


def test_ten_thousand_calls_leave_nothing_behind():
    resource = pytest.importorskip("resource")
    material = gb.Material.from_card("pva-10")
    stretch = np.linspace(1.0, 2.0, 100)
    tiny = gb.Plate(15, 5, 2, material, cells=(4, 2), settings={"finite_element": {"cells": [8, 4]}})

    def calls(count):
        for _ in range(count):
            material.stress(stretch)
        for _ in range(count // 100):
            solution = tiny.solve("mass-spring", 0.1)
            assert solution.displacement.shape == (15, 2)
            with pytest.raises(gb.InputError):
                tiny.solve("mass-spring", -2.0)
        return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss

    before = calls(1_000)
    assert calls(10_000) - before < 4_000  # kB


def test_what_is_assigned_to_a_plate_has_an_effect_or_is_refused():
    plate = gb.Plate(30, 10, 2, "neo-hooke", cells=(6, 2))
    plate.thickness = "0.1 cm"
    assert (plate.thickness, plate.length, plate.cells) == (1.0, 30.0, (6, 2))
    with pytest.raises(gb.InputError, match="width"):
        plate.width = -3
    assert plate.width == 10.0
    plate.thickness = 2
    for name, told in (("cells", "create another Plate"), ("factors", "no attribute factors")):
        with pytest.raises(AttributeError, match=told):
            setattr(plate, name, 99)
    soft = plate.solve("mass-spring", 0.2).force
    c10 = plate.material.parameters["c10"].value
    plate.material = plate.material.with_parameters(c10=2 * c10)
    assert plate.solve("mass-spring", 0.2).force == pytest.approx(2 * soft, rel=1e-6)
    plate.material = "pva-10"
    assert plate.material.name == "pva-10"
