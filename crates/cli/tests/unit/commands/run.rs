use super::*;

#[test]
fn a_run_file_is_not_named_as_what_is_made_of_one() {
    for name in ["run.h5", "run", "run.nc", "disc.1"] {
        assert!(refuse_other_format("-o", Path::new(name)).is_ok(), "{name}");
    }
    let refused = refuse_other_format("output.file", Path::new("out/a.CSV")).unwrap_err();
    let message = refused.to_string();
    assert_eq!(refused.status, 2);
    assert!(message.starts_with("output.file out/a.CSV: a run file is HDF5"), "{message}");
    assert!(message.contains("such as out/a.h5") && message.contains("export RUN.h5 --to csv"), "{message}");
}
