//! Bytes made fewer, for PDF files and web pages.

use std::io::Write as _;

use flate2::Compression;
use flate2::write::ZlibEncoder;

/// Deflated bytes in a zlib stream.
pub fn deflate(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = ZlibEncoder::new(Vec::new(), Compression::best());
    // A Vec takes every byte.
    encoder.write_all(bytes).and_then(|()| encoder.finish()).unwrap_or_default()
}
