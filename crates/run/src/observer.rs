//! What others want to know of a run while it goes on, and what they may ask of it.

use std::fmt::Display;

use plateau_core::observe::Sample;
use plateau_core::simulation::Simulation;

/// Follows a run. Every method has an answer already: an observer says only what it cares for, `()` cares for nothing.
///
/// In a job of several processes each has an observer of its own. All are told the same, and it suffices that one of them
/// asks for something.
pub trait Observer {
    /// What deserves attention though the run goes on.
    fn warning(&mut self, _message: &dyn Display) {}

    /// What is worth knowing.
    fn note(&mut self, _message: &dyn Display) {}

    /// What was done to make a surface ready, one step a line; for those who want to see how.
    fn detail(&mut self, _message: &dyn Display) {}

    /// All is read and made that the run needs, and nothing is written yet: until now whoever wants to stop it may end the process.
    fn prepared(&mut self) {}

    /// Steps begin, to be taken until this physical time (s); `name` tells a run from others of the same scene, else it is
    /// empty.
    fn starts(&mut self, _name: &str, _duration: f64) {}

    /// Called about ten times a second between two steps.
    fn progress(&mut self, _simulation: &Simulation) {}

    /// A sample was taken; it is on its way to the run file.
    fn sample(&mut self, _sample: &Sample) {}

    /// The last step was taken, or the run ends before.
    fn ends(&mut self) {}

    /// The number of the signal that asks the run to stop, if one does. Looked at as often as [`progress`](Self::progress) is
    /// called; a run that has a file leaves a checkpoint.
    fn asked_to_stop(&mut self) -> Option<u8> {
        None
    }

    /// Whether a checkpoint was asked for since the last time.
    fn asked_to_save(&mut self) -> bool {
        false
    }
}

impl Observer for () {}
