use super::*;

#[test]
fn a_question_that_nobody_takes_is_answered_with_no() {
    let (questions, taken) = channel::bounded(1);
    let (life, alive) = channel::bounded(0);
    let (answer, answers) = channel::bounded(1);
    questions.send(answer).unwrap();
    drop((taken, life));
    assert_eq!(Synced { answers, alive }.wait(), None);
    assert_eq!(Synced::already().wait(), Some(Vec::new()));
}
