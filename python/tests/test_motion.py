"""Motions as objects are those of their study files."""

import gelbench as gb
import pytest

GEL = dict(density="1020 kg/m^3", viscosity={"shear": "50 Pa*s"})


def plate():
    return gb.Plate(30, 10, 1, gb.Material("neo-hooke", c10=0.05), cells=(8, 4))


def strip():
    return gb.Specimen(
        "strip", length=30, width=10, thickness=1, material=gb.Material("neo-hooke", c10=0.05), cells=4, measured="right",
        supports={"left": "clamp", "right": {"x": 3, "y": 0}},
    )  # fmt: skip


@pytest.mark.parametrize("sheet", [plate, strip])
def test_a_released_sheet_is_that_of_its_study(sheet, tmp_path):
    motion = gb.Motion(
        sheet(), "2 ms", start=0.1 if sheet is plate else 1.0, drive={"motion": "release", "time": 0}, interval="0.5 ms",
        probes={"end": (30, 5 if sheet is plate else 0)}, **GEL,
    )  # fmt: skip
    results = motion.run()
    motion.material.save(tmp_path / f"{motion.material.name}.toml")
    (tmp_path / "motion.toml").write_text(motion.study())
    assert gb.run(tmp_path / "motion.toml").json["steps"] == results.json["steps"]
    assert len(results.json["steps"]) > 0 and "release" in motion.study()


def test_a_driven_plate_has_its_amplitude_and_its_settings():
    drive = {"motion": "sine", "amplitude": 0.05, "frequency": 100}
    settings = {"time": {"integrator": "generalised-alpha", "step": "0.1 ms"}, "corrector": {"enabled": False}}
    motion = gb.Motion(plate(), 0.01, drive=drive, interval=0.0025, settings=settings, **GEL)
    text = motion.study()
    assert 'frequency = "100.0 Hz"' in text and "enabled = false" in text
    last = motion.run().fields["finite_element"][1]
    right = last.points[:, 0] > 29.999
    assert last.displacement[right, 0] == pytest.approx(1.5, rel=1e-6)


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"drive": {"motion": "jump"}}, "jump"),
        ({"drive": {"motion": "release"}, "density": "heavy"}, "density"),
        ({"drive": {"motion": "hold"}, "settings": {"grip": {"motion": "hold"}}}, "drive="),
        ({"drive": {"motion": "hold"}, "probes": {"far": (300, 5)}}, "point of the sheet"),
    ],
)
def test_faults_are_raised_at_once(arguments, words):
    with pytest.raises(gb.InputError, match=words):
        gb.Motion(plate(), "2 ms", **{"density": "1020 kg/m^3", **arguments})


def test_other_sheets_are_refused():
    with pytest.raises(gb.InputError, match="Plate or a Specimen"):
        gb.Motion("plate.toml", "2 ms", drive={"motion": "hold"})


def test_a_drive_has_its_defaults_and_mappings_take_quantities():
    pint = pytest.importorskip("pint")
    quantity = pint.UnitRegistry().Quantity

    def study(drive, **more):
        return gb.Motion(plate(), "10 ms", start=0.1, drive=drive, density=quantity(1020, "kg/m^3"), **more).study()

    assert study({"motion": "release"}) == study({"motion": "release", "time": quantity(0, "s")})
    assert study({"motion": "ramp", "to": 0.2, "end": 0.1}) == study({"motion": "ramp", "to": 0.2, "begin": 0, "end": "0.1 s"})
    viscous = {"relaxation": [{"share": 0.3, "time": quantity(2, "s")}]}
    assert 'time = "2.0 s"' in study({"motion": "hold"}, viscosity=viscous)
    assert 'y = "-9810.0 mm/s^2"' in study({"motion": "hold"}, gravity=(0, -9810))
    material = gb.Material("neo-hooke", c10=quantity(50, "kPa"))
    assert material.shear_modulus == pytest.approx(0.1)
    assert 'bulk_modulus = "5.0 MPa"' in material.with_properties(volume={"bulk_modulus": 5}).text


def test_a_motion_is_that_of_the_sheet_it_was_made_of():
    sheet = plate()
    motion = gb.Motion(sheet, "20ms", drive={"motion": "hold"}, density="1020 kg/m^3")
    text = motion.study()
    sheet.thickness = 2
    motion.sheet.thickness = 2
    assert motion.study() == text and "1.0 mm" in repr(motion) and 'interval = "0.0002 s"' in text
    with pytest.raises(AttributeError, match="create another Motion"):
        motion.duration = 5
