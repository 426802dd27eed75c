//! The form of a law in other codes.

use crate::document::name_of;

/// A finite-element code that problems are exported to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Code {
    /// Abaqus/Standard.
    Abaqus,
    /// CalculiX.
    CalculiX,
    /// FEBio 4.
    FeBio,
}

impl Code {
    /// The codes by the names that the command line uses.
    pub const NAMES: [(&'static str, Self); 3] = [
        ("abaqus", Self::Abaqus),
        ("calculix", Self::CalculiX),
        ("febio", Self::FeBio),
    ];

    /// The name that the command line uses.
    pub fn key(self) -> &'static str {
        name_of(&Self::NAMES, self)
    }

    /// The code's name as its makers write it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Abaqus => "Abaqus",
            Self::CalculiX => "CalculiX",
            Self::FeBio => "FEBio",
        }
    }

    /// The extension of its input files.
    pub fn ending(self) -> &'static str {
        match self {
            Self::Abaqus | Self::CalculiX => "inp",
            Self::FeBio => "feb",
        }
    }

    /// The laws of gelbench that the code has, for messages.
    pub fn laws(self) -> &'static str {
        match self {
            Self::Abaqus => {
                "neo-Hooke, Mooney-Rivlin, polynomials, Yeoh, Ogden, Arruda-Boyce, Holzapfel-Gasser-Ogden, Fung, and Marlow for laws of the first invariant"
            }
            Self::CalculiX => {
                "neo-Hooke, Mooney-Rivlin, polynomials, Yeoh, Ogden to three terms and Arruda-Boyce"
            }
            Self::FeBio => {
                "neo-Hooke, Mooney-Rivlin to the second order, Ogden, Gent, Veronda-Westmann and Holzapfel-Gasser-Ogden"
            }
        }
    }
}

/// A law in the form of another code.
#[derive(Clone, Debug, PartialEq)]
pub enum CodeLaw {
    /// A law that the code has.
    Named {
        /// The code's keyword with its options: `OGDEN, N=2`.
        keyword: String,
        /// Parameters by name, in the order in which the code reads them.
        parameters: Vec<(String, f64)>,
        /// Unit vectors along the fibres (Abaqus), or along the first material axis (Fung's law; FEBio where it is not
        /// that of the sheet).
        directions: Vec<[f64; 2]>,
    },
    /// Marlow's law by points of the tension curve: exact where the energy depends on I₁ alone, wrong otherwise.
    TensionCurve,
}

impl CodeLaw {
    /// A law without directions.
    pub fn named<S: Into<String>>(
        keyword: &str,
        parameters: impl IntoIterator<Item = (S, f64)>,
    ) -> Option<Self> {
        Self::directed(keyword, parameters, &[])
    }

    /// A law with directions.
    pub fn directed<S: Into<String>>(
        keyword: &str,
        parameters: impl IntoIterator<Item = (S, f64)>,
        directions: &[[f64; 2]],
    ) -> Option<Self> {
        let parameters = parameters.into_iter();
        Some(Self::Named {
            keyword: keyword.into(),
            parameters: parameters
                .map(|(name, value)| (name.into(), value))
                .collect(),
            directions: directions.into(),
        })
    }

    /// The form of a law whose energy depends on I₁ alone and that no code has by name: Abaqus has Marlow's.
    pub fn of_first_invariant(code: Code) -> Option<Self> {
        (code == Code::Abaqus).then_some(Self::TensionCurve)
    }
}
