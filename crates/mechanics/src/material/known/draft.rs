//! A card in the making.

use crate::document::quoted;
use crate::material::registry::Law;
use crate::material::volume::VolumeEnergy;

/// A card in the making.
#[derive(Clone, Debug)]
pub(super) struct Draft {
    pub law: &'static Law,
    pub title: String,
    /// Mass density as it was stated.
    pub density: Option<String>,
    /// Parameters as they were stated.
    pub parameters: Vec<(String, String)>,
    /// The factor of Ogden's law.
    pub convention: Option<String>,
    /// Parameters that follow from the moduli, as TOML.
    pub computed: Vec<(&'static str, String)>,
    /// Key and value of `[volume]`, as TOML.
    pub volume: Option<(&'static str, String)>,
    /// The energy of `[volume]`.
    pub volume_energy: Option<VolumeEnergy>,
}

impl Draft {
    /// The draft with one more parameter, in MPa.
    pub fn with(&self, key: &'static str, value: f64) -> Self {
        let mut more = self.clone();
        more.computed.push((key, format!("\"{value} MPa\"")));
        more
    }

    /// The text of the card.
    pub fn text(&self) -> String {
        let (title, law) = (quoted(&self.title), quoted(self.law.name));
        let mut text = format!("title = {title}\nlaw = {law}\n");
        if let Some(density) = &self.density {
            text += &format!("density = {}\n", quoted(density));
        }
        text += "\n[parameters]\n";
        let stated = self.parameters.iter();
        let stated = stated.filter(|(key, _)| key != "convention");
        let stated = stated.map(|(key, value)| (&**key, as_toml(value)));
        let computed = self.computed.iter();
        let computed = computed.map(|(key, value)| (*key, value.clone()));
        for (key, value) in stated.chain(computed) {
            text += &format!("{key} = {value}\n");
        }
        if let Some(convention) = &self.convention {
            text += &format!("convention = {}\n", quoted(convention));
        }
        if let Some((key, value)) = &self.volume {
            text += &format!("\n[volume]\n{key} = {value}\n");
            if let Some(energy) = self.volume_energy {
                text += &format!("energy = {}\n", quoted(energy.name()));
            }
        }
        if self.law.is_measured_curve() {
            text += "\n[data]\nstress_measure = \"nominal\"\nstrain_measure = \"nominal\"\n";
        }
        text
    }
}

/// A value as a card states it: a number, or a text.
fn as_toml(value: &str) -> String {
    match value.trim().parse::<f64>() {
        Ok(number) if number.is_finite() => number.to_string(),
        _ => quoted(value.trim()),
    }
}
