//! The scenes of the benchmark, by name.

use crate::Result;
use gpu_trace::scene::Scene;
use gpu_trace::script::{ScriptOptions, load_scene};
use std::path::Path;

const FOLDER: &str = "scenes/bench";

/// The names of all scenes, sorted.
pub fn all() -> Result<Vec<String>> {
    let mut names = Vec::new();
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
    let path = Path::new(FOLDER).join(name).with_extension("lua");
    let scenes = load_scene(&path, &ScriptOptions::default())?;
    let [mut scene] = <[Scene; 1]>::try_from(scenes)
        .map_err(|scenes| format!("{}: {} pictures where the benchmark takes one", path.display(), scenes.len()))?;
    scene.size = size.unwrap_or(scene.size);
    scene.sampling.camera = samples.unwrap_or(scene.sampling.camera);
    Ok(scene)
}

/// "640x480" as width and height.
pub fn parse_size(text: &str) -> Result<[u32; 2], String> {
    let edges = text.split_once('x').and_then(|(width, height)| Some([width.parse().ok()?, height.parse().ok()?]));
    edges.ok_or_else(|| "expected a width and a height in pixels, such as 640x480".to_owned())
}
