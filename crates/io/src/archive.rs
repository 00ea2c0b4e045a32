//! ZIP archives that are written: after an error nothing more is tried, and the caller alone tells of it.
//!
//! The archive of the library, when it is dropped unfinished, tries to write its end, and prints a line of its own where that fails
//! again, as it does on a full disk.

use std::io::{self, Seek, SeekFrom, Write};

use zip::ZipWriter;

/// An archive that is written into `out`.
pub(crate) fn create<W: Write + Seek>(out: W) -> ZipWriter<Output<W>> {
    ZipWriter::new(Output { out, position: 0, length: 0, failed: false })
}

/// What an archive is written into. Once it has failed it takes everything and keeps nothing.
#[derive(Debug)]
pub(crate) struct Output<W> {
    out: W,
    /// Where it is written, and how long it is: also what nobody keeps any more.
    position: u64,
    length: u64,
    failed: bool,
}

impl<W> Output<W> {
    fn fail<T>(&mut self, error: io::Error) -> io::Result<T> {
        self.failed = true;
        Err(error)
    }
}

impl<W: Write> Write for Output<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let written =
            if self.failed { bytes.len() } else { self.out.write(bytes).or_else(|error| self.fail(error))? };
        self.position += written as u64;
        self.length = self.length.max(self.position);
        Ok(written)
    }

    fn flush(&mut self) -> io::Result<()> {
        if self.failed { Ok(()) } else { self.out.flush().or_else(|error| self.fail(error)) }
    }
}

impl<W: Seek> Seek for Output<W> {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.position = if self.failed {
            match to {
                SeekFrom::Start(position) => position,
                SeekFrom::End(distance) => self.length.saturating_add_signed(distance),
                SeekFrom::Current(distance) => self.position.saturating_add_signed(distance),
            }
        } else {
            self.out.seek(to).or_else(|error| self.fail(error))?
        };
        Ok(self.position)
    }
}

#[cfg(test)]
mod tests {
    use std::cell::Cell;
    use std::io::{BufWriter, Cursor};
    use std::rc::Rc;

    use zip::write::SimpleFileOptions;

    use super::*;

    /// A disk with room for so many bytes, which counts how often it has refused.
    struct Disk {
        file: Cursor<Vec<u8>>,
        room: usize,
        refused: Rc<Cell<usize>>,
    }

    impl Write for Disk {
        fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
            if self.file.get_ref().len() + bytes.len() > self.room {
                self.refused.set(self.refused.get() + 1);
                return Err(io::ErrorKind::StorageFull.into());
            }
            self.file.write(bytes)
        }

        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }

    impl Seek for Disk {
        fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
            self.file.seek(to)
        }
    }

    #[test]
    fn a_full_disk_is_told_once() {
        let content = vec![7; 30_000];
        let write = |room: usize| {
            let refused = Rc::new(Cell::new(0));
            let disk = Disk { file: Cursor::new(Vec::new()), room, refused: refused.clone() };
            let mut archive = create(BufWriter::new(disk));
            let stored = SimpleFileOptions::default().compression_method(zip::CompressionMethod::Stored);
            let written = archive.start_file("a", stored).map_err(io::Error::from);
            let written = written.and_then(|()| archive.write_all(&content));
            let written = written.and_then(|()| archive.finish()?.flush());
            (written.map_err(|error| error.kind()), refused.get())
        };
        assert_eq!(write(40_000), (Ok(()), 0));
        for room in [0, 20, 10_000, 30_050, 30_090] {
            let (written, refused) = write(room);
            assert_eq!(written, Err(io::ErrorKind::StorageFull), "{room}");
            // The buffer below tries once more when it is dropped, and says nothing.
            assert!((1..=2).contains(&refused), "{room}: {refused}");
        }
    }
}
