use super::*;
use crate::document::converted::TableText;
use crate::document::head::pairs;

fn rows(text: &str) -> Vec<Vec<f64>> {
    let table = Table::parse("a.csv", text).unwrap();
    table.rows.into_iter().map(|(row, _)| row).collect()
}

fn refusal(text: &str) -> String {
    Table::parse("a.csv", text).unwrap_err().to_string()
}

#[test]
fn the_usual_ways_of_writing_a_table_are_read_alike() {
    let expected = vec![vec![1.0, 0.0], vec![1.5, -0.25]];
    for text in [
        "stretch [-],stress [MPa]\n1,0\n1.5,-0.25\n",
        "\u{feff}stretch [-],stress [MPa]\r\n1.0,0.0\r\n1.5,-2.5e-1\r\n",
        "stretch [-];stress [MPa]\n1,0;0,0\n1,5;-0,25\n",
        "stretch [-]\tstress [MPa]\n1\t0\n\n1,5\t-0,25",
        "\"Stretch\",\"Stress\"\n\"(-)\",\"(MPa)\"\n\"1\",\"0\"\n\"1.5\",\"-0.25\"\n",
        "# test: uniaxial\n1, 0\n# a remark\n1.5, -0.25\n",
    ] {
        assert_eq!(rows(text), expected, "{text:?}");
    }
}

#[test]
fn names_units_and_head_are_found() {
    let text = "# test: uniaxial; direction: 2\n# A remark.\nNominal Stress (kPa),stretch\n1,2\n";
    let table = Table::parse("a.csv", text).unwrap();
    assert_eq!(table.columns[0].name, "nominal_stress");
    assert_eq!(table.columns[0].unit.as_deref(), Some("kPa"));
    assert_eq!(table.columns[1].unit, None);
    let head = pairs(&table, &["test"]).unwrap();
    assert_eq!(head["test"].0, "uniaxial");
    assert_eq!(head["direction"].0, "2");
}

#[test]
fn times_of_a_clock_are_in_seconds() {
    let expected = vec![vec![1.05, 1.0], vec![3661.5, 950.0]];
    for text in [
        "Time,Load [N]\n00:00:01.050,1\n01:01:01.5,950\n",
        "Time [hh:mm:ss];Load [N]\n00:00:01,050;1\n1:01:01,5;950\n",
        "# Time [h], Load [N]\n00:00:01.050,1\n01:01:01.5,950\n",
    ] {
        let table = Table::parse("a.csv", text).unwrap();
        assert_eq!(table.columns[0].unit.as_deref(), Some("s"), "{text}");
        assert_eq!(rows(text), expected, "{text}");
    }
    for field in ["12:75:00", "01:02", "1:2:3:4", "a:01:02"] {
        let table = Table::parse("a.csv", &format!("t,F\n{field},1\n0,2\n")).unwrap();
        assert!(table.check_numbers([0], "").is_err(), "{field}");
    }
}

#[test]
fn bad_tables_are_refused_with_line_and_reason() {
    for (text, reason) in [
        ("", "no columns"),
        ("# only a head\n", "no columns"),
        ("a,b\n", "no rows"),
        (
            "a,b\n1,5,0,2\n",
            "a.csv:2: 4 fields, but the header has 2 columns",
        ),
        ("a\tb\n1,050\t2\n950\t3\n", "group thousands"),
        ("a\tb\n950\t2\n1.050\t3\n", "group thousands"),
    ] {
        let actual = refusal(text);
        assert!(actual.contains(reason), "{text:?}: {actual}");
    }
}

#[test]
fn fields_that_are_no_numbers_are_told_by_their_column() {
    for (text, line, reason) in [
        (
            "a,b\n1,0\n# pause\n\n2,NaN\n",
            5,
            "NaN is not a finite number",
        ),
        ("a,b\n1,0\n2,inf\n", 3, "inf is not a finite number"),
        ("a,b\n1,0\n2,x\n", 3, "\"x\" is not a number"),
        ("a,b\n1,0\n2,0.1 MPa\n", 3, "\"0.1 MPa\" is not a number"),
        ("a,b\n1,0\n2,\n", 3, "a field is empty"),
        ("a;b\n1,5;0,2\n1,6;0.3\n", 3, "are mixed in this file"),
        ("a;b\n1,0;1.000,5\n", 2, "without separators of thousands"),
        ("a;b\n1.5;1,000.5\n", 2, "without separators of thousands"),
        ("a;b\n1.5;12.05.2024\n", 2, "is not a number"),
    ] {
        let table = Table::parse("a.csv", text).unwrap();
        let actual = table.check_numbers([1], "").unwrap_err().to_string();
        let position = format!("a.csv:{line}: column `b`: ");
        assert!(
            actual.contains(&position) && actual.contains(reason),
            "{text:?}: {actual}"
        );
        assert!(table.check_numbers([0], "").is_ok(), "{text:?}");
    }
}

#[test]
fn remarks_old_line_ends_and_citations_are_read() {
    let text = "#test:uniaxial\r# source: Smith A 2001; Jones B: Aorta tests\ra [-],b [MPa]\r1,2\r";
    let table = Table::parse("a.csv", text).unwrap();
    let head = pairs(&table, &["test"]).unwrap();
    assert_eq!(head["test"].0, "uniaxial");
    assert_eq!(head["source"].0, "Smith A 2001; Jones B: Aorta tests");
    assert_eq!(table.rows.len(), 1);
    let twice = Table::parse("a.csv", "# test: planar\n# test: uniaxial\na,b\n1,2\n").unwrap();
    let faults = pairs(&twice, &["test"]).unwrap_err();
    assert!(
        faults[0]
            .to_string()
            .contains("a.csv:2: the test is stated twice")
    );
}

/// A whole number in another column, or one mark that surely marks decimals, does not make others doubtful.
#[test]
fn decimals_are_told_from_thousands_column_by_column() {
    for text in [
        "n\tb\n150\t1.050\n151\t1.055\n",
        "a\tb\n950\t0.5\n1.050\t0.6\n",
        "a\tb\n950\t2\n1050\t2\n1.050\t3\n",
        "n;b\n150;1,050\n151;1,055\n",
    ] {
        assert!(Table::parse("a.csv", text).is_ok(), "{text:?}");
    }
}

#[test]
fn one_of_several_tables_of_a_file_is_asked_for() {
    let sheet = |name: &str, rows: &str| TableText {
        name: Some(name.to_owned()),
        text: format!("a\tb\n{rows}"),
    };
    let (few, enough) = ("1\t2\n2\t3\n", "1\t2\n2\t3\n3\t4\n");
    let read = |sheets: &[TableText]| Table::only(Path::new("a.xlsx"), sheets, WHOLE);
    let one = read(&[sheet("results", few), sheet("first", enough)]).unwrap();
    assert_eq!(one.part.as_deref(), Some("first"));
    let several = [sheet("first", enough), sheet("second", enough)];
    let asked = read(&several).unwrap_err().to_string();
    assert!(
        asked.contains("`first`, `second`") && asked.contains("a.xlsx#first"),
        "{asked}"
    );
}
