//! Serial lines, raw: every byte as it is, none held back.

use std::fs::File;
use std::io;
use std::path::Path;

/// Opens the line at `path`, at `baud` where it has a speed; a USB port has none.
#[cfg(unix)]
pub fn open(path: &Path, baud: Option<u32>) -> io::Result<File> {
    use rustix::termios::{OptionalActions, tcgetattr, tcsetattr};
    use std::os::unix::fs::OpenOptionsExt;
    // It must not become the terminal that this program is controlled by.
    let no_terminal = rustix::fs::OFlags::NOCTTY.bits() as i32;
    let file = File::options().read(true).write(true).custom_flags(no_terminal).open(path)?;
    let mut settings = tcgetattr(&file)?;
    settings.make_raw();
    if let Some(baud) = baud {
        settings.set_speed(baud)?;
    }
    tcsetattr(&file, OptionalActions::Flush, &settings)?;
    Ok(file)
}

#[cfg(not(unix))]
pub fn open(_: &Path, _: Option<u32>) -> io::Result<File> {
    Err(io::Error::new(io::ErrorKind::Unsupported, "serial lines are read on Unix only"))
}
