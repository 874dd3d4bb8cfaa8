pub mod cpu;
pub mod device;
pub mod error;
pub mod film;
pub mod flatten;
pub mod gpu;
pub mod layout;
pub mod render;
pub mod renderer;
pub mod scene;
pub mod script;
pub mod shader;

pub use error::{Error, Result};
