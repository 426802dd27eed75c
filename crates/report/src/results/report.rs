//! The report of a study: its parts and their order, the same for every kind.

use super::{Block, Claim, End, Outcome, Results, requirements, verdict};

impl Results {
    /// The report; its pictures are those of the outcome.
    pub fn report(&self) -> Vec<Block> {
        let outcome = &self.outcome;
        let mut blocks = vec![Block::Heading(1, self.title.clone())];
        blocks.extend(outcome.headline.iter().cloned());
        blocks.extend(judged(outcome));
        blocks.extend(ends(outcome));
        blocks.extend(paragraphs("Doubts", &outcome.doubts().collect::<Vec<_>>()));
        blocks.extend(outcome.warning_paragraphs());
        blocks.extend(claims(outcome.claims.iter()));
        blocks.extend(outcome.blocks.iter().cloned());
        let placed = |block: &Block| matches!(block, Block::Figure(..));
        if !outcome.blocks.iter().any(placed) {
            blocks.extend(pictures(heading(outcome.along), outcome));
        }
        blocks.extend(
            outcome
                .material
                .iter()
                .flat_map(|material| material.blocks.clone()),
        );
        blocks.extend(self.study());
        blocks.push(Block::paragraph(format!(
            "gelbench {}",
            env!("CARGO_PKG_VERSION")
        )));
        blocks.extend(self.time_blocks());
        blocks
    }

    /// The text of the study, its defaults, and the warnings from reading it.
    pub fn study(&self) -> Vec<Block> {
        let mut blocks = Vec::new();
        if !self.text.is_empty() {
            blocks.extend([
                Block::heading("Study"),
                Block::Code("toml", self.text.clone()),
            ]);
        }
        if !self.defaults.is_empty() {
            blocks.push(Block::paragraph(
                "Settings that the study leaves out, with the defaults used:",
            ));
            blocks.push(Block::Code("toml", self.defaults.join("\n")));
        }
        blocks.extend(paragraphs("Warnings on reading", &self.read_warnings));
        blocks
    }

    fn time_blocks(&self) -> [Block; 3] {
        let digits = |seconds: f64| if seconds < 0.1 { 5 } else { 3 };
        let time = |seconds: f64| format!("{seconds:.*}", digits(seconds));
        let rows = self.times();
        let rows = rows.map(|(what, seconds)| vec![what.to_owned(), time(seconds)]);
        [
            Block::heading("Times"),
            Block::paragraph("Wall-clock times. They differ from run to run."),
            Block::table(&["what", "time [s]"], rows),
        ]
    }
}

fn paragraphs(heading: &str, texts: &[String]) -> Vec<Block> {
    let heading = (!texts.is_empty()).then(|| Block::heading(heading));
    heading
        .into_iter()
        .chain(texts.iter().map(Block::paragraph))
        .collect()
}

/// All pictures under a heading.
pub fn pictures(heading: &str, outcome: &Outcome) -> Vec<Block> {
    let figures = outcome.figures.iter().enumerate();
    let figures = figures.map(|(index, figure)| Block::Figure(index, figure.caption.clone()));
    let heading = (!outcome.figures.is_empty()).then(|| Block::heading(heading));
    heading.into_iter().chain(figures).collect()
}

/// For frames, the pictures show the last one.
fn heading(along: &str) -> &'static str {
    match along {
        "frame" => "Pictures of the last frame",
        _ => "Pictures",
    }
}

fn judged(outcome: &Outcome) -> Vec<Block> {
    let checks = &outcome.checks;
    if checks.is_empty() {
        return Vec::new();
    }
    let verdict = format!("The requirements have {}:", verdict(checks));
    vec![Block::Paragraph(verdict), requirements(checks)]
}

/// The models that ended early, where and why; ends that are already listed as requirements are not repeated.
fn ends(outcome: &Outcome) -> Vec<Block> {
    if outcome.checks.iter().any(super::Check::is_end) {
        return Vec::new();
    }
    let sentence = |end: &End| match end.advice {
        Some(advice) => format!("{}. Try: {advice}.", end.message),
        None => format!("{}.", end.message),
    };
    let sentences: Vec<String> = outcome.ends.iter().map(sentence).collect();
    paragraphs("Models that ended early", &sentences)
}

/// The publication's claims; empty without one.
pub fn claims<'a>(claims: impl Iterator<Item = &'a Claim>) -> Vec<Block> {
    let rows = claims.map(|claim| vec![claim.claim.to_owned(), claim.reproduced.clone()]);
    let rows: Vec<_> = rows.collect();
    if rows.is_empty() {
        return Vec::new();
    }
    vec![
        Block::heading("The publication's claims"),
        Block::paragraph(
            "H. Mohammadi, W. Wan: A novel numerical corrective technique to mass spring systems.",
        ),
        Block::table(&["claim", "reproduced here"], rows),
    ]
}
