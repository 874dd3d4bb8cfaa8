//! Pictures of 4096 samples, which take minutes and are kept under target/bench/references. They are known by their
//! scene: after a change to what the renderers make of a scene, delete the folder.

use crate::Result;
use crate::convergence::first;
use gpu_trace::film::Film;
use gpu_trace::flatten::{SceneBuffers, flatten};
use gpu_trace::renderer::Renderer;
use gpu_trace::scene::Scene;
use std::hash::{DefaultHasher, Hasher};
use std::path::Path;

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
    let film = first(scene, renderer, SAMPLES, SAMPLES, SEED)?.0;
    std::fs::write(&path, bytemuck::cast_slice::<_, u8>(&film.pixels))?;
    Ok(film)
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
