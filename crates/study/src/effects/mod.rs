//! Effects: what the responses of a design tell of its factors.
