//! One entry of the archive, with its digest, never more than it declares.

use std::io::{self, Read, Seek};

use md5::{Digest, Md5};
use zip::ZipArchive;
use zip::read::ZipFile;
use zip::result::ZipError;

use super::error::X3pError;

/// Entries up to this size are unpacked whatever they were packed to: a flat surface packs well.
const FREE: u64 = 1 << 26;
/// Larger entries may be this many times as large as they are packed; heights of measured surfaces reach 2 to 20.
const RATIO: u64 = 200;
/// Bytes that are unpacked at once.
const CHUNK: usize = 1 << 16;
/// Entries named in a message.
const NAMED: usize = 8;

/// An entry that is being unpacked.
pub(super) struct Entry<'a, R: Read> {
    name: String,
    file: ZipFile<'a, R>,
    size: u64,
    /// Bytes still to come.
    left: u64,
    digest: Md5,
}

impl<'a, R: Read + Seek> Entry<'a, R> {
    /// Opens an entry of a folder of the archive; its size is what the archive says of it.
    ///
    /// # Errors
    /// [`X3pError`] when it is not there, cannot be unpacked or is out of proportion.
    pub(super) fn open(archive: &'a mut ZipArchive<R>, folder: &str, name: &str) -> Result<Self, X3pError> {
        // Some programs write the links with the separators of their system.
        let name = name.replace('\\', "/");
        let name = format!("{folder}{}", name.trim_start_matches("./").trim_start_matches('/'));
        if archive.index_for_name(&name).is_none() {
            let mut names: Vec<String> = (archive.file_names_raw().take(NAMED))
                .map(|name| name[..name.len().min(60)].escape_ascii().to_string())
                .collect();
            if archive.len() > NAMED {
                names.push(format!("{} more", archive.len() - NAMED));
            }
            return Err(X3pError::NoEntry { name, present: format!("it has {}", names.join(", ")) });
        }
        let file = archive.by_name(&name).map_err(|error| X3pError::Entry {
            name: name.clone(),
            reason: match error {
                ZipError::CompressionMethodNotSupported(method) => {
                    format!("compression method {method} is not read, expected stored or deflate")
                }
                other => other.to_string(),
            },
        })?;
        let (size, compressed) = (file.size(), file.compressed_size());
        if size > FREE.max(compressed.saturating_mul(RATIO)) {
            return Err(X3pError::Bomb { name, compressed, size });
        }
        Ok(Self { name, file, size, left: size, digest: Md5::new() })
    }

    /// Compares the size with what is needed.
    ///
    /// # Errors
    /// [`X3pError::Size`] when they differ.
    pub(super) fn check_size(&self, needed: u128, what: impl FnOnce() -> String) -> Result<(), X3pError> {
        if u128::from(self.size) == needed {
            return Ok(());
        }
        Err(X3pError::Size { name: self.name.clone(), found: self.size, needed, what: what() })
    }

    /// Gives `take` the entry's records of `size` bytes.
    ///
    /// # Errors
    /// [`X3pError::Entry`] when it cannot be unpacked, and what `take` says.
    pub(super) fn for_each_record(
        &mut self,
        size: usize,
        mut take: impl FnMut(&[u8]) -> Result<(), X3pError>,
    ) -> Result<(), X3pError> {
        let mut buffer = vec![0; CHUNK / size * size];
        while self.left > 0 {
            let count = usize::try_from(self.left).unwrap_or(usize::MAX).min(buffer.len());
            let chunk = &mut buffer[..count];
            self.read_exact(chunk).map_err(|error| self.failed(&error))?;
            chunk.chunks_exact(size).try_for_each(&mut take)?;
        }
        Ok(())
    }

    /// Reads what is left and gives the MD5 of the whole entry in hexadecimal digits.
    ///
    /// # Errors
    /// [`X3pError::Entry`] when it cannot be unpacked, is longer than it says, or its CRC does not fit.
    pub(super) fn finish(mut self) -> Result<String, X3pError> {
        io::copy(&mut self, &mut io::sink()).map_err(|error| self.failed(&error))?;
        if self.left > 0 {
            return Err(self.failed(&io::ErrorKind::UnexpectedEof.into()));
        }
        // The CRC is compared at the end only.
        match self.file.read(&mut [0]) {
            Ok(0) => Ok(format!("{:x}", self.digest.finalize())),
            Ok(_) => Err(X3pError::Entry { name: self.name, reason: "it is longer than it says".to_owned() }),
            Err(error) => Err(self.failed(&error)),
        }
    }

    pub(super) fn failed(&self, error: &io::Error) -> X3pError {
        X3pError::Entry { name: self.name.clone(), reason: error.to_string() }
    }
}

impl<R: Read> Read for Entry<'_, R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let count = self.file.by_ref().take(self.left).read(buffer)?;
        self.left -= count as u64;
        self.digest.update(&buffer[..count]);
        Ok(count)
    }
}
