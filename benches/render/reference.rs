//! Pictures of 4096 samples, which take minutes or an hour and are kept under target/bench/references. They are known by their
//! scene: after a change to what the renderers make of a scene, delete the folder.

use crate::Result;
use gpu_trace::film::Film;
use gpu_trace::flatten::{SceneBuffers, flatten};
use gpu_trace::render::{Progress, RenderControl, RenderOptions, render};
use gpu_trace::renderer::Renderer;
use gpu_trace::scene::Scene;
use std::hash::{DefaultHasher, Hasher};
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Arc;

const SAMPLES: u32 = 4096;
/// Any number that is not the scenes' own seed.
const SEED: u32 = 0x5eed;

/// The reference for a scene, rendered if that was not done before.
pub fn film(name: &str, scene: &Scene, renderer: &mut dyn Renderer) -> Result<Film> {
    let folder = Path::new("target/bench/references");
    std::fs::create_dir_all(folder)?;
    let path = folder.join(format!("{:016x}.film", fingerprint(&flatten(scene)?)));
    let [width, height] = scene.size;
    let mut film = Film::new(width, height);
    if let Ok(bytes) = std::fs::read(&path)
        && bytes.len() == size_of_val(film.pixels.as_slice())
    {
        bytemuck::cast_slice_mut(&mut film.pixels).copy_from_slice(&bytes);
        film.samples = SAMPLES;
        return Ok(film);
    }
    eprintln!("{name}: reference of {SAMPLES} samples");
    let mut scene = scene.clone();
    (scene.sampling.camera, scene.sampling.seed) = (SAMPLES, SEED);
    let buffers = Arc::new(flatten(&scene)?);
    let options = RenderOptions::whole(&buffers);
    let film = render(buffers, renderer, &options, &mut Tenths { done: 0 })?.film;
    std::fs::write(&path, bytemuck::cast_slice::<_, u8>(&film.pixels))?;
    Ok(film)
}

/// Tells of every tenth, so that one sees how long it will take.
struct Tenths {
    done: u32,
}

impl RenderControl for Tenths {
    fn progress(&mut self, progress: &Progress) -> ControlFlow<()> {
        let done = (10.0 * progress.samples_done / f64::from(progress.samples_total)) as u32;
        if done > self.done {
            self.done = done;
            eprintln!("  {done}0 % after {:.0} s", progress.elapsed.as_secs_f64());
        }
        ControlFlow::Continue(())
    }
}

/// Of everything that the picture depends on.
fn fingerprint(buffers: &SceneBuffers) -> u64 {
    let SceneBuffers { frame, nodes, instances, triangles, materials, lights, texels, .. } = buffers;
    let mut hasher = DefaultHasher::new();
    hasher.write(bytemuck::bytes_of(frame));
    hasher.write(bytemuck::cast_slice(nodes));
    hasher.write(bytemuck::cast_slice(instances));
    hasher.write(bytemuck::cast_slice(triangles));
    hasher.write(bytemuck::cast_slice(materials));
    hasher.write(bytemuck::cast_slice(lights));
    hasher.write(bytemuck::cast_slice(texels));
    hasher.finish()
}
