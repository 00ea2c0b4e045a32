use super::*;

#[test]
fn runs_that_repeat_another_are_told() {
    assert_eq!(firsts(&["a", "b", "a", "c", "b", "a"].map(str::to_owned)), [0, 1, 0, 3, 1, 0]);
}

#[test]
fn what_does_not_show_in_results_does_not_count() {
    let text = "\ntitle = \"a\"\n[mesh]\nrows = 80\n\n[numerics]\nworkers = 2\n[disc.surface]\nfile = \"a.sdf\"\n\
                    mirror = false\n[output]\nfile = \"a.h5\"\nsample_every = \"1 s\"\n";
    let kept: Vec<&str> = lines(text, shows).filter(|line| line.contains(" = ")).collect();
    assert_eq!(kept, ["rows = 80", "mirror = false", "sample_every = \"1 s\""]);
}

#[test]
fn every_bit_comes_back() {
    let columns = vec![vec![1.0, 2.0, 3.0], vec![f64::NAN, -0.0, 1e-300]];
    let series = Series::new(vec!["time".into(), "pool".into()], columns);
    let back = series.pack().unpack().unwrap();
    let bits = |series: &Series| -> Vec<u64> { series.columns.iter().flatten().map(|value| value.to_bits()).collect() };
    assert_eq!(bits(&back), bits(&series));
    assert_eq!(back.names(), series.names());
}

#[test]
fn a_record_tells_the_time_of_a_pulse() {
    let series = Series::new(vec!["time".into()], vec![vec![1.0]]).pack();
    let outcome = Outcome::Finished { steps: 1, until: 1.0, series, events: None, pulse_time: Some(24.9) };
    let back: Outcome = serde_json::from_str(&serde_json::to_string(&outcome).unwrap()).unwrap();
    assert_eq!(back.series().unwrap().pulse_time, Some(24.9));
}

#[test]
fn a_count_that_is_wrong_is_no_series() {
    let mut packed = Series::new(vec!["time".into()], vec![vec![1.0, 2.0]]).pack();
    packed.samples = 3;
    assert_eq!(packed.unpack(), None);
    packed.samples = usize::MAX;
    assert_eq!(packed.unpack(), None);
}
