//! Cards whose values are no longer those that their fit found.

use super::Card;
use crate::error::Diagnostic;

impl Card {
    /// The values that a fit finds, by its keys: parameters of the law, terms of the Prony series, softening.
    pub fn fitted_values(&self) -> Vec<(String, f64)> {
        let of_law = self.parameters.iter();
        let of_law = of_law.map(|parameter| (parameter.key.to_owned(), parameter.value));
        let terms = (1..).zip(&self.viscosity.relaxation);
        let terms = terms.flat_map(|(term, relaxation)| {
            let of_term = [("share", relaxation.share), ("time", relaxation.time)];
            of_term.map(|(key, value)| (format!("relaxation.{term}.{key}"), value))
        });
        let softening = self.law.softening().into_iter().flat_map(|ogden_roxburgh| {
            let keys = [
                ("r", ogden_roxburgh.r),
                ("m", ogden_roxburgh.m),
                ("beta", ogden_roxburgh.beta),
            ];
            keys.map(|(key, value)| (format!("softening.{key}"), value))
        });
        of_law.chain(terms).chain(softening).collect()
    }

    /// The warnings about values that are not those of the fit that the card records, and about a file of a shipped card's name that was
    /// not read.
    pub fn warnings(&self) -> Vec<Diagnostic> {
        let overlooked = self.overlooked.as_ref().map(|path| {
            let (name, path) = (&self.name, path.display());
            let message = format!("`{name}` is the card that comes with gelbench; {path} differs from it and is not read");
            Diagnostic::warning("", message).hint(format!("name the file with its ending to use it: \"{path}\""))
        });
        overlooked
            .into_iter()
            .chain(self.changed_since_fit())
            .collect()
    }

    /// The warning about values that are not those of the fit that the card records.
    pub fn changed_since_fit(&self) -> Option<Diagnostic> {
        /// A share of a value that is rounding.
        const ROUNDING: f64 = 1e-9;
        let recorded = self.fit.iter().flat_map(|fit| &fit.values);
        let recorded: Vec<(&str, f64)> = recorded
            .filter_map(|text| text.split_once('='))
            .filter_map(|(key, value)| Some((key.trim(), value.trim().parse().ok()?)))
            .collect();
        let changed = self.fitted_values().into_iter().filter_map(|(key, now)| {
            let (_, fitted) = recorded.iter().find(|(known, _)| *known == key)?;
            let differs = (now - fitted).abs() > ROUNDING * fitted.abs().max(now.abs());
            differs.then(|| format!("{key} = {now} where the fit found {fitted}"))
        });
        let changed: Vec<String> = changed.collect();
        (!changed.is_empty()).then(|| {
            let message = format!(
                "the card `{}` was changed since its fit: {}",
                self.name,
                changed.join(", ")
            );
            let hint = "citation, note and intervals are those of the fitted values: undo the change, or remove [fit] and state in [source] where \
                        the new values come from";
            Diagnostic::warning("", message).hint(hint)
        })
    }
}

#[cfg(test)]
mod tests {
    use crate::material::Card;

    fn card(c10: &str, more: &str) -> Card {
        let text = format!(
            "title = \"gel\"\nlaw = \"neo-hooke\"\n[parameters]\nc10 = \"{c10}\"\n{more}[data]\ntest = \"uniaxial\"\nstress_measure = \"nominal\"\n\
             strain_measure = \"nominal\"\noffset = \"subtract\"\nstretch_range = [1.0, 2.0]\n[source]\ncitation = \"a\"\nspecimen = \"b\"\n\
             [fit]\ndata = [\"a.csv\"]\nweighting = \"absolute\"\nstarts = 8\nvalues = [\"c10 = 0.05\", \"softening.r = 2\"]\n"
        );
        Card::parse("gel", "gel.toml", &text).unwrap()
    }

    #[test]
    fn a_value_that_was_changed_by_hand_is_told_and_another_unit_is_not() {
        let softening = |r: f64| format!("[softening]\nr = {r}\nm = \"1 kPa\"\n");
        let warned = |card: Card| card.changed_since_fit().map(|one| one.message);
        assert_eq!(warned(card("0.05 MPa", "")), None);
        assert_eq!(warned(card("50 kPa", &softening(2.0))), None);
        let message = warned(card("0.06 MPa", "")).unwrap();
        assert!(message.contains("c10 = 0.06 where the fit found 0.05"));
        let message = warned(card("0.05 MPa", &softening(3.0))).unwrap();
        assert!(message.contains("softening.r = 3 where the fit found 2"));
    }

    #[test]
    fn a_card_without_recorded_values_is_as_it_is() {
        let card = Card::load("pva-10-yeoh", std::path::Path::new(".")).unwrap();
        assert!(card.fit.is_some() && card.changed_since_fit().is_none());
    }
}
