//! Instruments' own formats, which are told apart only to be refused with the line that converts them.

use std::path::Path;

/// An instrument's own format.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Instrument {
    /// What it is, with its article.
    pub name: &'static str,
    /// The line that converts a file IN to OUT.sdf.
    pub conversion: &'static str,
}

/// For what SurfaceTopography reads, surfaces and profiles; tests/python/test_surface_conversion.py tries it.
pub(super) const BY_SURFACE_TOPOGRAPHY: &str = "pip install SurfaceTopography sdfio; python -c \"import sys, numpy, sdfio, \
    SurfaceTopography as s; t = s.read_topography(sys.argv[1]).to_unit('m'); p = t.pixel_size; \
    sdfio.write(sys.argv[2], numpy.atleast_2d(numpy.ma.filled(t.heights().T, numpy.nan)), x_scale=p[0], y_scale=p[-1])\" \
    IN OUT.sdf";

/// For what only surfalize reads; tried with its version 0.19.2 and a file of Alicona.
const BY_SURFALIZE: &str = "pip install surfalize; python -c \"import sys, surfalize; surfalize.Surface.load(sys.argv[1]).save(sys.argv[2])\" \
     IN OUT.sdf";

/// Offset, first bytes and name of formats as SurfaceTopography and surfalize tell them.
const SIGNATURES: &[(usize, &[u8], &str)] = &[
    (0, b"AliconaImaging", "an Alicona file (.al3d)"),
    (0, b"FRTM_GLIDERV", "an FRT MicroProf file (.frt)"),
    (0, b"DIGITAL SURF", "a Digital Surf file (.sur)"),
    (0, b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1", "a compound file (of Mitutoyo, Mahr or Mountains, or a document)"),
    (0, b"GWYP", "a Gwyddion file (.gwy)"),
    (0, b"\x88\x1b\x03\x6f", "a Zygo MetroPro file (.dat)"),
    (0, b"\x88\x1b\x03\x70", "a Zygo MetroPro file (.dat)"),
    (0, b"\x88\x1b\x03\x71", "a Zygo MetroPro file (.dat)"),
    (2, b"Directory", "a Wyko file (.opd)"),
    (0, b"VCA DATA\x01\0\0\x55", "a Dektak file (.OPDx)"),
    (0, b"OmniSurf3D", "an OmniSurf3D file (.os3d)"),
    (0, b"Binary TrueMap Data File", "a TrueMap file (.tmd)"),
    (0, b"VK3_", "a Keyence file (.vk3)"),
    (0, b"VK4_", "a Keyence file (.vk4)"),
    (0, b"VK6", "a Keyence file (.vk6)"),
    (0, b"VK7", "a Keyence file (.vk7)"),
    (0, b"KPK0", "a Keyence file (.zon)"),
    (0, b"KPK1", "a Keyence file (.zon)"),
    (0, b"Zeta-Instruments", "a Zeta file (.zmg)"),
    (0, b"OLYMPUSRAWFORMAT", "an Olympus file (.oir)"),
    (0, b"\x01\xb0\x93\xff", "an NT-MDT file (.mdt)"),
    (0, b"?*File list", "a Bruker Nanoscope file"),
    (0, b"\\*File list", "a Bruker Nanoscope file"),
    (0, b"WSxM file copyright", "a WSxM file"),
    (0, b"fileType  ", "an Agilent file (.mi)"),
    (0, b"[DataSet]\r\n", "a Nanosurf file (.nid, .ezd)"),
    (0, b"fileformat = bcr", "a BCR-STM file (.bcr, .bcrf)"),
    (0, b"f\0i\0l\0e\0f\0o\0r\0m\0a\0t\0 \0=\0 \0b\0c\0r\0", "a BCR-STM file (.bcr, .bcrf)"),
    (0, b"\xff\xfef\0i\0l\0e\0f\0o\0r\0m\0a\0t\0 \0=\0 \0b\0c\0r\0", "a BCR-STM file (.bcr, .bcrf)"),
    (0, b"\xfe\xff\0f\0i\0l\0e\0f\0o\0r\0m\0a\0t\0 \0=\0 \0b\0c\0r", "a BCR-STM file (.bcr, .bcrf)"),
    (0, b"CDF\x01", "a netCDF-3 file (.nc)"),
    (0, b"CDF\x02", "a netCDF-3 file (.nc)"),
    (0, b"CDF\x05", "a netCDF-3 file (.nc)"),
];

/// As [`SIGNATURES`], of formats that only surfalize reads.
const ONLY_SURFALIZE: &[(usize, &[u8], &str)] = &[
    (0, b"DSCOMPRESSED", "a compressed Digital Surf file (.sur)"),
    (4, b"hdat_", "a Heliotis file (.hdat)"),
    (0, b"SIMPLE  =", "a FITS file"),
];

/// Endings of binary formats without a signature that is sure, their names and what converts them. SurfaceTopography 1.27.1 takes um
/// for m in a NanoFocus file, surfalize 0.19.2 does not.
const ENDINGS: &[(&str, &str, &str)] =
    &[("ibw", "an Igor binary wave (.ibw)", BY_SURFACE_TOPOGRAPHY), ("nms", "a NanoFocus file (.nms)", BY_SURFALIZE)];

/// A zip archive, told by its entries.
pub(super) const PLUX: Instrument = Instrument { name: "a Sensofar file (.plux)", conversion: BY_SURFACE_TOPOGRAPHY };

/// A zip archive, told by its entries.
pub(super) const WORKBOOK: Instrument = Instrument {
    name: "a workbook (.xlsx), whose sheet of heights a spreadsheet saves as CSV; or one of Mitutoyo",
    conversion: BY_SURFACE_TOPOGRAPHY,
};

/// A Sensofar file starts with the day on which it was measured, such as "Fri Mar 15 10:12:00 2013", in 128 bytes.
const PLU: Instrument = Instrument { name: "a Sensofar file (.plu, .apx)", conversion: BY_SURFACE_TOPOGRAPHY };

/// What a binary file of that path is whose beginning tells nothing, if its ending does.
pub(super) fn by_ending(path: &Path) -> Option<Instrument> {
    let ending = path.extension()?;
    let (_, name, conversion) = ENDINGS.iter().find(|(known, ..)| ending.eq_ignore_ascii_case(known))?;
    Some(Instrument { name, conversion })
}

/// What a file that starts like this is, if it is one of an instrument.
pub(super) fn recognise(head: &[u8]) -> Option<Instrument> {
    let at = |offset: usize, signature: &[u8]| head.get(offset..).is_some_and(|rest| rest.starts_with(signature));
    let is_day = ["Mon ", "Tue ", "Wed ", "Thu ", "Fri ", "Sat ", "Sun "].iter().any(|day| at(0, day.as_bytes()));
    if is_day && head.iter().take(128).any(|byte| *byte == 0) {
        return Some(PLU);
    }
    [(SIGNATURES, BY_SURFACE_TOPOGRAPHY), (ONLY_SURFALIZE, BY_SURFALIZE)].into_iter().find_map(
        |(signatures, conversion)| {
            let (.., name) = signatures.iter().find(|(offset, signature, _)| at(*offset, signature))?;
            Some(Instrument { name, conversion })
        },
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tells_instruments_by_their_first_bytes() {
        let name = |head| recognise(head).map(|instrument| instrument.name);
        assert_eq!(name(b"AliconaImaging\0\r\n"), Some("an Alicona file (.al3d)"));
        assert_eq!(name(b"\x01\0Directory\0"), Some("a Wyko file (.opd)"));
        // SurfaceTopography does not know this one.
        let heliotis = recognise(b"\0\0\0\x0ahdat_3.4.x");
        assert!(heliotis.is_some_and(|instrument| instrument.conversion.starts_with("pip install surfalize")));
        let plu = [&b"Fri Mar 15 10:12:00 2013\0"[..], &[0; 200]].concat();
        assert_eq!(name(&plu), Some("a Sensofar file (.plu, .apx)"));
        // A text may begin with a day.
        assert_eq!(name(b"Fri Mar 15 10:12:00 2013\n1 2\n3 4\n"), None);
        let wide: Vec<u8> = "\u{feff}fileformat = bcrstm_unicode\n".encode_utf16().flat_map(u16::to_le_bytes).collect();
        let known = [
            (&wide[..], "a BCR-STM file (.bcr, .bcrf)"),
            (b"fileformat = bcrf\n", "a BCR-STM file (.bcr, .bcrf)"),
            (b"CDF\x02\0\0", "a netCDF-3 file (.nc)"),
            (b"fileType      Image\n", "an Agilent file (.mi)"),
            (b"[DataSet]\r\nVersion=2\r\n", "a Nanosurf file (.nid, .ezd)"),
            (b"SIMPLE  =                    T", "a FITS file"),
        ];
        known.iter().for_each(|(head, expected)| assert_eq!(name(head), Some(*expected)));
        let of_ending = |path: &str| by_ending(Path::new(path)).map(|instrument| instrument.conversion);
        assert_eq!(of_ending("wave.IBW"), Some(BY_SURFACE_TOPOGRAPHY));
        assert_eq!(of_ending("confocal.nms"), Some(BY_SURFALIZE));
        assert_eq!(of_ending("heights.dat"), None);
        assert_eq!(recognise(b"Alicona"), None);
        assert_eq!(recognise(b""), None);
    }
}
