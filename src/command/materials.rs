//! `gelbench materials …`.

use std::path::{Path, PathBuf};

use clap::Subcommand;

use super::convert::{ConvertArguments, convert};
use super::fit::{FitArguments, fit, load, refit};
use super::group::{GroupArguments, group};
use super::message;
use super::new_card::{CheckCards, NEW_HELP, NewCard, check_cards, new_card};
use super::terminal::{Outcome, print, save, together};
use gelbench_base::error::Error;
use gelbench_mechanics::material::registry::{CARDS, LAWS};
use gelbench_report::output;
use gelbench_report::results::{
    Drawing, PictureFormat, PictureStyle, card_curves, comparison_chart,
};

#[derive(Subcommand)]
pub enum Materials {
    /// List the shipped cards and the laws
    List,
    /// Show one card: law, parameters, moduli, curves, stable range, source
    #[command(after_help = "Sample: gelbench materials show pva-10")]
    Show {
        /// Name of a shipped card, or path of a card ending in .toml
        card: String,
    },
    /// Plot the curves of a card: uniaxial, planar and equibiaxial tension, simple shear; loading and unloading if it
    /// softens; modulus against time, storage and loss modulus against frequency if it relaxes
    #[command(
        after_help = "Sample: gelbench materials plot pva-10    writes output/materials/pva-10_curves.png"
    )]
    Plot {
        /// Name of a shipped card, or path of a card ending in .toml
        card: String,
        /// The picture, a .png, .svg or .pdf; output/materials/ and the card's name with _curves.png if omitted
        #[arg(long, value_name = "FILE")]
        output: Option<PathBuf>,
    },
    /// Plot the uniaxial curves of several cards in one picture and print their moduli
    #[command(after_help = "Sample: gelbench materials compare pva-10 pva-10-cauchy neo-hooke")]
    Compare {
        /// Names of shipped cards, or paths of cards ending in .toml
        #[arg(required = true, num_args = 2..)]
        cards: Vec<String>,
        /// The picture, a .png, .svg or .pdf
        #[arg(
            long,
            value_name = "FILE",
            default_value = "output/materials/comparison.png"
        )]
        output: PathBuf,
    },
    /// Write a card of what is known: moduli and parameters, without a test
    #[command(after_help = NEW_HELP)]
    New(Box<NewCard>),
    /// Read cards and report every fault; with --share also what others would have to know
    #[command(after_help = "Sample: gelbench materials check materials/my_gel.toml --share")]
    Check(CheckCards),
    /// Fit a law to measured curves and write a card, a picture and the figures
    #[command(after_help = FIT_HELP)]
    Fit(Box<FitArguments>),
    /// Fit a law to every specimen of a group: mean law, spread between specimens, and the difference from another group
    #[command(
        after_help = "Sample: gelbench materials group c1.csv c2.csv c3.csv --against t1.csv t2.csv t3.csv --names control,treated --law yeoh"
    )]
    Group(Box<GroupArguments>),
    /// Refit a card to the data that it names, and report whether the parameters agree
    #[command(after_help = "Sample: gelbench materials refit treloar-ogden-3")]
    Refit {
        /// Name of a shipped card, or path of a card ending in .toml
        card: String,
    },
    /// Write test data in another stress measure, strain measure or unit
    #[command(
        after_help = "Sample: gelbench materials convert tensile.csv --to-stress cauchy --to-unit kPa --output true.csv"
    )]
    Convert(Box<ConvertArguments>),
}

const FIT_HELP: &str = "\
A file of test data is a table with a line of names and units, and says what was tested:

  # test: uniaxial
  stretch [-],nominal_stress [MPa]
  1.00,0.000
  1.05,0.013

Strains: stretch, nominal_strain, logarithmic_strain, or displacement with `# length: 50 mm`.
Stresses: nominal_stress, cauchy_stress, or force with `# area: 20 mm^2`; in biaxial tests also …_1 and …_2.
What the file does not say must be given by the options; nothing is guessed.

Samples:
  gelbench materials fit tensile.csv --law yeoh
  gelbench materials fit uniaxial.csv equibiaxial.csv planar.csv --law ogden-3 --weighting relative
  gelbench materials fit tensile.csv --all
  gelbench materials fit ramp_and_hold.csv --law neo-hooke --relaxation
  gelbench materials fit cycles.csv --law yeoh --softening
  gelbench materials fit machine.csv --law gent --test uniaxial --area \"20 mm^2\" --length \"5 cm\" --bound jm=5..200";

/// Runs one of the commands.
pub fn run(command: Materials) -> Outcome {
    match command {
        Materials::List => list(),
        Materials::Show { card } => show(&card),
        Materials::Plot { card, output } => plot(&card, output),
        Materials::Compare { cards, output } => compare(&cards, &output),
        Materials::New(options) => new_card(&options),
        Materials::Check(options) => check_cards(&options),
        Materials::Fit(arguments) => fit(*arguments),
        Materials::Group(arguments) => group(*arguments),
        Materials::Refit { card } => refit(&card),
        Materials::Convert(arguments) => convert(*arguments),
    }
}

fn list() -> Outcome {
    let mut text = String::from("Cards:\n");
    for (name, _) in CARDS {
        text += &message::card_line(&load(name)?);
    }
    text += "\nLaws:\n";
    for law in LAWS {
        text += &format!("{:<22} {}\n", law.name, law.formula);
    }
    print(&text)?;
    Ok(0)
}

fn show(name: &str) -> Outcome {
    print(&message::card(&load(name)?))?;
    Ok(0)
}

fn plot(name: &str, file: Option<PathBuf>) -> Outcome {
    let card = load(name)?;
    let stem = Path::new(name.strip_suffix(".toml").unwrap_or(name))
        .file_name()
        .map_or_else(String::new, |stem| stem.to_string_lossy().into_owned());
    let file =
        file.unwrap_or_else(|| Path::new("output/materials").join(format!("{stem}_curves.png")));
    output::refuse_inputs(&file, &[Path::new(name)])?;
    save_picture(&file, &card_curves(&card))?;
    print(&format!("{} written\n", file.display()))?;
    Ok(0)
}

fn compare(names: &[String], file: &Path) -> Outcome {
    let cards = together(names.iter().map(|name| load(name)))?;
    let inputs: Vec<&Path> = names.iter().map(Path::new).collect();
    output::refuse_inputs(file, &inputs)?;
    save_picture(file, &comparison_chart(&cards).into())?;
    let lines: String = cards.iter().map(message::moduli_line).collect();
    print(&format!("{lines}{} written\n", file.display()))?;
    Ok(0)
}

/// Draws the requested picture in the format of its ending; that it cannot be drawn is a fault here, as there is no other result.
fn save_picture(file: &Path, drawing: &Drawing) -> Result<(), Error> {
    let ending = file.extension().unwrap_or_default();
    let mut formats = PictureFormat::NAMES.into_iter();
    let format = formats.find(|(name, _)| ending.eq_ignore_ascii_case(name));
    let format = format.map_or(PictureFormat::Png, |(_, format)| format);
    let picture = output::picture(drawing, format, &PictureStyle::default());
    save(file, &picture.map_err(|fault| Error::write(file, fault))?)
}
