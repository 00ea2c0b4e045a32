//! How much a file may make the program allocate.

/// Points of the largest grid that is read (2 GiB of heights): a shape can promise more than any memory holds.
pub(super) const MOST_POINTS: usize = 1 << 28;

/// Bytes that deflate makes of one at most (RFC 1951: 258 bytes of two bits, and a little).
pub(super) const MOST_INFLATED: usize = 1032;

/// What a file of so many bytes can hold at most when it is deflated.
pub(super) fn inflated(bytes: usize) -> usize {
    bytes.saturating_mul(MOST_INFLATED)
}
