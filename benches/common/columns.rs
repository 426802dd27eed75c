//! Tables of named columns, printed and as CSV.

/// Name and value of every column of a row.
pub type Columns = Vec<(&'static str, String)>;

/// Rows with the same columns; long names stand above, by number, so that a row fits on a line.
pub fn print(rows: &[Columns]) {
    let Some(first) = rows.first() else {
        return;
    };
    println!();
    for (index, (name, _)) in first.iter().enumerate() {
        println!("({index}) {name}");
    }
    let heads: Vec<String> = (0..first.len()).map(|index| format!("({index})")).collect();
    let width = |column: usize| {
        let values = rows.iter().map(|row| row[column].1.chars().count());
        values.max().unwrap_or(0).max(heads[column].len())
    };
    let widths: Vec<usize> = (0..first.len()).map(width).collect();
    let line = |values: Vec<&str>| {
        let padded = values
            .iter()
            .zip(&widths)
            .map(|(value, width)| format!("{value:>width$}"));
        println!("{}", padded.collect::<Vec<_>>().join("  "));
    };
    line(heads.iter().map(String::as_str).collect());
    for row in rows {
        line(row.iter().map(|(_, value)| value.as_str()).collect());
    }
}

/// The same as CSV.
pub fn csv(rows: &[Columns]) -> Vec<u8> {
    const MEMORY: &str = "writing to memory does not fail";
    let mut writer = csv::Writer::from_writer(Vec::new());
    if let Some(first) = rows.first() {
        let names = first.iter().map(|(name, _)| *name);
        writer.write_record(names).expect(MEMORY);
    }
    for row in rows {
        let values = row.iter().map(|(_, value)| value);
        writer.write_record(values).expect(MEMORY);
    }
    writer.into_inner().expect(MEMORY)
}

/// A value as CSV has it.
pub fn number(value: f64) -> String {
    format!("{value:.4e}")
}

/// A ratio of times.
pub fn ratio(value: f64) -> String {
    format!("{value:.2}")
}
