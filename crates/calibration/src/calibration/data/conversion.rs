//! Test data in other measures and units.

use std::fmt::Write;

use super::cycles::{PRECONDITIONED, SPECIMEN_NAME};
use super::mounting_statements::{FORCE_ZERO, REST_STATE};
use super::strain_column::StrainColumn;
use super::test_data::{Test, TestData};
use crate::error::Error;
use crate::material::parameters::{StrainMeasure, StressMeasure};
use crate::units::{self, Dimension};

/// The form in which test data are written.
#[derive(Clone, Debug)]
pub struct Conversion {
    /// The stress measure.
    pub stress: StressMeasure,
    /// The strain measure.
    pub strain: StrainColumn,
    /// The unit of stress.
    pub unit: String,
}

/// The statements of a file that hold in every measure and unit.
const KEPT: [&str; 6] = [
    "source",
    "doi",
    "specimen",
    SPECIMEN_NAME,
    "licence",
    "compiled by",
];

impl Conversion {
    /// The data as a table that `gelbench materials fit` reads. In simple shear, γ and the shear stress have one measure, whichever is asked
    /// for.
    ///
    /// # Errors
    /// [`Error::Input`] when the unit is not a unit of stress, or when the file has times that cannot be read.
    pub fn table(&self, data: &TestData) -> Result<String, Error> {
        let read = units::factor(&self.unit, Dimension::Stress);
        let factor = read.map_err(|fault| {
            let known: Vec<_> = Dimension::Stress.units().collect();
            let hint = format!("known units: {}", known.join(", "));
            Error::input(format!("the unit to write {fault}"), hint)
        })?;
        let times = data.known_times()?;
        let axes = &data.axes;
        let mut text = head(data);
        let _ = writeln!(text, "{}", self.names(data, times.is_some()).join(","));
        let (strain, stress) = match data.test {
            Test::SimpleShear => (
                StrainColumn::Strain(StrainMeasure::Nominal),
                StressMeasure::Nominal,
            ),
            _ => (self.strain, self.stress),
        };
        for (index, row) in data.observations.chunks(axes.len()).enumerate() {
            let along = match data.test {
                Test::Uniaxial | Test::SimpleShear => vec![row[0].strain()],
                Test::Biaxial => row[0].strains.to_vec(),
                _ => vec![row[0].strains[0]],
            };
            let strains = along.into_iter().map(|x| strain.of_nominal(x));
            let stresses = row.iter().map(|one| {
                let x = one.strain();
                let nominal = data.stress_measure.to_nominal(one.stress, x);
                stress.of_nominal(nominal, x) / factor
            });
            let time = times.map(|times| times[index * axes.len()]);
            let values = time.into_iter().chain(strains).chain(stresses);
            let fields: Vec<_> = values.map(|value| value.to_string()).collect();
            let _ = writeln!(text, "{}", fields.join(","));
        }
        Ok(text)
    }

    fn names(&self, data: &TestData, has_times: bool) -> Vec<String> {
        let is_sheared = data.test == Test::SimpleShear;
        let strain = match self.strain {
            _ if is_sheared => "shear_strain".to_owned(),
            StrainColumn::Stretch => "stretch".to_owned(),
            StrainColumn::Strain(measure) => format!("{}_strain", measure.name()),
            StrainColumn::GreenLagrange => "green_lagrange_strain".to_owned(),
        };
        let numbered = |name: &str, unit: &str, axes: &[usize]| -> Vec<String> {
            match axes {
                [_] => vec![format!("{name} [{unit}]")],
                _ => axes
                    .iter()
                    .map(|axis| format!("{name}_{} [{unit}]", axis + 1))
                    .collect(),
            }
        };
        let along: &[usize] = if data.test == Test::Biaxial {
            &[0, 1]
        } else {
            &[0]
        };
        let mut names = Vec::new();
        names.extend(has_times.then(|| "time [s]".to_owned()));
        names.extend(numbered(&strain, "-", along));
        let measure = if is_sheared {
            "shear"
        } else {
            self.stress.name()
        };
        let stress = format!("{measure}_stress");
        names.extend(numbered(&stress, &self.unit, &data.axes));
        names
    }
}

/// What is stated of a test, whatever its measures and units are.
fn head(data: &TestData) -> String {
    let mut text = String::new();
    for (key, value) in &data.head {
        if KEPT.contains(&&**key) {
            let _ = writeln!(text, "# {key}: {value}");
        }
    }
    if data.rise > 0.0 {
        let _ = writeln!(text, "# ramp: {} s", data.rise);
    }
    if let Some(strain) = data.preconditioned {
        let _ = writeln!(text, "# {PRECONDITIONED}: {}", 1.0 + strain);
    }
    let mounted = &data.mounted;
    for (key, is_estimated) in [
        (REST_STATE, mounted.estimates_stretches()),
        (FORCE_ZERO, mounted.estimates_force_zero),
    ] {
        if is_estimated {
            let _ = writeln!(text, "# {key}: estimated");
        }
    }
    let direction = if data.axes[..] == [1] {
        "; direction: 2"
    } else {
        ""
    };
    let _ = writeln!(text, "# test: {}{direction}", data.test.name());
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::calibration::tests::helpers::{parsed, uniaxial};

    /// Nominal to Cauchy, logarithmic and kPa, and back.
    #[test]
    fn there_and_back_again() {
        for text in [
            "# test: uniaxial\nstretch [-],nominal_stress [MPa]\n0.8,-0.5\n1.5,0.25\n",
            "# test: uniaxial; direction: 2\nstretch [-],nominal_stress [MPa]\n1.5,0.25\n",
            "# ramp: 2 s\n# test: uniaxial\ntime [s],stretch [-],nominal_stress [MPa]\n0,1.5,0.25\n10,1.5,0.2\n30,1.5,0.18\n",
            "# test: planar; direction: 2\nstretch [-],nominal_stress [MPa]\n1.5,0.25\n2,0.5\n",
            "# test: biaxial\nstretch_1 [-],stretch_2 [-],nominal_stress_1 [MPa],nominal_stress_2 [MPa]\n1.5,1.25,0.5,0.25\n",
            "# rest state: estimated\n# force zero: estimated\n# test: biaxial\nstretch_1 [-],stretch_2 [-],nominal_stress_1 [MPa],nominal_stress_2 [MPa]\n1.5,1.25,0.5,0.25\n",
        ] {
            let data = parsed(text);
            let away = Conversion {
                stress: StressMeasure::Cauchy,
                strain: StrainColumn::Strain(StrainMeasure::Logarithmic),
                unit: "kPa".into(),
            };
            let there = parsed(&away.table(&data).unwrap());
            assert_eq!(there.stress_measure, StressMeasure::Cauchy);
            for (one, other) in data.observations.iter().zip(&there.observations) {
                let x = one.strain();
                assert_eq!(one.axis, other.axis);
                assert!((other.strains[one.axis] - x).abs() < 1e-15);
                assert!(
                    (one.stress * (1.0 + x) - other.stress).abs() < 1e-15,
                    "{text}"
                );
            }
            let back = Conversion {
                stress: StressMeasure::Nominal,
                strain: StrainColumn::Stretch,
                unit: "MPa".into(),
            };
            let again = parsed(&back.table(&there).unwrap());
            let times = |data: &TestData| data.known_times().unwrap().map(<[f64]>::to_vec);
            assert_eq!(times(&again), times(&data), "{text}");
            assert_eq!(again.rise, data.rise, "{text}");
            assert_eq!(again.mounted, data.mounted, "{text}");
            for (one, other) in data.observations.iter().zip(&again.observations) {
                assert!((one.stress - other.stress).abs() < 1e-15);
            }
        }
    }

    #[test]
    fn shear_stays_what_it_is_in_every_measure() {
        let text = "# test: simple-shear\nshear_strain [-],shear_stress [MPa]\n0.25,0.5\n0.5,1\n";
        let data = parsed(text);
        let conversion = Conversion {
            stress: StressMeasure::Cauchy,
            strain: StrainColumn::Stretch,
            unit: "MPa".into(),
        };
        assert_eq!(conversion.table(&data).unwrap(), text);
    }

    #[test]
    fn another_unit_than_one_of_stress_is_refused() {
        let data = uniaxial("1.5,0.25\n");
        let conversion = Conversion {
            stress: StressMeasure::Nominal,
            strain: StrainColumn::Stretch,
            unit: "mm".into(),
        };
        assert!(
            conversion
                .table(&data)
                .unwrap_err()
                .to_string()
                .contains("measures length")
        );
    }
}
