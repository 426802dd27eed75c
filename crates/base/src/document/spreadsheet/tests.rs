use super::*;
use crate::document::archive::stored;
use crate::document::formats::tables;

/// The text of a workbook's only sheet with some rows.
fn sheet(rows: &str) -> Result<String, Unconvertible> {
    let sheet = format!("<worksheet><sheetData>{rows}</sheetData></worksheet>");
    let relationships = "http://schemas.openxmlformats.org/officeDocument/2006/relationships";
    let bytes = stored(&[
        (
            "_rels/.rels",
            &format!(
                r#"<Relationships><Relationship Id="r1" Type="{relationships}/officeDocument" Target="xl/workbook.xml"/></Relationships>"#
            ),
        ),
        (
            "xl/workbook.xml",
            &format!(
                r#"<workbook xmlns:r="{relationships}"><sheets><sheet name="a" sheetId="1" r:id="r1"/></sheets></workbook>"#
            ),
        ),
        (
            "xl/_rels/workbook.xml.rels",
            &format!(
                r#"<Relationships><Relationship Id="r1" Type="{relationships}/worksheet" Target="worksheets/sheet1.xml"/></Relationships>"#
            ),
        ),
        ("xl/worksheets/sheet1.xml", &sheet),
        (
            "xl/sharedStrings.xml",
            "<sst><si><t>force [N]</t></si><si><r><t xml:space=\"preserve\">pause, \"long\"\tand\n</t></r><r><t>longer</t></r><rPh><t>x</t></rPh></si></sst>",
        ),
        (
            "xl/styles.xml",
            r#"<styleSheet><numFmts><numFmt numFmtId="164" formatCode="h:mm"/></numFmts>
            <cellStyleXfs><xf numFmtId="14"/></cellStyleXfs><cellXfs><xf numFmtId="0"/><xf numFmtId="164"/><xf numFmtId="22"/></cellXfs></styleSheet>"#,
        ),
    ]);
    let sheets = tables(&bytes, None)?.unwrap();
    Ok(sheets.into_iter().next().unwrap().text)
}

#[test]
fn cells_become_fields_of_the_line_of_their_row() {
    let rows = r#"<row r="2"><c r="B2" t="s"><v>0</v></c><c r="C2" t="inlineStr"><is><t xml:space="preserve">a &lt; b&#32;</t></is></c></row>
        <row r="4"><c r="B4"><f>1+1</f><v>2</v></c></row>
        <row r="5"><c r="B5" t="e"><v>#DIV/0!</v></c><c r="C5" s="1"><v>0.5</v></c></row>
        <row><c/><c t="str"><v>1,5</v></c><c t="s"><v>1</v></c></row>"#;
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
fn numbers_are_those_of_the_file() {
    let rows = r#"<row r="1"><c r="A1"><v>0.1</v></c><c r="B1"><v>-1.2345678901234E-5</v></c><c r="C1" t="b"><v>1</v></c><c r="D1" s="2"><v>2</v></c></row>"#;
    let expected = "0.1\t-0.000012345678901234\t1\t2 days (a date or a time of day)\n";
    assert_eq!(sheet(rows).unwrap(), expected);
}

#[test]
fn sheets_that_no_program_writes_are_refused() {
    for (rows, reason) in [
        (r#"<row><c r="A1048577"><v>1</v></c></row>"#, "row number"),
        (r#"<row><c r="ZZZZ1"><v>1</v></c></row>"#, "column number"),
        (r#"<row><c r="ÄA1"><v>1</v></c></row>"#, "alphanumeric"),
        (r#"<row><c r="A1" t="s"><v>2</v></c></row>"#, "damaged"),
    ] {
        let refused = sheet(rows).map_err(|fault| fault.message.to_lowercase());
        assert!(
            refused
                .as_ref()
                .is_err_and(|message| message.contains(reason)),
            "{refused:?}"
        );
    }
    // Two cells may span a sheet whose empty fields have no room.
    let corners = r#"<row r="1"><c r="A1"><v>1</v></c></row><row r="1048576"><c r="XFD1048576"><v>1</v></c></row>"#;
    assert!(sheet(corners).is_ok());
}

#[test]
fn elements_may_have_prefixes() {
    let rows = r#"<x:row r="1"><x:c r="A1"><x:v>0.5</x:v></x:c></x:row>"#;
    assert_eq!(sheet(rows).unwrap(), "0.5\n");
}

/// So many texts that there is no room for them, in a part of a few bytes.
#[test]
fn a_number_of_texts_that_cannot_be_is_refused() {
    for (name, texts) in [
        (
            "xl/sharedStrings.xml",
            r#"<sst count="1" uniqueCount="999999999999"><si/></sst>"#,
        ),
        (
            "xl/sharedStrings.XML",
            r#"<!-- uniqueCount="1" --><sst uniqueCount = '999999999999'/>"#,
        ),
    ] {
        let refused = tables(&stored(&[("xl/workbook.xml", ""), (name, texts)]), None).unwrap_err();
        assert!(refused.message.contains("999999999999"), "{refused:?}");
    }
}
