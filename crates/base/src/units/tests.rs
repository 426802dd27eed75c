//! Quantities from texts.

use super::*;

#[test]
fn quantities_are_converted_to_internal_units() {
    assert_eq!(parse("15 cm", Dimension::Length), Ok(150.0));
    assert_eq!(parse("2mm", Dimension::Length), Ok(2.0));
    assert_eq!(parse("-1.5e-1 m", Dimension::Length), Ok(-150.0));
    assert_eq!(parse("61.1 kPa", Dimension::Stress), Ok(61.1 * 1e-3));
    assert_eq!(parse("1020 kg/m³", Dimension::Density), Ok(1020.0 * 1e-12));
    assert_eq!(parse("1020 kg/m3", Dimension::Density), Ok(1020.0 * 1e-12));
    assert_eq!(parse("3 N/mm2", Dimension::Stress), Ok(3.0));
    assert_eq!(parse("9.81 m/s²", Dimension::Acceleration), Ok(9810.0));
    assert_eq!(parse("3 kPa*s", Dimension::Viscosity), Ok(3e-3));
    assert_eq!(parse("25 °C", Dimension::Temperature), Ok(25.0 + 273.15));
    assert_eq!(parse("-5degC", Dimension::Temperature), Ok(-5.0 + 273.15));
    assert!(parse("-300 °C", Dimension::Temperature).is_ok_and(|kelvin| kelvin < 0.0));
    assert!(parse("25 °C", Dimension::Angle).is_err());
    assert!(factor("°C", Dimension::Temperature).is_err());
    assert_eq!(
        parse("24 mmol/L", Dimension::Concentration),
        Ok(24.0 * 1e-9)
    );
    assert_eq!(parse("50 %", Dimension::Ratio), Ok(0.5));
    assert_eq!(parse("500 ‰", Dimension::Ratio), Ok(0.5));
    assert_eq!(parse("5e5 \u{3bc}ε", Dimension::Ratio), Ok(5e5 * 1e-6));
    assert_eq!(factor("µε", Dimension::Ratio), Ok(1e-6));
    assert_eq!(parse("0.5", Dimension::Ratio), Ok(0.5));
}

#[test]
fn faults_are_told_apart() {
    assert_eq!(
        parse("15", Dimension::Length),
        Err(QuantityFault::MissingUnit)
    );
    assert_eq!(
        parse("cm", Dimension::Length),
        Err(QuantityFault::NotANumber)
    );
    assert_eq!(parse("", Dimension::Length), Err(QuantityFault::NotANumber));
    assert_eq!(
        parse("1e999 mm", Dimension::Length),
        Err(QuantityFault::NotANumber)
    );
    assert_eq!(
        parse("15,0 cm", Dimension::Length),
        Err(QuantityFault::DecimalComma)
    );
    assert_eq!(
        parse("1e150 mm", Dimension::Length),
        Err(QuantityFault::OutOfRange(Dimension::Length))
    );
    assert_eq!(
        parse("15 furlong", Dimension::Length),
        Err(QuantityFault::UnknownUnit("furlong".into()))
    );
    assert_eq!(
        parse("15 MPa", Dimension::Length),
        Err(QuantityFault::WrongDimension {
            unit: "MPa".into(),
            actual: Dimension::Stress
        })
    );
}
