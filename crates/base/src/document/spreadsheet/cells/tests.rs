use super::*;

fn sheet(rows: &str) -> Result<String, Unconvertible> {
    let workbook = Workbook {
        texts: vec![
            "force [N]".to_owned(),
            "pause, \"long\"\tand\nlonger".to_owned(),
        ],
        dates: [1].into(),
        ..Workbook::default()
    };
    text(
        &format!("<x:worksheet><x:sheetData>{rows}</x:sheetData></x:worksheet>"),
        &workbook,
    )
}

#[test]
fn cells_become_fields_of_the_line_of_their_row() {
    let rows = r#"<x:row r="2"><x:c r="B2" t="s"><x:v>0</x:v></x:c><x:c r="C2" t="inlineStr"><x:is><x:t>a &lt; b&#32;</x:t></x:is></x:c></x:row>
        <x:row r="4"><x:c r="B4"><x:f>1+1</x:f><x:v>2</x:v></x:c></x:row>
        <x:row r="5"><x:c r="B5" t="e"><x:v>#DIV/0!</x:v></x:c><x:c r="C5" s="1"><x:v>0.5</x:v></x:c></x:row>
        <x:row><x:c/><x:c t="str"><x:v>1,5</x:v></x:c><x:c t="s"><x:v>1</x:v></x:c></x:row>"#;
    let expected = "\nforce [N]\ta < b \n\n2\t\nNaN\t0.5 days (a date or a time of day)\n1,5\tpause, 'long' and longer\n";
    assert_eq!(sheet(rows).unwrap(), expected);
    assert_eq!(sheet("").unwrap(), "");
}

#[test]
fn lines_above_the_table_end_at_their_last_field() {
    let rows = r#"<row r="1"><c r="A1"><v>7</v></c></row><row r="2"><c r="A2"><v>1</v></c><c r="C2"><v>3</v></c></row>
        <row r="3"><c r="A3"><v>1</v></c></row>"#;
    assert_eq!(sheet(rows).unwrap(), "7\n1\t\t3\n1\t\t\n");
}

#[test]
fn sheets_that_no_program_writes_are_refused() {
    for (rows, reason) in [
        (
            r#"<row><c r="A1048577"><v>1</v></c></row>"#,
            "outside of any sheet",
        ),
        (
            r#"<row><c r="ZZZZZZZZZZZZZZZZZZZZ1"><v>1</v></c></row>"#,
            "outside of any sheet",
        ),
        (
            r#"<row><c r="A1" t="s"><v>2</v></c></row>"#,
            "a text that is not there",
        ),
        ("<row>", "damaged"),
    ] {
        assert!(sheet(rows).unwrap_err().message.contains(reason), "{rows}");
    }
    // Two cells may span a sheet whose empty fields have no room.
    let corners = r#"<row r="1"><c r="A1"><v>1</v></c></row><row r="1048576"><c r="XFD1048576"><v>1</v></c></row>"#;
    assert!(sheet(corners).is_ok());
}
