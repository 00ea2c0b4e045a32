use super::*;

#[test]
fn a_question_that_nobody_takes_is_answered_with_no() {
    let (questions, taken) = channel::unbounded();
    let (answer, answers) = channel::bounded(1);
    questions.send(answer).unwrap();
    drop(taken);
    assert_eq!(Synced { answers }.wait(), None);
    assert_eq!(Synced::already().wait(), Some(Vec::new()));
}
