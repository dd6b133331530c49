//! `kavics draw`: a picture of the assembly at a load step, or of curves.

use kavics_pictures::{
    CurveRequest, Format, Picture, PictureError, Request, Theme, Units, What, draw_curves, write,
};
use kavics_results::{ResultsFolder, check_output};

use crate::draw_arguments as given;
use crate::failure::Failure;

/// Millimetres of an inch.
const INCH: f64 = 25.4;

/// Pixels an inch of vector graphics, after CSS.
const SCREEN: f64 = 96.0;

/// Pixels an inch of pictures for print.
const PRINT: f64 = 300.0;

/// Widths where none is given, mm.
const ASSEMBLY_WIDTH: f64 = 140.0;
const CURVE_WIDTH: f64 = 90.0;

pub fn draw(arguments: &given::DrawArguments) -> Result<(), Failure> {
    let format = Format::of(&arguments.output)?;
    check_output(&arguments.output, &[])?;
    let folder = ResultsFolder::open(&arguments.results)?;
    // Refuses tables of a later version.
    folder.record()?;
    let sheet = Sheet::of(arguments, format);
    let picture = picture(&folder, arguments, sheet.width)?;
    let theme = match arguments.theme {
        given::Theme::Light => Theme::Light,
        given::Theme::Dark => Theme::Dark,
    };
    write(
        &arguments.output,
        &picture,
        theme,
        sheet.pixels_a_millimetre,
    )?;
    Ok(())
}

/// How large a picture is.
struct Sheet {
    width: f64,
    pixels_a_millimetre: f64,
}

impl Sheet {
    fn of(arguments: &given::DrawArguments, format: Format) -> Self {
        let usual = if arguments.curve.is_empty() {
            ASSEMBLY_WIDTH
        } else {
            CURVE_WIDTH
        };
        let width = arguments.width.unwrap_or(given::Length::Millimetres(usual));
        // Pixels are those of a screen, unless the user says how dense they are.
        let resolution = match (arguments.dpi, width) {
            (Some(given), _) if format == Format::Png => given,
            (_, given::Length::Pixels(_)) => SCREEN,
            (_, given::Length::Millimetres(_)) => PRINT,
        };
        Self {
            width: match width {
                given::Length::Millimetres(width) => width,
                given::Length::Pixels(pixels) => pixels / resolution * INCH,
            },
            pixels_a_millimetre: resolution / INCH,
        }
    }
}

fn picture(
    folder: &ResultsFolder,
    arguments: &given::DrawArguments,
    width: f64,
) -> Result<Picture, PictureError> {
    let units = Units {
        length: arguments.length_unit.clone(),
        force: arguments.force_unit.clone(),
    };
    if !arguments.curve.is_empty() {
        let against = arguments.against.clone();
        return draw_curves(
            folder,
            &CurveRequest {
                curves: arguments.curve.clone(),
                against: against.unwrap_or_else(|| "step".to_owned()),
                width,
                units,
            },
        );
    }
    kavics_pictures::draw(
        folder,
        &Request {
            what: what(arguments),
            step: match arguments.step {
                Some(given::Step::Number(step)) => Some(step),
                Some(given::Step::Last) | None => None,
            },
            width,
            deformation: arguments.scale.unwrap_or(0.0),
            colour: arguments.colour.clone(),
            grains: arguments.grains.clone(),
            range: arguments.range,
            largest: arguments.largest,
            broken: arguments.broken,
            legend: true,
            units,
        },
    )
}

fn what(arguments: &given::DrawArguments) -> What {
    match arguments.what {
        Some(given::What::Forces) | None => What::Forces,
        Some(given::What::Graph) => What::Graph,
        Some(given::What::Dual) => What::Dual,
        Some(given::What::Voids) => What::Voids,
        Some(given::What::Damage) => What::Damage,
    }
}
