use super::*;
use image::{ImageBuffer, Luma, Rgb};

#[test]
fn images_of_all_kinds_are_read_as_their_grey_values() {
    let folder = tempfile::tempdir().unwrap();
    let eight: ImageBuffer<Luma<u8>, _> =
        ImageBuffer::from_fn(20, 10, |x, y| Luma([(10 * x + y) as u8]));
    let sixteen: ImageBuffer<Luma<u16>, _> =
        ImageBuffer::from_fn(20, 10, |x, y| Luma([(3000 * x + y) as u16]));
    for name in ["a.png", "a.tif", "a.bmp"] {
        let path = folder.path().join(name);
        eight.save(&path).unwrap();
        let image = pages(&path).unwrap()[0].read().unwrap();
        assert_eq!(
            (image.size(), image.value(7, 3)),
            ([20, 10], 73.0),
            "{name}"
        );
    }
    for name in ["b.png", "b.tif"] {
        let path = folder.path().join(name);
        sixteen.save(&path).unwrap();
        assert_eq!(
            pages(&path).unwrap()[0].read().unwrap().value(7, 3),
            21003.0,
            "{name}"
        );
    }
    let colour: ImageBuffer<Rgb<u8>, _> = ImageBuffer::from_fn(20, 10, |_, _| Rgb([100, 200, 50]));
    let path = folder.path().join("c.png");
    colour.save(&path).unwrap();
    let grey = pages(&path).unwrap()[0].read().unwrap().value(0, 0);
    assert!((grey - 167.91).abs() < 0.01, "{grey}");
}

#[test]
fn pages_of_a_file_and_files_of_a_folder_are_frames_in_order() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("stack.tif");
    let mut encoder = tiff::encoder::TiffEncoder::new(File::create(&path).unwrap()).unwrap();
    for page in 0..3_u8 {
        let values = vec![page; 100];
        encoder
            .write_image::<tiff::encoder::colortype::Gray8>(10, 10, &values)
            .unwrap();
    }
    let all = pages(&path).unwrap();
    let values: Vec<f32> = all
        .iter()
        .map(|page| page.read().unwrap().value(0, 0))
        .collect();
    assert_eq!(values, [0.0, 1.0, 2.0]);
    assert_eq!(all[2].name(), "stack, page 3");
    let image: ImageBuffer<Luma<u8>, _> = ImageBuffer::new(10, 10);
    for name in ["f10.png", "f9.png", "g1.png"] {
        image.save(folder.path().join(name)).unwrap();
    }
    let files = list(&[folder.path().join("f*.png")]).unwrap();
    assert_eq!(
        files.iter().map(ImageFile::name).collect::<Vec<_>>(),
        ["f9", "f10"]
    );
    let of_shell = ["f10.png", "f9.png"].map(|name| folder.path().join(name));
    let of_shell = list(&of_shell).unwrap();
    assert_eq!([of_shell[0].name(), of_shell[1].name()], ["f9", "f10"]);
    assert_eq!(list(&[folder.path().to_owned()]).unwrap().len(), 6);
}

#[test]
fn what_is_no_image_is_refused_with_its_name() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["a.png", "a.tif", "a.jpg"] {
        let path = folder.path().join(name);
        std::fs::write(&path, b"no image").unwrap();
        let fault = list(&[path])
            .and_then(|all| all[0].read())
            .unwrap_err()
            .to_string();
        assert!(fault.contains(name), "{fault}");
    }
    assert!(check_size(100_000, 100_000).is_err() && check_size(4, 100).is_err());
}

/// As the camera images of the DIC Challenge: pixels are numbers of colours.
#[test]
fn pixels_that_are_numbers_of_colours_are_read_as_these_colours() {
    use tiff::encoder::{TiffEncoder, colortype::Gray8};
    use tiff::tags::Tag;
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("palette.tif");
    let mut encoder = TiffEncoder::new(File::create(&path).unwrap()).unwrap();
    encoder.write_image::<Gray8>(10, 10, &[7; 100]).unwrap();
    let mut image = encoder.new_image::<Gray8>(10, 10).unwrap();
    let colours: Vec<u16> = (0..3 * 256).map(|k| 257 * (255 - k % 256)).collect();
    let directory = image.encoder();
    directory
        .write_tag(Tag::PhotometricInterpretation, 3_u16)
        .unwrap();
    directory.write_tag(Tag::ColorMap, &colours[..]).unwrap();
    image.write_data(&(0..100).collect::<Vec<u8>>()).unwrap();
    let all = pages(&path).unwrap();
    let value = |page: usize| all[page].read().unwrap().value(3, 2);
    assert_eq!([value(0), value(1).round()], [7.0, 232.0]);
}
