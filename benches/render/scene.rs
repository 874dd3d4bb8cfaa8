//! The scenes of the benchmark, by name.

use crate::{Result, triangles};
use gpu_trace::scene::Scene;
use gpu_trace::script::{ScriptOptions, load_scene};
use std::path::{Path, PathBuf};

const FOLDER: &str = "scenes/bench";
/// Scenes that have a file of their own elsewhere: name, file, size and camera samples in the benchmark.
const ELSEWHERE: [(&str, &str, [u32; 2], u32); 1] = [("waterfall", "scenes/waterfall.lua", [640, 360], 4)];

/// The names of all scenes that are measured for speed, sorted.
pub fn all() -> Result<Vec<String>> {
    let mut names: Vec<String> = ELSEWHERE.iter().map(|(name, ..)| (*name).to_owned()).collect();
    for entry in std::fs::read_dir(FOLDER)? {
        let path = entry?.path();
        if path.extension().is_some_and(|extension| extension == "lua") {
            names.extend(path.file_stem().map(|stem| stem.to_string_lossy().into_owned()));
        }
    }
    names.sort();
    Ok(names)
}

/// The only picture of a scene, at another size or number of camera samples where given.
pub fn load(name: &str, size: Option<[u32; 2]>, samples: Option<u32>) -> Result<Scene> {
    if let Some(thousands) = triangles::thousands(name) {
        let mut scene = triangles::scene(thousands)?;
        scene.size = size.unwrap_or(scene.size);
        scene.sampling.camera = samples.unwrap_or(scene.sampling.camera);
        return Ok(scene);
    }
    let elsewhere = ELSEWHERE.iter().find(|(own, ..)| *own == name);
    let path = elsewhere
        .map_or_else(|| Path::new(FOLDER).join(name).with_extension("lua"), |(_, path, ..)| PathBuf::from(path));
    if !path.is_file() {
        return Err(format!("there is no scene '{name}'; known are {}", all()?.join(", ")).into());
    }
    let scenes = load_scene(&path, &ScriptOptions::default())?;
    let [mut scene] = <[Scene; 1]>::try_from(scenes)
        .map_err(|scenes| format!("{}: {} pictures where the benchmark takes one", path.display(), scenes.len()))?;
    if let Some((.., own_size, own_samples)) = elsewhere {
        (scene.size, scene.sampling.camera) = (*own_size, *own_samples);
    }
    scene.size = size.unwrap_or(scene.size);
    scene.sampling.camera = samples.unwrap_or(scene.sampling.camera);
    Ok(scene)
}

/// "640x480" as width and height.
pub fn parse_size(text: &str) -> Result<[u32; 2], String> {
    let edges = text.split_once('x').and_then(|(width, height)| Some([width.parse().ok()?, height.parse().ok()?]));
    edges.ok_or_else(|| "expected a width and a height in pixels, such as 640x480".to_owned())
}
