//! What an .npy file has before its data.

use std::io;

/// Bytes before the dictionary: mark, version and length.
const PREFIX: usize = 10;

/// The bytes before the data of an array of that type, as NumPy writes it, and shape; the last index runs fastest.
///
/// # Errors
/// When the array has so many dimensions that their sizes find no room.
pub(crate) fn preamble(descr: &str, shape: &[usize]) -> io::Result<Vec<u8>> {
    // A tuple of one has a comma after it.
    let sizes: String = shape.iter().map(|size| format!("{size}, ")).collect();
    let dictionary = format!("{{'descr': '{descr}', 'fortran_order': False, 'shape': ({}), }}", sizes.trim_end());
    // The data start at a multiple of 64 bytes; the header ends with a line feed.
    let padded = (PREFIX + dictionary.len() + 1).next_multiple_of(64) - PREFIX - 1;
    let dictionary = format!("{dictionary:padded$}\n");
    let length = u16::try_from(dictionary.len()).map_err(io::Error::other)?;
    Ok([b"\x93NUMPY\x01\x00", &length.to_le_bytes()[..], dictionary.as_bytes()].concat())
}

#[cfg(test)]
mod tests {
    use super::super::header::Header;
    use super::preamble;

    #[test]
    fn any_number_of_dimensions_is_read_back() {
        for shape in [&[][..], &[7], &[3, 5], &[2, 3, 5]] {
            let bytes = preamble("<f8", shape).unwrap();
            let header = Header::read(&bytes).unwrap();
            let expected: Vec<u64> = shape.iter().map(|size| *size as u64).collect();
            assert_eq!((header.descr.as_str(), header.fortran_order, header.shape), ("<f8", false, expected));
            assert_eq!((header.data, bytes.len() % 64), (bytes.len(), 0));
        }
    }
}
