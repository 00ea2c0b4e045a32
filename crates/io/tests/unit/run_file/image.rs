use super::*;

#[test]
fn extents_that_touch_are_one() {
    let mut values = Values::default();
    for (start, end) in [(10, 20), (30, 40), (20, 25), (50, 60), (25, 30), (60, 61)] {
        values.add(start, end);
    }
    assert_eq!(values.extents.into_iter().collect::<Vec<_>>(), [(10, 40), (50, 61)]);
}

#[test]
fn what_is_no_value_comes_back() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.h5");
    let mut bytes: Vec<u8> = (0..1000_u32).map(|at| if (400..700).contains(&at) { 0 } else { at as u8 }).collect();
    bytes[100..104].copy_from_slice(b"mark");
    fs::write(&path, &bytes).unwrap();
    let mut values = Values::default();
    values.add(200, 300);
    assert_eq!(Image::of(&path, &values, "elsewhere").unwrap(), None);
    let image = Image::of(&path, &values, "mark").unwrap().unwrap();
    assert!(image.pieces.iter().map(|(_, bytes)| bytes.len()).sum::<usize>() <= 600);
    let changed: Vec<u8> = (0..1200).map(|at| if (100..300).contains(&at) { bytes[at] } else { 7 }).collect();
    fs::write(&path, changed).unwrap();
    assert!(image.is_of(&path));
    let restored = image.restore(&path).unwrap();
    assert!(fs::read(restored.path()).unwrap() == bytes);
    fs::write(&path, &bytes[..999]).unwrap();
    assert!(!image.is_of(&path), "it is too short");
    fs::write(&path, [9; 1200]).unwrap();
    assert!(!image.is_of(&path), "it is another file");
}
