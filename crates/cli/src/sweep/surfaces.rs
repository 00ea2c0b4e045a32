//! The surfaces of one run of a study, given up when a signal comes while they are made.

use std::sync::mpsc::{RecvTimeoutError, channel};
use std::thread;
use std::time::Duration;

use plateau_io::scene::Scene;
use plateau_io::surface::{self, Loaded, SurfaceError};

use super::under_way::UnderWay;
use super::watcher::{Ended, Watcher};

/// Time between two looks at signals.
const LOOK: Duration = Duration::from_millis(50);

/// Reads or makes the surfaces of a scene. Nothing is written meanwhile, so after a signal nobody waits for them: the thread that makes
/// them ends with the program. Other runs that are made at the same time keep what they have.
///
/// # Errors
/// [`Ended`], with the signal or with what is wrong.
pub fn surfaces(scene: &Scene, watcher: &dyn Watcher, under_way: &mut UnderWay) -> Result<Loaded, Ended> {
    let (give, take) = channel();
    let its_own = scene.clone();
    let load = move || drop(give.send(surface::load(&its_own)));
    let loaded = if thread::Builder::new().name("surfaces".into()).spawn(load).is_ok() {
        loop {
            match take.recv_timeout(LOOK) {
                Ok(loaded) => break loaded,
                Err(RecvTimeoutError::Timeout) => {
                    under_way.touch();
                    watcher.steps(0).map_or(Ok(()), |signal| Err(Ended::Stopped(signal)))?
                }
                Err(RecvTimeoutError::Disconnected) => panic!("the thread that makes surfaces panicked"),
            }
        }
    } else {
        // No thread is to be had: a signal is heard with the first step.
        surface::load(scene)
    };
    loaded.map_err(|error: SurfaceError| Ended::Failed(error.to_string()))
}
