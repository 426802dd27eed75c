//! Tables of texts that only programs read and write.

/// The text of records, one a line; fields with commas or line ends stand in quotes.
pub fn write_records(records: impl IntoIterator<Item = Vec<String>>) -> String {
    const SOUND: &str = "memory takes all that is written";
    let mut table = csv::WriterBuilder::new()
        .flexible(true)
        .from_writer(Vec::new());
    for record in records {
        table.write_record(record).expect(SOUND);
    }
    let bytes = table.into_inner().expect(SOUND);
    String::from_utf8(bytes).expect("fields are texts")
}

/// The records of a text that [`write_records`] has written; `None` for any other text.
pub fn read_records(bytes: &[u8]) -> Option<Vec<Vec<String>>> {
    let mut table = csv::ReaderBuilder::new()
        .has_headers(false)
        .from_reader(bytes);
    let fields = |record: csv::StringRecord| record.iter().map(str::to_owned).collect();
    let records = table.records().map(|record| record.ok().map(fields));
    records.collect()
}
