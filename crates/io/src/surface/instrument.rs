//! Instruments' own formats, which are told apart only to be refused with the line that converts them.

/// An instrument's own format.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Instrument {
    /// What it is, with its article.
    pub name: &'static str,
    /// The line that converts a file IN to OUT.sdf.
    pub conversion: &'static str,
}

/// For what SurfaceTopography reads, surfaces and profiles; tests/python/test_surface_conversion.py tries it.
const BY_SURFACE_TOPOGRAPHY: &str = "pip install SurfaceTopography sdfio; python -c \"import sys, numpy, sdfio, \
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
];

/// As [`SIGNATURES`], of formats that only surfalize reads.
const ONLY_SURFALIZE: &[(usize, &[u8], &str)] =
    &[(0, b"DSCOMPRESSED", "a compressed Digital Surf file (.sur)"), (4, b"hdat_", "a Heliotis file (.hdat)")];

/// A zip archive, told by its entries.
pub(super) const PLUX: Instrument = Instrument { name: "a Sensofar file (.plux)", conversion: BY_SURFACE_TOPOGRAPHY };

/// What a file that starts like this is, if it is one of an instrument.
pub(super) fn recognise(head: &[u8]) -> Option<Instrument> {
    let at = |offset: usize, signature: &[u8]| head.get(offset..).is_some_and(|rest| rest.starts_with(signature));
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
        assert_eq!(recognise(b"Alicona"), None);
        assert_eq!(recognise(b""), None);
    }
}
