//! Material cards.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

use gelbench::error::Error;
use gelbench::material::curve::Mode;
use gelbench::material::registry::{CARDS, LAWS, Law};
use gelbench::material::stability::stable_range;
use gelbench::material::{Card, HyperelasticLaw};
use gelbench::units::{self, Dimension};
use gelbench_base::document::{EditedDocument, NewValue};
use gelbench_base::error::suggestion;
use gelbench_mechanics::material::Known;
use gelbench_mechanics::material::curve::simple_shear;
use gelbench_mechanics::material::parameters::{StrainMeasure, StressMeasure};
use numpy::{PyArray1, PyReadonlyArray1};
use pyo3::prelude::*;

use crate::errors::{choice, input, raised, refused};
use crate::law::Watched;
use crate::running::{Watch, caught};

/// A material card.
#[pyclass(frozen, module = "gelbench._core")]
pub struct MaterialCard {
    pub card: Arc<Card>,
}

/// A parameter of a card: key, value, unit.
type Parameter = (&'static str, f64, &'static str);

impl MaterialCard {
    pub fn of(card: Card) -> Self {
        Self {
            card: Arc::new(card),
        }
    }

    /// The card with other values of some parameters, each a number or a text with a unit.
    fn changed(&self, values: &BTreeMap<String, String>) -> Result<Card, Error> {
        let card = &self.card;
        let mut document = EditedDocument::parse(&card.text).map_err(refused)?;
        for (key, value) in values {
            if !card.parameters.iter().any(|parameter| parameter.key == key) {
                let known: Vec<_> = card
                    .parameters
                    .iter()
                    .map(|parameter| parameter.key)
                    .collect();
                let hint = suggestion(key, &known, "its parameters are");
                return Err(input(format!("the law has no parameter `{key}`"), hint));
            }
            let value = match value.parse() {
                Ok(number) => NewValue::Float(number),
                Err(_) => NewValue::Text(value.clone()),
            };
            document
                .set(&["parameters", key], &value)
                .map_err(refused)?;
        }
        if values.is_empty() {
            return Ok((**card).clone());
        }
        let changes: Vec<String> = values
            .iter()
            .map(|(key, value)| format!("{key} = {value}"))
            .collect();
        let origin = format!("the card `{}` with {}", card.name, changes.join(", "));
        let statements = [
            (&["title"][..], &*origin),
            (&["source", "citation"], &*origin),
            (&["source", "doi"], ""),
            (&["source", "specimen"], ""),
            (&["source", "note"], ""),
        ];
        for (key, statement) in statements {
            let statement = NewValue::Text(statement.to_owned());
            document.set(key, &statement).map_err(refused)?;
        }
        document.remove("fit");
        Card::parse(&card.name, &format!("{}.toml", card.name), &document.text())
    }

    /// The card that a study has read, whose sheet is in the state that it asks for, by the name of this one.
    pub fn in_study(&self, read: &Card) -> Card {
        Card {
            name: self.card.name.clone(),
            ..read.clone()
        }
    }
}

/// A plain number with the internal unit of a dimension; a text with a unit as it is.
fn with_unit(value: &str, dimension: Dimension) -> String {
    if dimension == Dimension::Ratio || value.parse::<f64>().is_err() {
        return value.to_owned();
    }
    format!("{value} {}", dimension.internal_unit())
}

/// The law of a name; a message names one of those that are `listed`.
pub fn law_named(
    name: &str,
    listed: impl Iterator<Item = &'static Law>,
) -> Result<&'static Law, Error> {
    Law::named(name).ok_or_else(|| {
        let names: Vec<_> = listed.map(|law| law.name).collect();
        let hint = suggestion(name, &names, "laws are");
        input(format!("there is no law `{name}`"), hint)
    })
}

/// What is known of a material, by the keys of a card; plain numbers are in MPa where a unit is needed.
fn known(law: &str, values: &BTreeMap<String, String>) -> Result<Known, Error> {
    let law = law_named(law, LAWS.iter())?;
    let measures = (StressMeasure::Nominal, StrainMeasure::Nominal);
    let (_, entries) = law.with_values(&[], measures.0, measures.1);
    let mut known = Known::of(law);
    for (key, value) in values {
        let parameter = entries.parameters.iter().find(|one| one.key == key);
        if let Some(one) = parameter {
            let value = with_unit(value, one.dimension);
            known.parameters.push((key.clone(), value));
            continue;
        }
        let measure = |dimension| {
            units::parse(&with_unit(value, dimension), dimension)
                .map_err(|fault| refused(format!("{key}: {fault}")))
        };
        match &**key {
            "youngs_modulus" => known.moduli.young = Some(measure(Dimension::Stress)?),
            "shear_modulus" => known.moduli.shear = Some(measure(Dimension::Stress)?),
            "bulk_modulus" => known.moduli.bulk = Some(measure(Dimension::Stress)?),
            "poisson_ratio" => known.moduli.poisson_ratio = Some(measure(Dimension::Ratio)?),
            "density" => known.density = Some(value.clone()),
            _ => known.parameters.push((key.clone(), value.clone())),
        }
    }
    Ok(known)
}

/// A card for a computation that can be ended.
pub fn watched(card: Card, watch: &Arc<Watch>) -> Card {
    Card {
        law: Watched::law(&card.law, watch),
        ..card
    }
}

#[pymethods]
impl MaterialCard {
    #[staticmethod]
    fn load(py: Python<'_>, name: &str, folder: &str) -> PyResult<Self> {
        raised(py, Card::load(name, Path::new(folder)).map(Self::of))
    }

    #[staticmethod]
    fn parse(py: Python<'_>, name: &str, text: &str) -> PyResult<Self> {
        let card = Card::parse(name, &format!("{name}.toml"), text);
        raised(py, card.map(Self::of))
    }

    /// A law with what is known of it: parameters, moduli, density, convention; numbers or texts with a unit.
    #[staticmethod]
    fn of_law(
        py: Python<'_>,
        law: &str,
        name: &str,
        values: BTreeMap<String, String>,
    ) -> PyResult<Self> {
        let text = known(law, &values).and_then(|known| known.card_text(name));
        let card = text.and_then(|text| Card::parse(name, name, &text));
        raised(py, card.map(Self::of))
    }

    /// The same law with other values of some parameters, each a number or a text with a unit.
    fn with_parameters(&self, py: Python<'_>, values: BTreeMap<String, String>) -> PyResult<Self> {
        raised(py, self.changed(&values).map(Self::of))
    }

    #[getter]
    fn name(&self) -> &str {
        &self.card.name
    }

    #[getter]
    fn title(&self) -> &str {
        &self.card.title
    }

    #[getter]
    fn law(&self) -> &str {
        &self.card.law_name
    }

    #[getter]
    fn formula(&self) -> String {
        self.card.energy()
    }

    #[getter]
    fn text(&self) -> &str {
        &self.card.text
    }

    #[getter]
    fn citation(&self) -> &str {
        &self.card.citation
    }

    #[getter]
    fn doi(&self) -> &str {
        &self.card.doi
    }

    #[getter]
    fn note(&self) -> &str {
        &self.card.note
    }

    #[getter]
    fn density(&self) -> Option<f64> {
        self.card.density
    }

    #[getter]
    fn stretch_range(&self) -> (f64, f64) {
        self.card.stretch_range.into()
    }

    fn parameters(&self) -> Vec<Parameter> {
        let parameters = self.card.parameters.iter();
        parameters
            .map(|one| (one.key, one.value, one.unit()))
            .collect()
    }

    fn shear_modulus(&self, py: Python<'_>) -> PyResult<f64> {
        caught(py, || self.card.law.shear_modulus())
    }

    fn swelling_stretch(&self) -> f64 {
        self.card.law.swelling_stretch()
    }

    fn youngs_modulus(&self, py: Python<'_>) -> PyResult<f64> {
        caught(py, || self.card.youngs_modulus())
    }

    fn stable_range(&self, py: Python<'_>, test: &str) -> PyResult<(f64, f64)> {
        let mode = mode(test).and_then(|mode| {
            let message = "the stable range of simple shear is not computed";
            mode.ok_or_else(|| input(message, "use another test"))
        });
        let mode = raised(py, mode)?;
        caught(py, || stable_range(&*self.card.law, mode).into())
    }

    /// Nominal stress in MPa at each stretch λ, or at each 1 + γ of simple shear.
    fn stress<'py>(
        &self,
        py: Python<'py>,
        test: &str,
        stretches: PyReadonlyArray1<'py, f64>,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let mode = raised(py, mode(test))?;
        let stretches = stretches.as_slice()?;
        let law: &dyn HyperelasticLaw = &*self.card.law;
        let at = |stretch: &f64| match mode {
            Some(mode) => mode.nominal_stress(law, stretch - 1.0),
            None => simple_shear(law, stretch - 1.0),
        };
        let stresses = caught(py, || stretches.iter().map(at).collect())?;
        Ok(PyArray1::from_vec(py, stresses))
    }
}

/// The test of a name; `None` for simple shear.
fn mode(name: &str) -> Result<Option<Mode>, Error> {
    let [uniaxial, planar, equibiaxial] = Mode::ALL.map(|(name, mode)| (name, Some(mode)));
    let tests = [uniaxial, planar, equibiaxial, ("shear", None)];
    choice("test", name, &tests)
}

/// The names and titles of the cards that come along.
#[pyfunction]
pub fn materials(py: Python<'_>) -> PyResult<Vec<(String, String)>> {
    let read = |(name, text): &(&str, &str)| {
        let card = Card::parse(name, &format!("{name}.toml"), text);
        card.map(|card| (card.name, card.title))
    };
    raised(py, CARDS.iter().map(read).collect())
}

/// The names and energies of the laws.
#[pyfunction]
pub fn laws() -> Vec<(&'static str, &'static str)> {
    LAWS.iter().map(|law| (law.name, law.formula)).collect()
}
