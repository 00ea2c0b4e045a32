use super::*;

#[test]
fn the_balance_sees_what_the_account_cannot() {
    // 3 of 4 m³ worn are deposited, the rest is emitted: the account is right by itself. Heights say whether it is true.
    let mut totals = Totals::default();
    totals.add(&Volumes { worn_pin: 4.0, deposited_disc: 3.0, emitted: 1.0, ..Volumes::default() });
    assert_eq!(totals.balance_residual(0.0, 1.0), 0.0);
    // As if a sum of deposits had lost 2 m³ that are on the disc: surfaces lost less than the account says.
    let mut wrapped = Totals::default();
    wrapped.add(&Volumes { worn_pin: 4.0, deposited_disc: 1.0, emitted: 3.0, ..Volumes::default() });
    assert_eq!(wrapped.balance_residual(0.0, 1.0), 0.5);
    // What the account itself lacks, it sees as before.
    assert_eq!(totals.balance_residual(1.0, 1.0), -0.25);
}
