//! Plateau as a module of Python, `plateau._native`: scenes, simulations, runs and studies in the process of Python. What the package
//! `plateau` shows of it is in python/plateau (`scenes.py`, `simulation.py`, `runs.py`), with the types in `_native.pyi`.
//!
//! | file | content |
//! |---|---|
//! | `scene.rs` | a scene, read, checked and resolved; its table of keys; units as people write them |
//! | `simulation.rs` | a simulation between two steps |
//! | `state.rs` | its state in a file |
//! | `runs.rs` | runs and studies that write their files |
//! | `background.rs` | work on a thread, while Python looks at signals and shows progress |
//! | `failure.rs` | exceptions of the package |

mod background;
mod failure;
mod runs;
mod scene;
mod simulation;
mod state;

use pyo3::prelude::*;

/// What the package `plateau` has in Rust.
#[pymodule(name = "_native")]
mod native {
    #[pymodule_export]
    use super::runs::{make_runs, run};
    #[pymodule_export]
    use super::scene::{Scene, keys, scale_of};
    #[pymodule_export]
    use super::simulation::Simulation;

    use pyo3::prelude::*;
    use pyo3::types::IntoPyDict as _;

    #[pymodule_init]
    fn init(py: Python<'_>) -> PyResult<()> {
        let forked = pyo3::wrap_pyfunction!(super::simulation::forked, py)?;
        let options = [("after_in_child", forked)].into_py_dict(py)?;
        py.import("os")?.call_method("register_at_fork", (), Some(&options)).map(drop)
    }
}
