//! What the test on a virtual SpaceMouse needs: an emulator, and a kernel with the modules that a container has not.

use crate::env;
use crate::progress::Step;
use crate::workspace;
use anyhow::{Context, Result, bail};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// Programs that `tests/uhid/run.sh` calls, and the Debian packages that hold them.
const PROGRAMS: [(&str, &str); 3] =
    [("qemu-system-x86_64", "qemu-system-x86"), ("busybox", "busybox-static"), ("cpio", "cpio")];
/// Depends on the distribution's newest kernel (Debian).
const META_PACKAGE: &str = "linux-image-amd64";
/// What is taken out of the kernel's package.
const PARTS: [&str; 4] = ["./boot/vmlinuz-*", "*/hid.ko*", "*/hid-generic.ko*", "*/uhid.ko*"];

/// The test's command line. What is missing is brought when root; if that cannot be, the script says what it lacks.
pub fn spacemouse_test() -> Command {
    let mut command = Command::new("sh");
    command.arg(workspace::root().join("tests/uhid/run.sh"));
    if std::env::consts::ARCH != "x86_64" {
        return command;
    }
    match install_programs().and_then(|()| kernel()) {
        Ok(Some(Kernel { image, modules })) => {
            command.arg(image).arg(modules);
        }
        Ok(None) => {}
        Err(error) => eprintln!("warning: {error:#}"),
    }
    command
}

fn install_programs() -> Result<()> {
    let missing: Vec<&str> =
        PROGRAMS.iter().filter(|(name, _)| env::program(name).is_none()).map(|(_, package)| *package).collect();
    if missing.is_empty() || !env::may_install_packages() {
        return Ok(());
    }
    env::install_packages(&missing, "a virtual SpaceMouse lives in a small virtual machine")
}

struct Kernel {
    image: PathBuf,
    modules: PathBuf,
}

/// The kernel to boot: `None` for the one that runs here, if it is at hand or another cannot be had.
fn kernel() -> Result<Option<Kernel>> {
    let release = fs::read_to_string("/proc/sys/kernel/osrelease").unwrap_or_default();
    let release = release.trim();
    let modules = Path::new("/lib/modules").join(release);
    let at_hand = Path::new("/boot").join(format!("vmlinuz-{release}")).is_file() && modules.is_dir();
    if at_hand || !env::may_install_packages() {
        return Ok(None);
    }
    let folder = workspace::cache()?.join("kernel");
    let stamp = folder.join("complete");
    if !stamp.is_file() {
        let _held = workspace::lock(&folder, || eprintln!("... another process is bringing a kernel; waiting"))?;
        if !stamp.is_file() {
            unpack(&folder)?;
            fs::write(&stamp, "")?;
        }
    }
    let boot = fs::read_dir(folder.join("boot")).with_context(|| format!("{}: no kernel", folder.display()))?;
    let image = boot.flatten().map(|entry| entry.path()).next().context("the kernel's package holds no kernel")?;
    Ok(Some(Kernel { image, modules: folder }))
}

/// Unpacks the distribution's newest kernel into the cache; it is not installed.
fn unpack(folder: &Path) -> Result<()> {
    let log = workspace::cache()?.join("apt.log");
    if folder.exists() {
        fs::remove_dir_all(folder)?;
    }
    fs::create_dir_all(folder)?;
    let step = Step::begin("kernel for the virtual machine (downloaded, not installed)");
    step.run(Command::new("apt-get").arg("update"), &log)?;
    let depends = said(Command::new("apt-cache").args(["depends", "--important", META_PACKAGE]))?;
    let package = depends
        .lines()
        .find_map(|line| line.trim().strip_prefix("Depends: ").filter(|name| name.starts_with("linux-image-")))
        .with_context(|| format!("{META_PACKAGE}: names no kernel"))?;
    step.detail(package);
    step.run(Command::new("apt-get").args(["download", package]).current_dir(folder), &log)?;
    let archive =
        workspace::files_below(folder)?.pop().with_context(|| format!("{package}: nothing was downloaded"))?;
    let mut dpkg = Command::new("dpkg-deb")
        .arg("--fsys-tarfile")
        .arg(&archive)
        .stdout(Stdio::piped())
        .spawn()
        .context("dpkg-deb cannot be started")?;
    let tape = dpkg.stdout.take().context("dpkg-deb gives nothing")?;
    let mut tar = Command::new("tar");
    tar.args(["--extract", "--wildcards", "--directory"]).arg(folder).args(PARTS).stdin(tape);
    let status = tar.status().context("tar cannot be started")?;
    if !(dpkg.wait()?.success() && status.success()) {
        bail!("{package}: cannot be unpacked into {}", folder.display());
    }
    fs::remove_file(&archive)?;
    step.note(&format!("{package} unpacked into {}", folder.display()));
    step.done();
    Ok(())
}

/// What a command prints.
fn said(command: &mut Command) -> Result<String> {
    let name = command.get_program().to_string_lossy().into_owned();
    let output = command.output().with_context(|| format!("{name} cannot be started"))?;
    if !output.status.success() {
        bail!("{name}: {}", String::from_utf8_lossy(&output.stderr).trim());
    }
    Ok(String::from_utf8_lossy(&output.stdout).into_owned())
}
