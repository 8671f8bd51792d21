//! A Vulkan driver for the viewer to draw with.

use crate::env::install_packages;
use anyhow::Result;
use std::path::Path;

/// Where the Vulkan loader looks for drivers on Linux.
const FOLDERS: [&str; 4] =
    ["/usr/share/vulkan/icd.d", "/etc/vulkan/icd.d", "/usr/local/share/vulkan/icd.d", "/usr/local/etc/vulkan/icd.d"];

/// Sees to it that there is a driver: Mesa's draws without a graphics card too.
///
/// # Errors
/// There is none, and it cannot be installed; the error names the package.
pub fn require() -> Result<()> {
    let chosen = ["VK_DRIVER_FILES", "VK_ICD_FILENAMES"].iter().any(|name| std::env::var_os(name).is_some());
    if chosen || FOLDERS.iter().any(|folder| has_driver(Path::new(folder))) {
        return Ok(());
    }
    install_packages(&["mesa-vulkan-drivers"], "the viewer draws pictures with Vulkan")
}

fn has_driver(folder: &Path) -> bool {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    entries.into_iter().any(|entry| entry.path().extension().is_some_and(|e| e == "json"))
}
