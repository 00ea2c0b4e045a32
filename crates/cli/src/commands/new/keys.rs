//! Keys of a scene as `plateau new` writes them.

use std::path::Path;

/// A key with a value and a remark, as the others stand in the scene.
pub(super) fn line(key: &str, value: impl Into<toml::Value>, remark: &str) -> String {
    let pair = format!("{key} = {}", value.into());
    format!("{pair:<39} # {remark}")
}

/// The path of the surface as the scene has it: relative where it is in or below the scene's folder.
pub(super) fn path_from(scene: &Path, disc: &Path) -> Result<String, String> {
    let folder = std::path::absolute(scene).ok().and_then(|scene| scene.parent().map(Path::to_owned));
    let path = std::path::absolute(disc).map_err(|reason| reason.to_string())?;
    let path = folder.and_then(|folder| path.strip_prefix(folder).ok().map(Path::to_owned)).unwrap_or(path);
    path.to_str().map(str::to_owned).ok_or_else(|| "its path is not UTF-8, as a scene is: rename it".to_owned())
}
