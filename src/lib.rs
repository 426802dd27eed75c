//! A workbench for sheets of soft tissue and hydrogel at large strains.
//!
//! gelbench solves one problem in three ways: with a lattice of springs, with hyperelastic finite elements, and with
//! the *corrector*, which takes any displacement field and finds the nearest one that satisfies equilibrium and what is
//! known at the boundary. The given field may come from springs, from another program, or from a camera.
//!
//! # Ten lines
//!
//! A clamped plate of 10 % PVA hydrogel, 150 × 50 × 2 mm, stretched by a half; corrected on 60 × 20 cells:
//!
//! ```
//! use std::path::Path;
//! use gelbench::corrector::{DifferenceScheme, climb::{Climb, ClimbSettings}};
//! use gelbench::{material::Card, problem::ClampedPlate};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let law = Card::load("pva-10", Path::new("."))?.law;
//! let plate = ClampedPlate { size: [150.0, 50.0], thickness: 2.0, law, stretches: vec![0.5] };
//! let scheme = DifferenceScheme::default();
//! let mut climb = Climb::even(&plate, [60, 20], scheme, ClimbSettings::default());
//! let corrected = climb.correct(0.5)?;
//! let sheet = climb.deformed(&corrected);
//! let [ux, uy] = sheet.displacement_at([75.0, 50.0])?;
//! let stress = sheet.stress_at([75.0, 25.0])?.cauchy[0];
//! println!("{:.3} N, edge at ({ux:.3}, {uy:.3}) mm, {stress:.5} MPa", corrected.force);
//! # assert!((corrected.force - 12.87459).abs() < 0.01, "{}", corrected.force);
//! # assert!((ux - 37.5).abs() < 1e-3 && (uy + 4.6405).abs() < 1e-3, "{ux} {uy}");
//! # assert!((stress - 0.1946).abs() < 1e-4, "{stress}");
//! # Ok(())
//! # }
//! ```
//!
//! Lengths are in mm, forces in N, stresses in MPa, times in s and masses in tonnes, everywhere. Points are given by
//! their coordinates at rest.
//!
//! The [guide] continues from here, page by page. The programs in `examples/` do the same in files of their own.
//!
//! # What to use for what
//!
//! These modules contain the names that a version keeps. They are re-exported from the crates in which they are defined,
//! whose documentation has the equations; each module says which.
//!
//! | to … | use |
//! |---|---|
//! | convert quantities with units; understand an error; name an estimate with its interval | [`units`], [`error`], [`statistics`] |
//! | limit the memory and work that a study may need | [`budget`] |
//! | read a table; give files that are in memory to what reads files | [`document`] |
//! | mesh a shape, an outline or a file; evaluate a field at a point | [`mesh`] |
//! | load a material card, write a law of your own, plot its curves | [`material`] |
//! | minimise an energy along a path of load factors | [`solve`] |
//! | state how a sheet is supported and loaded; get displacement and stress at a point | [`problem`] |
//! | read measured markers | [`markers`] |
//! | solve a problem with springs, with finite elements, or in time | [`mass_spring`], [`finite_element`], [`dynamics`] |
//! | correct a field with conditions of your own; correct a plate; estimate a field from markers | [`corrector`], [`corrector::climb`], [`estimation`] |
//! | fit a law to test data; find springs and dashpots in a recording | [`calibration`], [`identification`] |
//! | compare two fields, with the reference's own error | [`compare`] |
//! | solve, compare and report what a study asks for | [`studies`], [`results`] |
//! | write reports, pictures, VTK files, or the input of another code | [`output`] |
//! | read a study file of any kind, and compute it as the command does | [`kinds`] |
//! | run a study many times with some of its keys changed | [`sweep`] |
//! | call the command itself | [`command`] |
#![warn(missing_docs)]
#![forbid(unsafe_code)]

#[cfg(feature = "command")]
pub mod command;
pub mod guide;
pub mod kinds;
pub mod sweep;

/// Limits on the memory and work that a study may need ([`gelbench_base::budget`]).
pub mod budget {
    pub use gelbench_base::budget::Budget;
}

/// From test data to a law, with the uncertainty of its parameters ([`gelbench_calibration::calibration`]).
pub mod calibration {
    pub use gelbench_calibration::calibration::{
        Answer, Bounds, Fit, FitSettings, Memory, Provenance, Terms, TestData, Weighting, best,
        card_text, fit, fit_relaxation, rank,
    };
}

/// How far a field is from another one, in percent ([`gelbench_report::compare`]).
pub mod compare {
    pub use gelbench_report::compare::{departure_percent, displacement_percent};
}

/// The field nearest to a given one that satisfies equilibrium and what is known at the boundary
/// ([`gelbench_corrector::corrector`]).
pub mod corrector {
    pub use gelbench_corrector::corrector::{
        Condition, Correction, Corrector, CorrectorSettings, DifferenceScheme, Equilibrium,
        Function, Linear, Linearisation, Multipliers, Solver,
    };

    /// A plate is corrected on a coarse grid, then from grid to grid ([`gelbench_corrector::corrector::climb`]).
    pub mod climb {
        pub use gelbench_corrector::corrector::climb::{
            Climb, ClimbSettings, ClimbSolution, Grips, Interactive,
        };
    }

    /// A sheet of any shape is corrected on a coarse mesh, then from mesh to mesh
    /// ([`gelbench_corrector::corrector::nested`]).
    pub mod nested {
        pub use gelbench_corrector::corrector::nested::{NestedCorrection, NestedMeshes};
    }

    /// A field on a plate is corrected, with a choice of what is known ([`gelbench_corrector::corrector::plate`]).
    pub mod plate {
        pub use gelbench_corrector::corrector::plate::{
            CorrectedState, KnownConditions, PlateCorrector,
        };
    }

    /// A field on a sheet of any shape is corrected ([`gelbench_corrector::corrector::specimen`]).
    pub mod specimen {
        pub use gelbench_corrector::corrector::specimen::{CorrectedField, correct};
    }
}

/// Tables, how they are read, and files that are in memory ([`gelbench_base::document`]).
pub mod document {
    pub use gelbench_base::document::{Key, Statements, Table, TextEncoding, with_files};
}

/// Motion in time, with masses, dashpots and viscosity ([`gelbench_mechanics::dynamics`]).
pub mod dynamics {
    pub use gelbench_mechanics::dynamics::{
        Dashpots, History, Integrator, Motion, MotionEnd, MovingForce, MovingSupport,
        SheetViscosity, Start, TimeFunction, TimeSettings, follow, lumped_mass,
    };
}

/// Errors, by who must act on them ([`gelbench_base::error`]).
pub mod error {
    pub use gelbench_base::error::{Diagnostic, Error, Severity, SolveFault};
}

/// The field nearest to markers that satisfies equilibrium, with a verdict and intervals
/// ([`gelbench_estimation::estimation`]).
pub mod estimation {
    pub use gelbench_estimation::estimation::{
        Answer, EdgeCondition, FieldEstimate, JointEstimate, JointFrame, JointSettings, Knowledge,
        MarkerEstimate, MeasuredForce, Physics, RegressedLaw, Robust, Specimen, Verdict, estimate,
        estimate_jointly,
    };
}

/// The reference: hyperelastic finite elements ([`gelbench_mechanics::finite_element`]).
pub mod finite_element {
    pub use gelbench_mechanics::finite_element::{Element, FiniteElements};
}

/// From recorded force and motion to the functions K(·) and D(·) of a spring with a dashpot
/// ([`gelbench_calibration::identification`]).
pub mod identification {
    pub use gelbench_calibration::identification::{
        Argument, Form, Identification, IdentificationSettings, Recording, Shape, identify,
        law_text,
    };
}

/// Displacements that were measured, or computed elsewhere, at scattered points ([`gelbench_mechanics::markers`]).
pub mod markers {
    pub use gelbench_mechanics::markers::{
        ChosenColumns, Frame, Marker, MarkerFiles, MarkerSeries, ReadSettings, read,
    };
}

/// Lattices of springs along the edges and diagonals of cells ([`gelbench_mechanics::mass_spring`]).
pub mod mass_spring {
    pub use gelbench_mechanics::mass_spring::{DashpotLaw, LatticeSettings, MassSpring};
}

/// Hyperelastic laws, and the cards with their parameters ([`gelbench_mechanics::material`]).
pub mod material {
    pub use gelbench_mechanics::material::{
        ArrudaBoyce, BodyDerivatives, BodyLaw, BodySheet, BodyStretches, Card, Code, CodeLaw,
        CompressibleNeoHooke, EnergyDerivatives, FoamTerm, FungDemiray, Gent, HolzapfelGasserOgden,
        HyperelasticLaw, InvariantLaw, Invariants, LinearElastic, MooneyRivlin, NeoHooke, Network,
        Ogden, OgdenHill, PlaneState, Polynomial, SaintVenantKirchhoff, Softening, VerondaWestmann,
        Volume, VolumeEnergy, Yeoh,
    };

    /// The curves of the usual tests of a sheet ([`gelbench_mechanics::material::curve`]).
    pub mod curve {
        pub use gelbench_mechanics::material::curve::Mode;
    }

    /// All laws and shipped cards by name ([`gelbench_mechanics::material::registry`]).
    pub mod registry {
        pub use gelbench_mechanics::material::registry::{CARDS, LAWS, Law};
    }

    /// The kinematics of a thin sheet, and how a law responds to them ([`gelbench_mechanics::material::sheet`]).
    pub mod sheet {
        pub use gelbench_mechanics::material::sheet::{Kinematics, PlaneTensor, SheetResponse};
    }

    /// The stretches up to which a law is stable ([`gelbench_mechanics::material::stability`]).
    pub mod stability {
        pub use gelbench_mechanics::material::stability::stable_range;
    }

    /// Viscosity and relaxation ([`gelbench_mechanics::material::viscosity`]).
    pub mod viscosity {
        pub use gelbench_mechanics::material::viscosity::{Relaxation, ViscousMaterial};
    }
}

/// Nodes, cells and named groups of a flat specimen, and fields on them ([`gelbench_mechanics::mesh`]).
pub mod mesh {
    pub use gelbench_mechanics::mesh::{
        CellShape, Exemptions, Group, ImportFault, Mesh, MeshData, MeshReading, Misfit, Outline,
        OutlineFault, OutlineOfPoints, Shape, Side, import,
    };
}

/// Files of results: folders, reports, pictures, VTK, and the input of other codes ([`gelbench_report::output`]).
pub mod output {
    pub use gelbench_report::output::REPORT_SCHEMA;
    #[cfg(feature = "pictures")]
    pub use gelbench_report::output::{
        PictureFault, ResultFolder, TakesFiles, picture, png, write,
    };

    /// Input files of Abaqus, CalculiX and FEBio ([`gelbench_report::output::export`]).
    pub mod export {
        pub use gelbench_report::output::export::{Export, InputFile};
    }

    /// Files for ParaView ([`gelbench_report::output::vtk`]).
    pub mod vtk {
        pub use gelbench_report::output::vtk::{files, grid};
    }
}

/// The boundary value problem of a sheet, independent of the method of solution ([`gelbench_mechanics::problem`]).
pub mod problem {
    pub use gelbench_mechanics::problem::{
        BoundaryProblem, ClampedPlate, DeformedSheet, Drive, GroupState, Load, Measures, Model,
        PointFault, Reactions, Solution, Stress, Support,
    };
}

/// Results as data: requirements, quantities, tables, figures and grids ([`gelbench_report::results`]).
pub mod results {
    pub use gelbench_report::results::{
        Array, Block, Check, Content, Drawing, Figure, Grid, GridSeries, Outcome, Results, Sheet,
    };
}

/// Energies, their minimisation along a path of load factors, and sparse rows ([`gelbench_mechanics::solve`]).
pub mod solve {
    pub use gelbench_mechanics::solve::{
        Convergence, Inadmissible, Journal, LinearSolver, Loading, Milestone, NewtonSettings,
        PathEnd, Potential, SparseRows, Stage, State, follow,
    };
}

/// Estimates with their intervals ([`gelbench_base::statistics`]).
pub mod statistics {
    pub use gelbench_base::statistics::Estimate;
}

/// What a study file asks for: read, solved, compared and reported ([`gelbench_studies::studies`]).
pub mod studies {
    pub use gelbench_studies::studies::{Kind, Loaded, PreparedStudy, Progress};

    /// Fields of markers ([`gelbench_studies::studies::markers`]).
    pub mod markers {
        pub use gelbench_studies::studies::markers::{
            Conditions, MarkerStudy, MeshSource, Request,
        };
    }

    /// Sheets in motion ([`gelbench_studies::studies::motion`]).
    pub mod motion {
        pub use gelbench_studies::studies::motion::{MovingSheet, compute, load};
    }

    /// Clamped plates ([`gelbench_studies::studies::plate`]).
    pub mod plate {
        pub use gelbench_studies::studies::plate::{load, prepare};
    }

    /// Specimens of any shape ([`gelbench_studies::studies::specimen`]).
    pub mod specimen {
        pub use gelbench_studies::studies::specimen::{Specimen, compute, load};
    }
}

/// Physical quantities as text with a unit ([`gelbench_base::units`]).
pub mod units {
    pub use gelbench_base::units::{Dimension, Linear, QuantityFault, factor, parse};
}

/// The program in the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
