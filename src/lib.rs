//! A distributed ray tracer for scenes that are Lua programs, on the GPU through WGSL compute shaders and on the CPU.
//!
//! The way of the data, one direction and no way back:
//! ```text
//! scene.lua ──script──▶ Scene ──flatten──▶ SceneBuffers ──▶ gpu | cpu ──▶ Film ──▶ PNG
//! ```
//!
//! # Example
//! Renders every picture of a scene file on whatever device there is.
//! ```
//! use gpu_trace::{device, film, flatten, render, script};
//! use std::{path::Path, sync::Arc};
//!
//! fn main() -> gpu_trace::Result<()> {
//!     # std::fs::create_dir_all("target/doc-example").expect("a writable target folder");
//!     # std::fs::write("target/doc-example/scene.lua", r#"
//!     #     local ball = gr.sphere('ball')
//!     #     ball:set_material(gr.material({0.8, 0.3, 0.2}, {0.5, 0.5, 0.5}, 20))
//!     #     gr.render(ball, 'target/doc-example/ball.png', 32, 24, {0, 0, 4}, {0, 0, 0}, {0, 1, 0}, 40,
//!     #               {0.2, 0.2, 0.2}, {gr.light({3, 4, 5}, {1, 1, 1}, {1, 0, 0})})
//!     # "#).expect("a writable target folder");
//!     # let path = Path::new("target/doc-example/scene.lua");
//!     # let _ = r#"
//!     let path = Path::new("scene.lua");
//!     # "#;
//!     for scene in script::load_scene(path, &script::ScriptOptions::default())? {
//!         let buffers = Arc::new(flatten::flatten(&scene)?);
//!         let (mut renderer, device) = device::open_renderer(&device::DeviceChoice::Auto, false)?;
//!         let options = render::RenderOptions::whole(&buffers);
//!         let rendered = render::render(buffers, renderer.as_mut(), &options, &mut render::Unattended)?;
//!         film::write_picture(&rendered.film, &scene.output, scene.transfer, scene.background.transparent)?;
//!         println!("{}: {} rays on {}", scene.output.display(), rendered.tally.total_rays(), device.name);
//!     }
//!     Ok(())
//! }
//! ```

pub mod animation;
pub mod blocks;
pub mod cpu;
pub mod device;
pub mod error;
pub mod film;
pub mod flatten;
pub mod gpu;
pub mod layout;
pub mod memory;
pub mod render;
pub mod renderer;
pub mod scene;
pub mod script;
pub mod shader;

pub use error::{Error, Result};
