//! Writing X3P so that reading it gives the same heights, bit for bit.

use std::io::{self, Seek, Write};

use md5::{Digest, Md5};
use plateau_core::surface::Patch;
use zip::CompressionMethod;
use zip::write::SimpleFileOptions;

use crate::archive;
use crate::surface::profiles::for_each_profile;

/// Name of the entry with the heights, and of that with the checksum of `main.xml`.
const DATA: &str = "bindata/data.bin";
const CHECKSUM: &str = "md5checksum.hex";

/// Writes heights as float64 in m, NaN where none was measured. `date` is ISO 8601.
pub(in crate::surface) fn write(out: impl Write + Seek, patch: &Patch, date: &str) -> io::Result<()> {
    let mut digest = Md5::new();
    for_each_height_bytes(patch, |bytes| {
        digest.update(bytes);
        Ok(())
    })?;
    let main = main_xml(patch, date, &format!("{:X}", digest.finalize()));

    let mut archive = archive::create(out);
    // Packed, for some readers take only archives that begin with a packed entry; heights hardly get smaller.
    let packed = SimpleFileOptions::default().compression_method(CompressionMethod::Deflated);
    let stored = SimpleFileOptions::default().compression_method(CompressionMethod::Stored).large_file(
        // 4 GiB is what the sizes of a plain archive hold.
        patch.heights.len() as u64 * 8 >= u64::from(u32::MAX),
    );
    archive.start_file("main.xml", packed)?;
    archive.write_all(main.as_bytes())?;
    archive.start_file(DATA, stored)?;
    for_each_height_bytes(patch, |bytes| archive.write_all(bytes))?;
    archive.start_file(CHECKSUM, packed)?;
    archive.write_all(format!("{:x} *main.xml\n", Md5::digest(main.as_bytes())).as_bytes())?;
    archive.finish()?.flush()
}

fn for_each_height_bytes(patch: &Patch, mut take: impl FnMut(&[u8]) -> io::Result<()>) -> io::Result<()> {
    let mut bytes = Vec::new();
    for_each_profile(patch, false, |profile| {
        bytes.clear();
        // One NaN for all: others may not survive the way through other programs.
        let stored = profile.iter().map(|height| if height.is_nan() { f64::NAN } else { *height });
        bytes.extend(stored.flat_map(f64::to_le_bytes));
        take(&bytes)
    })
}

/// The description in the order that the schema of ISO 5436-2 asks for.
fn main_xml(patch: &Patch, date: &str, digest: &str) -> String {
    let Patch { columns, rows, column_pitch, row_pitch, .. } = patch;
    let axis = |name: &str, axis_type: &str, increment: f64| {
        format!(
            "<{name}><AxisType>{axis_type}</AxisType><DataType>D</DataType><Increment>{increment:e}</Increment>\
             <Offset>0</Offset></{name}>"
        )
    };
    let unknown = "not available";
    format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\" standalone=\"no\"?>\n\
         <p:ISO5436_2 xmlns:p=\"http://www.opengps.eu/2008/ISO5436_2\" \
         xmlns:xsi=\"http://www.w3.org/2001/XMLSchema-instance\" \
         xsi:schemaLocation=\"http://www.opengps.eu/2008/ISO5436_2 http://www.opengps.eu/2008/ISO5436_2/ISO5436_2.xsd\">\n\
         <Record1><Revision>ISO5436 - 2000</Revision><FeatureType>SUR</FeatureType><Axes>\n{}\n{}\n{}\n</Axes></Record1>\n\
         <Record2><Date>{date}</Date><Instrument><Manufacturer>{unknown}</Manufacturer><Model>{unknown}</Model>\
         <Serial>{unknown}</Serial><Version>{unknown}</Version></Instrument><CalibrationDate>{date}</CalibrationDate>\
         <ProbingSystem><Type>Software</Type><Identification>Plateau {}</Identification></ProbingSystem></Record2>\n\
         <Record3><MatrixDimension><SizeX>{columns}</SizeX><SizeY>{rows}</SizeY><SizeZ>1</SizeZ></MatrixDimension>\
         <DataLink><PointDataLink>{DATA}</PointDataLink><MD5ChecksumPointData>{digest}</MD5ChecksumPointData></DataLink>\
         </Record3>\n\
         <Record4><ChecksumFile>{CHECKSUM}</ChecksumFile></Record4>\n\
         </p:ISO5436_2>\n",
        axis("CX", "I", *column_pitch),
        axis("CY", "I", *row_pitch),
        axis("CZ", "A", 1.0),
        env!("CARGO_PKG_VERSION"),
    )
}
