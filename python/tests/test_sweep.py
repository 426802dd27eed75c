"""Many runs: the command's table to the bit, resume, interruption, parts, points, and tables of other programs."""

import io
import json
import os
import pickle
import signal
import subprocess
import sys
import textwrap
import time

import gelbench as gb
import numpy as np
import pytest

STUDY = """\
title = "small"
[plate]
cells = [12, 4]
[material]
card = "neo-hooke"
[load]
stretches = ["10 %", "20 %"]
[finite_element]
cells = [12, 4]
"""
VARIED = {"material.c10": "0.05..0.1 MPa", "plate.width": ["45 mm", "50 mm"]}
FORCE = "corrected.force_N@0.2"


@pytest.fixture
def study(tmp_path):
    path = tmp_path / "s.toml"
    path.write_text(STUDY)
    return path


@pytest.fixture(scope="module")
def table(tmp_path_factory):
    path = tmp_path_factory.mktemp("sweep") / "s.toml"
    path.write_text(STUDY)
    return gb.sweep(path, VARIED, samples=12)


def text(table):
    return table._core.csv()


def small_plate(material):
    settings = {"finite_element": {"cells": [12, 4]}, "output": {"report": False}}
    return gb.Plate(60, 20, 2, material, cells=(12, 4), settings=settings)


def test_a_sweep_has_the_commands_files_to_the_bit(study, command):
    vary = ["--vary", "material.c10=0.05..0.1 MPa", "--vary", "plate.width=45 mm,50 mm", "--samples", "12"]
    code, _, told = command("sweep", "s.toml", *vary, "--output", "theirs", cwd=study.parent)
    assert code == 0, told
    table = gb.sweep(study, VARIED, samples=12, output=study.parent / "own")
    theirs, own = study.parent / "theirs", study.parent / "own"
    assert {path.name for path in table.files} == {path.name for path in theirs.iterdir()} - {".gelbench-manifest.json"}
    for path in table.files:
        if path.suffix in (".csv", ".json", ".png", ".md"):
            assert path.read_bytes() == (theirs / path.name).read_bytes(), path.name
    assert text(table) == (own / "sweep.csv").read_bytes()
    assert table.json == json.loads((theirs / "sweep.json").read_text())


def test_arrays_are_the_columns_of_the_table(table):
    pandas = pytest.importorskip("pandas")
    read = pandas.read_csv(io.BytesIO(text(table)))
    assert list(table.columns) == list(read.columns)
    for name, column in table.columns.items():
        # Pandas reads empty texts as numbers that are missing.
        if name not in ("fault", "warnings"):
            assert np.array_equal(np.asarray(column), read[name].to_numpy()), name
    assert table.to_pandas().shape == (24, len(read.columns))
    assert table["material.c10"] is table["material.c10 [MPa]"]
    with pytest.raises(KeyError):
        table["material.c01"]


def test_forces_are_those_of_single_plates_and_proportional_to_stiffness(table):
    force, stiffness = np.asarray(table[FORCE]), np.asarray(table["material.c10"])
    for half in (slice(0, 12), slice(12, 24)):
        assert np.ptp(force[half] / stiffness[half]) < 1e-9 * force[0] / stiffness[0]
    single = gb.sweep(gb.Plate(cells=(12, 4), material="neo-hooke"), {"plate.width": "45 mm,50 mm"}, factors=[0.2])
    alone = gb.Plate(width=45, cells=(12, 4), material="neo-hooke").run([0.2])
    assert single[FORCE][0] == alone.json["steps"][0]["corrected"]["force_N"]


def test_bands_are_quantiles_of_the_runs(table):
    at, forces = table.along("corrected.force_N")
    band = table.band("corrected.force_N")
    assert at.tolist() == [0.1, 0.2] == band.at.tolist() and forces.shape == (24, 2)
    for own, share in [(band.low, 0.05), (band.median, 0.5), (band.high, 0.95)]:
        assert own == pytest.approx(np.quantile(forces, share, axis=0), rel=1e-12)
    assert band.runs.tolist() == [24, 24]
    with pytest.raises(gb.InputError, match="corrected.force_N"):
        table.band("force")


def test_a_fit_is_drawn_with_its_covariance():
    stretch = np.linspace(1.05, 2.0, 12)
    noise = 1 + 0.01 * np.random.default_rng(1).standard_normal(12)
    curve = np.column_stack([stretch, gb.Material.from_card("neo-hooke").stress(stretch) * noise])
    fit = gb.fit(curve, law="neo-hooke", test="uniaxial", stress="nominal", strain="stretch")
    plate = small_plate(fit.material)
    drawn = gb.SweepPlan(plate, fit=fit, samples=1024).settings["material.c10 [MPa]"]
    own = fit.parameters["c10"]
    assert np.mean(drawn) == pytest.approx(own.value, rel=1e-3)
    # Normal draws have the interval of Student's t.
    assert own.interval is not None
    low, high = own.interval
    assert np.std(drawn, ddof=1) == pytest.approx((high - low) / (2 * 1.96), rel=0.02)
    table = gb.sweep(plate, fit=fit, samples=4, factors=[0.2])
    mean = plate.run([0.2]).json["steps"][0]["corrected"]["force_N"]
    assert table[FORCE] == pytest.approx(mean * table["material.c10"] / own.value, rel=1e-9)


def test_points_of_ones_own_are_run_and_the_command_takes_them_too(study, command):
    points = {"material.c10 [MPa]": np.array([0.05, 0.08, 0.06]), "plate.width [mm]": [45.0, 50.0, 40.0]}
    table = gb.sweep(study, points=points)
    assert np.array_equal(table["material.c10"], points["material.c10 [MPa]"])
    (study.parent / "points.csv").write_text("material.c10 [MPa],plate.width [mm]\n0.05,45\n0.08,50\n0.06,40\n")
    code, _, told = command("sweep", "s.toml", "--points", "points.csv", "--output", "theirs", cwd=study.parent)
    assert code == 0, told
    assert (study.parent / "theirs/sweep.csv").read_bytes() == text(table)
    for wrong, expected in [
        ({"plate.width [mm]": [45.0, np.nan]}, "not a number"),
        ({"plate.width [mm]": [45.0], "plate.length [mm]": [1.0, 2.0]}, "has 2 values"),
        ({"plate.width": [45.0]}, "unit"),
        ({}, "no points"),
    ]:
        with pytest.raises(gb.InputError, match=expected):
            gb.sweep(study, points=wrong)
    with pytest.raises(gb.InputError, match="others are to be drawn"):
        gb.sweep(study, {"plate.length": "1..2 mm"}, points=points, samples=4)


def test_parts_by_themselves_and_in_a_folder_are_the_whole(study, table):
    plan = pickle.loads(pickle.dumps(gb.SweepPlan(study, VARIED, samples=12)))
    assert len(plan) == 24
    parts = [pickle.loads(pickle.dumps(plan.part(part, 5))) for part in range(1, 6)]
    assert text(plan.join(parts[::-1])) == text(table)
    with pytest.raises(gb.InputError, match="not those of this sweep"):
        plan.join(parts[1:])
    folder = study.parent / "parts"
    with pytest.raises(gb.InputError, match="missing parts of 2: 1, 2"):
        plan.run(output=folder, join=2)
    for part in (1, 2):
        gb.sweep(study, VARIED, samples=12, output=folder, shard=(part, 2))
    assert text(gb.sweep(study, VARIED, samples=12, output=folder, join=2)) == text(table)
    with pytest.raises(gb.InputError, match="no part 3 of 2"):
        plan.part(3, 2)


def test_runs_without_a_solution_stand_in_the_table(study):
    table = gb.sweep(study, {"mass_spring.max_iterations": [1, 40]})
    assert "no convergence" in table.faults[0] and not table.faults[1]
    assert np.isnan(table["mass_spring.force_N@0.2"][0]) and np.isfinite(table["mass_spring.force_N@0.2"][1])
    assert table["finite_element.force_N@0.2"][0] == table["finite_element.force_N@0.2"][1]
    assert "1 without a solution" in repr(table)


@pytest.mark.parametrize(
    ("arguments", "expected"),
    [
        ({}, "nothing is varied"),
        ({"parameters": {"plate.lenght": ["1 mm", "2 mm"]}}, "did you mean `length`"),
        ({"parameters": {"material.c10": "0.05+-0.01 MPa"}}, "samples"),
        ({"parameters": {"plate.width": []}}, "there are no values"),
        ({"parameters": {"plate.width": [None]}}, "not a value of a key"),
        ({"parameters": {"plate.width": "45 mm,50 mm"}, "method": "halton"}, "sobol, random"),
        ({"parameters": {"plate.width": "45 mm,50 mm"}, "join": 3}, "output="),
        ({"parameters": {"plate.width": "45 mm,50 mm"}, "factors": [0.5]}, "states its own"),
    ],
)
def test_what_is_amiss_is_told(study, arguments, expected):
    with pytest.raises(gb.InputError, match=expected):
        gb.sweep(study, **arguments)


def test_plain_numbers_are_in_the_units_of_the_sheet():
    plate = small_plate("neo-hooke")
    plain = gb.SweepPlan(plate, {"plate.width": [45, 50], "material.c10": [0.05]})
    assert list(plain.settings) == ["plate.width [mm]", "material.c10 [MPa]"]
    points = gb.SweepPlan(plate, points={"plate.width": [45.0, 50.0], "material.c10": [0.05, 0.06]})
    assert list(points.settings) == ["plate.width [mm]", "material.c10 [MPa]"] and len(points) == 2


def test_quantities_of_pint_are_values(study):
    units = pytest.importorskip("pint").UnitRegistry()
    plan = gb.SweepPlan(study, {"plate.width": [45 * units.mm, 50 * units.mm], "material.c10": [0.05 * units.MPa]})
    assert list(plan.settings) == ["plate.width [mm]", "material.c10 [MPa]"]


def test_progress_is_told_of_each_run_and_may_stop_the_sweep(study):
    told = []
    gb.sweep(study, {"plate.width": "45..50 mm:5"}, progress=told.append)
    assert sorted(told) == [f"run {number}" for number in range(1, 6)]

    def stop(what):
        raise LookupError(what)

    output = study.parent / "out"
    with pytest.raises(LookupError, match="run"):
        gb.sweep(study, {"plate.width": "45..50 mm:5"}, progress=stop, output=output)
    kept = [path for path in output.glob(".*/.parts/*") if path.suffix != ".new"]
    assert kept, "the run that ended before is kept"
    told.clear()
    table = gb.sweep(study, {"plate.width": "45..50 mm:5"}, progress=told.append, output=output)
    assert sorted(told) == [f"run {number}" for number in range(1, 6)] and len(table) == 5


def test_other_threads_go_on_meanwhile(study, counted_meanwhile):
    assert counted_meanwhile(lambda: gb.sweep(study, VARIED, samples=12)) > 10


PROGRAM = """
    import signal, gelbench as gb
    # A job in the background is started with interrupts ignored.
    signal.signal(signal.SIGINT, signal.default_int_handler)
    print("begun", flush=True)
    try:
        gb.sweep("s.toml", {"material.c10": "0.05..0.1 MPa", "plate.width": ["45 mm", "50 mm"]}, samples=12,
                 output="out", progress=lambda what: print(what, flush=True))
        print("ended", flush=True)
    except KeyboardInterrupt:
        print("stopped", flush=True)
"""


@pytest.mark.skipif(sys.platform == "win32", reason="signals")
@pytest.mark.parametrize("sent", [signal.SIGKILL, signal.SIGINT] if sys.platform != "win32" else [])
def test_a_sweep_goes_on_after_a_kill_and_after_an_interrupt(study, table, sent):
    def start():
        program = [sys.executable, "-c", textwrap.dedent(PROGRAM)]
        return subprocess.Popen(program, cwd=study.parent, stdout=subprocess.PIPE, text=True)

    process = start()
    for _ in range(4):
        process.stdout.readline()
    process.send_signal(sent)
    left = process.communicate(timeout=60)[0]
    assert "ended" not in left and ("stopped" in left) == (sent == signal.SIGINT)
    out = study.parent / "out"
    kept = {path.name for path in out.glob(".*/.parts/*") if path.suffix != ".new"}
    assert 3 <= len(kept) < 24 and not (out / "sweep.csv").exists()
    times = {path.name: path.stat().st_mtime_ns for path in out.glob(".*/.parts/*")}
    process = start()
    process.stdout.readline()
    first = [process.stdout.readline().split()[1] for _ in kept]
    assert set(first) == kept, "what is there is told first, and not computed again"
    assert process.communicate(timeout=60)[0].endswith("ended\n")
    assert times and (out / "sweep.csv").read_bytes() == text(table)


def test_tables_are_written_as_csv_and_parquet_and_never_half(table, tmp_path, monkeypatch):
    table.to_csv(tmp_path / "t.csv")
    assert (tmp_path / "t.csv").read_bytes() == text(table)
    parquet = pytest.importorskip("pyarrow.parquet")
    table.to_parquet(tmp_path / "t.parquet")
    read = parquet.read_table(tmp_path / "t.parquet")
    assert read.column_names == list(table.columns) and read.num_rows == 24
    for name, values in table.figures.items():
        assert np.array_equal(read[name].to_numpy(), values, equal_nan=True), name

    def broken(*arguments):
        arguments[1].write_bytes(b"half")
        raise OSError("no space left")

    monkeypatch.setattr(parquet, "write_table", broken)
    before = (tmp_path / "t.parquet").read_bytes()
    with pytest.raises(gb.WriteError, match="no space left"):
        table.to_parquet(tmp_path / "t.parquet")
    assert (tmp_path / "t.parquet").read_bytes() == before
    assert {path.name for path in tmp_path.iterdir()} == {"t.csv", "t.parquet"}


def test_figures_that_a_run_has_not_are_null_in_parquet(study):
    parquet = pytest.importorskip("pyarrow.parquet")
    table = gb.sweep(study, {"mass_spring.max_iterations": [1, 40], "material.card": ["neo-hooke"]})
    table.to_parquet(study.parent / "t.parquet")
    read = parquet.read_table(study.parent / "t.parquet")
    assert read["mass_spring.force_N@0.2"].null_count == 1
    assert read["material.card"].to_pylist() == ["neo-hooke"] * 2


def test_a_table_is_drawn(table):
    pytest.importorskip("matplotlib").use("Agg")
    axes = table.plot("corrected.force_N", "mass_spring.force_N")
    assert len(axes.lines) == 2 and axes.get_ylabel() == "force [N]"
    assert "<img" in table._repr_html_() and set(table.pictures) >= {"band.png", "force_over_material_c10.png"}


def test_salib_finds_the_variance_that_is_known():
    """A linear law: the force is proportional to c₁₀ t w at small strain of a wide sheet, so indices follow from the product."""
    pytest.importorskip("SALib")
    from SALib.analyze import sobol as analyse
    from SALib.sample import sobol as sample

    varied = {"material.c10": "0.05+-0.005 MPa", "plate.thickness": "1.8..2.2 mm"}
    problem = gb.salib_problem(varied)
    assert problem["dists"] == ["norm", "unif"] and problem["names"] == ["material.c10 [MPa]", "plate.thickness [mm]"]
    chosen = sample.sample(problem, 128, seed=1)
    settings = {"finite_element": {"cells": [8, 4]}, "output": {"report": False}}
    plate = gb.Plate(40, 20, 2, "neo-hooke", cells=(6, 4), settings=settings)
    table = gb.sweep(plate, points=dict(zip(problem["names"], chosen.T)), factors=[0.2])
    found = analyse.analyze(problem, np.asarray(table[FORCE]), seed=1)
    # F = a c t, c and t independent: V = a² (c̄² σt² + t̄² σc² + σc² σt²).
    c, t = (0.05, 0.005), (2.0, 0.4 / np.sqrt(12))
    alone = np.array([(t[0] * c[1]) ** 2, (c[0] * t[1]) ** 2])
    both = (c[1] * t[1]) ** 2
    assert found["S1"] == pytest.approx(alone / (alone.sum() + both), abs=0.05)
    assert found["ST"] == pytest.approx((alone + both) / (alone.sum() + both), abs=0.05)
    with pytest.raises(gb.InputError, match="not a distribution"):
        gb.salib_problem({"plate.width": "45 mm,50 mm"})


def test_dask_computes_a_sweep_again_where_a_worker_was_killed(study, table, tmp_path):
    distributed = pytest.importorskip("distributed")
    plan = gb.SweepPlan(study, VARIED, samples=12)
    marks = tmp_path / "marks"
    marks.mkdir()
    with (
        distributed.LocalCluster(
            n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None, local_directory=str(tmp_path)
        ) as cluster,
        distributed.Client(cluster) as client,
    ):
        futures = client.map(_marked_part, range(1, 25), plan=plan, marks=str(marks), pure=False)
        workers = set()
        deadline = time.monotonic() + 60
        while len(workers) < 2 or len(list(marks.iterdir())) < 6:
            assert time.monotonic() < deadline, "no worker computes"
            workers = {path.name.split("-")[0] for path in marks.iterdir()}
            time.sleep(0.01)
        killed = int(min(workers))
        os.kill(killed, signal.SIGKILL)
        found = plan.join(client.gather(futures))
    assert text(found) == text(table)
    done = [path.name.split("-") for path in marks.iterdir()]
    twice = {part for who, part in done if who == str(killed)} & {part for who, part in done if who != str(killed)}
    assert twice, "what was lost with the worker is computed by another one"


def _marked_part(part, plan, marks):
    """A run, with a file that names the process that computes it."""
    with open(os.path.join(marks, f"{os.getpid()}-{part}"), "w"):
        return plan.part(part, len(plan))


def test_names_of_columns_are_found_and_listed(table):
    assert FORCE in table and "material.c10" in table and "material.c10 [MPa]" in table and "force" not in table
    assert list(table) == list(table.columns) and table["fault"] == table.faults
    assert np.array_equal(table["run"], table.numbers)


def test_truths_are_swept():
    plate = gb.Plate(60, 20, 2, "neo-hooke", cells=(12, 4), settings={"finite_element": {"cells": [12, 4]}})
    table = gb.sweep(plate, {"mass_spring.area_term": [True, False]}, factors=[0.2])
    assert table["mass_spring.area_term"] == ["true", "false"] and not any(table.faults)
    springs = table["mass_spring.force_N@0.2"]
    assert springs[0] != springs[1]


def test_histories_that_come_to_a_factor_again_are_drawn(study):
    pytest.importorskip("matplotlib").use("Agg")
    card = gb.Material.from_card("neo-hooke").text + '\n[softening]\nr = 2.0\nm = "0.02 MPa"\nbeta = 0.1\n'
    settings = {"finite_element": {"cells": [12, 4]}, "corrector": {"method": "direct"}}
    plate = gb.Plate(60, 20, 2, gb.Material.from_text(card), cells=(12, 4), settings=settings)
    table = gb.sweep(plate, {"plate.width": ["20 mm", "25 mm"]}, factors=[0.3, 0.1, 0.3])
    at, forces = table.along("corrected.force_N")
    assert at.tolist() == [0.3, 0.1, 0.3] == table.band().at.tolist() and forces.shape == (2, 3)
    assert (forces[:, 1] < forces[:, 0]).all()
    assert table.plot().lines and "<img" in table._repr_html_()


@pytest.mark.parametrize(("wrong", "told"), [({"samples": -1}, "samples"), ({"samples": 4, "seed": -1}, "seed")])
def test_numbers_that_cannot_be_are_named(study, wrong, told):
    with pytest.raises(gb.InputError, match=told):
        gb.sweep(study, {"material.c10": "0.05+-0.001 MPa"}, **wrong)
