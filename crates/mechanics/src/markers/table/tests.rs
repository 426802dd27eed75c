use std::fs;
use std::path::PathBuf;

use crate::error::Error;
use crate::markers::{Marker, MarkerFiles, ReadSettings, read, read_lines};

/// Reads texts as files of these names.
fn read_texts(files: &[(&str, &str)], reading: &ReadSettings) -> Result<MarkerFiles, Error> {
    let folder = tempfile::tempdir().unwrap();
    let write = |(name, text): &(&str, &str)| {
        let path = folder.path().join(name);
        fs::write(&path, text).unwrap();
        path
    };
    let paths: Vec<PathBuf> = files.iter().map(write).collect();
    read(&paths, reading)
}

fn unit(unit: f64) -> ReadSettings {
    ReadSettings {
        unit: Some(unit),
        ..ReadSettings::default()
    }
}

fn marker(number: usize, position: [f64; 2], displacement: [f64; 2]) -> Marker {
    Marker {
        number,
        position,
        displacement,
        standard_deviation: None,
    }
}

/// Compares the markers of the first frame.
fn first_frame_is(measured: &MarkerFiles, expected: &[Marker]) {
    near(&measured.series.frames[0].markers, expected);
}

fn near(markers: &[Marker], expected: &[Marker]) {
    assert_eq!(markers.len(), expected.len(), "{markers:?}");
    for (marker, expected) in markers.iter().zip(expected) {
        assert_eq!(marker.number, expected.number);
        for axis in 0..2 {
            assert!(
                (marker.position[axis] - expected.position[axis]).abs() < 1e-12,
                "{marker:?}"
            );
            let miss = marker.displacement[axis] - expected.displacement[axis];
            assert!(miss.abs() < 1e-12, "{marker:?}");
        }
        match (marker.standard_deviation, expected.standard_deviation) {
            (Some(a), Some(b)) => assert!((a - b).abs() < 1e-12),
            (a, b) => assert_eq!(a, b),
        }
    }
}

#[test]
fn columns_are_read_with_units_frames_and_holes() {
    let text = "frame,x [cm],y [mm],ux [um],uy_mm,standard deviation [mm],time [s]\n\
                1,1,2,500,0.25,0.1,0.5\n1,2,2,NaN,0.25,0.1,0.5\n3,1,2,1000,0.5,,1.5\n3,2,2,-1000,,,1.5\n";
    let measured = read_texts(&[("a.csv", text)], &ReadSettings::default()).unwrap();
    let [first, second] = &measured.series.frames[..] else {
        panic!("two frames");
    };
    assert_eq!((first.number, first.time), (1, Some(0.5)));
    assert_eq!((second.number, second.time), (3, Some(1.5)));
    let with = Marker {
        standard_deviation: Some(0.1),
        ..marker(0, [10.0, 2.0], [0.5, 0.25])
    };
    near(&first.markers, &[with]);
    near(&second.markers, &[marker(0, [10.0, 2.0], [1.0, 0.5])]);
    let warnings: Vec<_> = measured.warnings.iter().map(ToString::to_string).collect();
    let expected = [
        "in different units, cm and mm",
        "points without a displacement: 2",
        "frames are missing: 2",
    ];
    for (warning, expected) in warnings.iter().zip(expected) {
        assert!(warning.contains(expected), "{warning}");
    }
    assert_eq!(warnings.len(), expected.len(), "{warnings:?}");
}

/// The first lines of a file among DICe's regression tests, shortened, and one point that was lost.
const DICE: &str = "***\n*** Digital Image Correlation Engine (DICe)\n*** Step size: x 35 y 35 (-1 implies not regular grid)\n\
*** Coordinates given with (0,0) as upper left corner of image, x positive right, y positive down\n***\n\
SUBSET_ID,COORDINATE_X,COORDINATE_Y,DISPLACEMENT_X,DISPLACEMENT_Y,SIGMA,GAMMA,BETA,STATUS_FLAG\n\
0,6.1000E+01,9.7100E+02,-6.2872E-02,-7.8897E-01,2.0E-02,2.7021E-03,0,4\n\
1,6.1000E+01,9.3600E+02,0,0,-1.0000E+00,-1,0,11\n\
2,6.1000E+01,9.0100E+02,-7.3856E-02,-8.5842E-01,3.0E-02,3.4787E-03,0,4\n";

#[test]
fn dice_is_read_in_pixels_and_its_y_axis_turned_up() {
    let measured = read_texts(&[("DICe_solution_07.txt", DICE)], &unit(0.5)).unwrap();
    assert_eq!(measured.understood.layout, "DICe");
    let with = |deviation, marker| Marker {
        standard_deviation: Some(deviation),
        ..marker
    };
    first_frame_is(
        &measured,
        &[
            with(0.01, marker(0, [30.5, -485.5], [-0.031436, 0.394485])),
            with(0.015, marker(2, [30.5, -450.5], [-0.036928, 0.42921])),
        ],
    );
    let error = read_texts(&[("a.txt", DICE)], &ReadSettings::default()).unwrap_err();
    assert!(error.to_string().contains("is in pixels"), "{error}");
}

#[test]
fn points_that_vic_and_dice_did_not_find_are_lost() {
    for (head, rows, layout) in [
        (
            "X [mm],Y [mm],Z [mm],U [mm],V [mm],W [mm],exx [1],sigma [pixel]",
            "1,2,50,3,4,0,0,0.02\n2,2,0,0,0,0,0,-1\n",
            "VIC-3D",
        ),
        (
            "COORDINATE_X,COORDINATE_Y,MODEL_COORDINATES_X,MODEL_COORDINATES_Y,DISPLACEMENT_X,DISPLACEMENT_Y,\
             MODEL_DISPLACEMENT_X,MODEL_DISPLACEMENT_Y,SIGMA",
            "61,971,1,2,9,9,3,4,0.02\n71,971,2,2,0,0,0,0,-1\n",
            "DICe, stereo",
        ),
        // Early versions have MATCH instead of SIGMA.
        (
            "COORDINATE_X,COORDINATE_Y,DISPLACEMENT_X,DISPLACEMENT_Y,GAMMA,MATCH",
            "1,-2,3,-4,0,0\n2,-2,3,-4,0,-1\n",
            "DICe",
        ),
    ] {
        let text = format!("{head}\n{rows}");
        let measured = read_texts(&[("a.csv", &text)], &unit(1.0)).unwrap();
        assert_eq!(measured.understood.layout, layout);
        first_frame_is(&measured, &[marker(0, [1.0, 2.0], [3.0, 4.0])]);
        assert_eq!(measured.series.lost, [[2.0, 2.0]]);
    }
}

#[test]
fn an_unknown_unit_is_stated_by_the_user() {
    let text = "x（毫米）,y（毫米）,ux（毫米）,uy（毫米）\n1,2,3,4\n5,2,3,4\n";
    let error = read_texts(&[("a.csv", text)], &ReadSettings::default()).unwrap_err();
    assert!(
        error.to_string().contains("`毫米` is not a unit of length"),
        "{error}"
    );
    let measured = read_texts(&[("a.csv", text)], &unit(2.0)).unwrap();
    near(
        &measured.series.frames[0].markers[..1],
        &[marker(0, [2.0, 4.0], [6.0, 8.0])],
    );
}

#[test]
fn tables_that_only_look_like_those_of_a_program_are_read_as_they_are() {
    for head in [
        "x [mm],y [mm],u [mm],v [mm],exx,sigma [mm]",
        "X [mm],Y [mm],Ux [mm],Uy [mm],exx,sigma [mm]",
    ] {
        let text = format!("{head}\n1,2,3,4,0,0.5\n");
        let measured = read_texts(&[("a.csv", &text)], &ReadSettings::default()).unwrap();
        assert_eq!(measured.understood.layout, "columns");
        let first = measured.series.frames[0].markers[0];
        assert_eq!(
            (first.position, first.standard_deviation),
            ([1.0, 2.0], Some(0.5))
        );
    }
    let text = "x [mm],y [mm],displacement_x [mm],displacement_y [mm]\n1,2,3,4\n";
    let error = read_texts(&[("a.csv", text)], &ReadSettings::default()).unwrap_err();
    assert!(
        error
            .to_string()
            .contains("--columns x=NAME,y=NAME,ux=NAME,uy=NAME"),
        "{error}"
    );
}

#[test]
fn mudic_gives_positions_in_the_frame() {
    let text = "id,x,y,ux,uy,true_strain_xx,true_strain_yy,true_strain_xy,eng_strain_xx,eng_strain_yy,eng_strain_xy\n\
                0,110.0,52.0,10.0,2.0,0,0,0,0,0,0\n1,130.0,52.0,nan,2.0,0,0,0,0,0,0\n";
    let measured = read_texts(&[("frame_3.csv", text)], &unit(0.1)).unwrap();
    assert_eq!(measured.understood.layout, "muDIC");
    first_frame_is(&measured, &[marker(0, [10.0, -5.0], [1.0, -0.2])]);
}

#[test]
fn positions_in_the_frame_are_those_of_the_same_markers_in_all_frames() {
    let head = "x [mm],y [mm],ux [mm],uy [mm]\n";
    // The third one lies between two of the multiples of 6.4e-8 mm to which positions of this field are rounded.
    let texts = [
        "0.3,1,0.1,0\n64.1,1,0.1,0\n1.1001,1,0.1,0\n",
        "0.57,1,0.37,0\n64.37,1,0.37,0\n1.3701,1,0.37,0\n",
    ];
    let [first, second] = texts.map(|rows| format!("{head}{rows}"));
    let reading = ReadSettings {
        deformed: Some(true),
        ..ReadSettings::default()
    };
    let files = [("1.csv", &*first), ("2.csv", &*second)];
    let measured = read_texts(&files, &reading).unwrap();
    let numbers = measured.series.frames.iter().map(|frame| {
        let markers = frame.markers.iter();
        markers.map(|marker| marker.number).collect::<Vec<_>>()
    });
    assert_eq!(numbers.collect::<Vec<_>>(), [[0, 1, 2], [0, 1, 2]]);
    assert_eq!(measured.series.positions().len(), 3);
}

#[test]
fn motions_out_of_the_plane_have_their_own_unit() {
    let text = "x [mm],y [mm],ux [mm],uy [mm],uz [um]\n1,2,3,4,10\n";
    let measured = read_texts(&[("a.csv", text)], &ReadSettings::default()).unwrap();
    first_frame_is(&measured, &[marker(0, [1.0, 2.0], [3.0, 4.0])]);
}

#[test]
fn a_file_of_several_frames_stands_alone() {
    let text = "frame,x [mm],y [mm],ux [mm],uy [mm]\n1,0,0,1,0\n2,0,0,2,0\n";
    let settings = ReadSettings::default();
    let alone = read_texts(&[("a.csv", text)], &settings).unwrap();
    assert_eq!(alone.series.frames.len(), 2);
    let error = read_texts(&[("a.csv", text), ("b.csv", text)], &settings).unwrap_err();
    assert!(error.to_string().contains("has 2 frames"), "{error}");
}

#[test]
fn ncorr_keeps_matrices() {
    let (u, v) = ("0,1,2\n0,3,NaN\n", "0,-1,-2\n0,0,1\n");
    let reading = ReadSettings {
        grid: Some(0.5),
        ..unit(2.0)
    };
    let files = [("frame_2_v.csv", v), ("frame_2_u.csv", u)];
    let measured = read_texts(&files, &reading).unwrap();
    assert_eq!(measured.understood.layout, "Ncorr");
    first_frame_is(
        &measured,
        &[
            marker(0, [0.5, 0.0], [2.0, 2.0]),
            marker(1, [1.0, 0.0], [4.0, 4.0]),
            marker(2, [0.5, -0.5], [6.0, 0.0]),
        ],
    );
    let error = read_texts(&files, &unit(1.0)).unwrap_err().to_string();
    assert!(error.contains("--grid"), "{error}");
    let error = read_texts(&[("1_u.csv", u), ("1_v.csv", "1,2\n")], &reading).unwrap_err();
    assert!(error.to_string().contains("has 2 × 3 entries"), "{error}");
}

#[test]
fn files_are_frames_by_the_numbers_of_their_names() {
    let text = "x [mm],y [mm],u [mm],v [mm]\n0,0,1,0\n1,0,1,0\n";
    let files = [
        ("a_09.csv", text),
        ("a_11.csv", text),
        ("a_10.csv", text),
        ("a_13.csv", text),
    ];
    let measured = read_texts(&files, &ReadSettings::default()).unwrap();
    let numbers: Vec<_> = measured
        .series
        .frames
        .iter()
        .map(|frame| frame.number)
        .collect();
    assert_eq!(numbers, [9, 10, 11, 13]);
    assert!(
        measured.warnings[0]
            .to_string()
            .contains("frames are missing: 12")
    );
    assert_eq!(measured.series.positions(), [[0.0, 0.0], [1.0, 0.0]]);
}

#[test]
fn unusable_tables_are_refused_with_line_and_remedy() {
    for (text, reason) in [
        (
            "x [mm],y [mm],ux [mm]\n1,2,3\n",
            "a.csv:1: there is no column `uy`",
        ),
        ("1,2,3,4\n", "the columns have no names"),
        (
            "x,y [mm],ux [mm],uy [mm]\n1,2,3,4\n",
            "the column `x` has no unit",
        ),
        (
            "x [N],y [mm],ux [mm],uy [mm]\n1,2,3,4\n",
            "`N` is not a unit of length",
        ),
        (
            "x [mm],y [mm],ux [mm],uy [mm]\n1,2,3,lost\n",
            "a.csv:2: column `uy`: \"lost\" is not a number",
        ),
        (
            "x [mm],y [mm],ux [mm],uy [mm]\n1,NaN,3,4\n",
            "a.csv:2: a marker has no position",
        ),
        (
            "x [mm],y [mm],ux [mm],uy [mm]\n1,2,NaN,4\n",
            "no point of the field has a displacement",
        ),
        (
            "x [mm],y [mm],ux [mm],uy [mm]\n1,2,0,0\n2,2,0,0\n",
            "zero everywhere",
        ),
        (
            "x [mm],y [mm],ux [m],uy [m]\n1,2,3,4\n9,2,3,4\n",
            "in different units",
        ),
        (
            "frame,x [mm],y [mm],ux [mm],uy [mm]\n1.5,1,2,3,4\n",
            "a frame number is not a whole number",
        ),
        (
            "x [mm],y [mm],ux [mm],uy [mm],uy [mm]\n1,2,3,4,5\n",
            "the column `uy` repeats another column",
        ),
        (
            "x [mm],y [mm],ux [mm],uy [mm],standard_devation [mm]\n1,2,3,4,5\n",
            "did you mean `standard_deviation`?",
        ),
        (
            "x [mm],y [mm],ux [mm],uy [mm],temperature\n1,2,3,4,5\n",
            "the column `temperature` is not known here",
        ),
        (
            "x [mm],y [mm],ux [mm],uy [mm],uz [mm]\n1,2,3,4,1\n",
            "the points do not stay in a plane: `uz` reaches 1.0000",
        ),
        (
            "x [mm],y [mm],ux [mm],uy [mm],uz [m]\n1,2,3,4,0.001\n",
            "the points do not stay in a plane: `uz` reaches 1.0000",
        ),
        (
            "x [mm],y [mm],ux [mm],uy [mm],sigma [mm]\n1,2,3,4,-1\n",
            "deviation is negative",
        ),
    ] {
        let error = read_texts(&[("a.csv", text)], &ReadSettings::default()).unwrap_err();
        assert!(error.to_string().contains(reason), "{text:?}: {error}");
        assert!(error.to_string().contains('('), "a remedy: {error}");
    }
}

#[test]
fn columns_are_ignored_on_request_and_harmless_ones_always() {
    let text = "x [mm],y [mm],ux [mm],uy [mm],uz [mm],exx,Strain YY,temperature [C]\n1,2,3,4,9,0,0,20\n5,2,3,4,9,0,0,20\n";
    let reading = ReadSettings {
        ignored_columns: vec!["temperature".into(), "uz".into()],
        ..ReadSettings::default()
    };
    let measured = read_texts(&[("a.csv", text)], &reading).unwrap();
    assert_eq!(measured.series.frames[0].markers.len(), 2);
}

#[test]
fn a_given_unit_corrects_a_head_that_names_one_unit_throughout() {
    let text = "x [mm],y [mm],ux [mm],uy [mm]\n0.01,0.02,0.001,0\n0.03,0.02,0.001,0\n";
    let measured = read_texts(&[("a.csv", text)], &unit(1000.0)).unwrap();
    first_frame_is(
        &measured,
        &[
            marker(0, [10.0, 20.0], [1.0, 0.0]),
            marker(1, [30.0, 20.0], [1.0, 0.0]),
        ],
    );
    let warning = measured.warnings[0].to_string();
    assert!(
        warning.contains("states mm, --unit states 1000 mm"),
        "{warning}"
    );
    // Different units are not corrected.
    let text = "x [mm],y [mm],ux [um],uy [um]\n10,20,1000,0\n30,20,1000,0\n";
    let measured = read_texts(&[("a.csv", text)], &unit(1000.0)).unwrap();
    assert_eq!(
        measured.series.frames[0].markers[1],
        marker(1, [30.0, 20.0], [1.0, 0.0])
    );
}

#[test]
fn duplicate_rows_count_once_and_lost_markers_keep_their_positions() {
    let text = "x [mm],y [mm],ux [mm],uy [mm]\n0,0,1,2\n0,0,1,2\n0,0,1,2.5\n9,0,1,2\n9,9,,\n";
    let measured = read_texts(&[("a.csv", text)], &ReadSettings::default()).unwrap();
    first_frame_is(
        &measured,
        &[
            marker(0, [0.0, 0.0], [1.0, 2.0]),
            marker(0, [0.0, 0.0], [1.0, 2.5]),
            marker(1, [9.0, 0.0], [1.0, 2.0]),
        ],
    );
    assert_eq!(
        measured.series.positions(),
        [[0.0, 0.0], [9.0, 0.0], [9.0, 9.0]]
    );
    let warnings: Vec<_> = measured.warnings.iter().map(ToString::to_string).collect();
    assert!(
        warnings[1].contains("duplicate rows") && warnings[1].contains(": 1"),
        "{warnings:?}"
    );
    assert!(
        warnings[2].contains("measured again at the same position"),
        "{warnings:?}"
    );
    // What is found in one frame is not lost.
    let text = "frame,x [mm],y [mm],ux [mm],uy [mm]\n1,0,0,1,2\n1,9,0,1,2\n2,0,0,,\n2,9,0,1,2\n";
    let measured = read_texts(&[("a.csv", text)], &ReadSettings::default()).unwrap();
    assert!(measured.series.lost.is_empty());
}

#[test]
fn lines_of_an_outline_have_numbers_or_names() {
    let read = |labels: [&str; 3]| {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("outline.csv");
        let [first, again, other] = labels;
        let text = format!("x [cm],y [cm],line\n0,0,{first}\n1,0,{again}\n0,1,{other}\n");
        fs::write(&path, text).unwrap();
        read_lines(&path, None)
    };
    for labels in [
        ["1", "1.0", "2"],
        ["outer", "outer ", "hole 1"],
        ["outer", "outer", "2"],
    ] {
        let expected = [vec![[0.0, 0.0], [10.0, 0.0]], vec![[0.0, 10.0]]];
        assert_eq!(read(labels).unwrap(), expected, "{labels:?}");
    }
    let error = read(["outer", "", "hole"]).unwrap_err().to_string();
    assert!(error.contains("no line is named"), "{error}");
}
