//! The scenes of the benchmark, by name.

use crate::{Result, triangles};
use gpu_trace::film::Film;
use gpu_trace::scene::Scene;
use gpu_trace::script::{ScriptOptions, load_scene};
use std::path::{Path, PathBuf};

const FOLDER: &str = "scenes/bench";
/// Scenes that have a file of their own elsewhere: name, file, size and camera samples in the benchmark.
const ELSEWHERE: [(&str, &str, [u32; 2], u32); 1] = [("waterfall", "scenes/waterfall.lua", [640, 360], 4)];

/// The names of all scenes that are measured for speed, sorted.
pub fn all() -> Result<Vec<String>> {
    let mut names = in_folder("")?;
    names.extend(ELSEWHERE.iter().map(|(name, ..)| (*name).to_owned()));
    names.sort();
    Ok(names)
}

/// The names of those whose error is that of one integral.
pub fn convergence() -> Result<Vec<String>> {
    in_folder("convergence/")
}

/// The scripts of a folder under [`FOLDER`], named by their paths from there.
fn in_folder(folder: &str) -> Result<Vec<String>> {
    let mut names = Vec::new();
    for entry in std::fs::read_dir(Path::new(FOLDER).join(folder))? {
        let path = entry?.path();
        if let (Some(stem), true) = (path.file_stem(), path.extension().is_some_and(|extension| extension == "lua")) {
            names.push(format!("{folder}{}", stem.to_string_lossy()));
        }
    }
    names.sort();
    Ok(names)
}

/// Says whether there is such a scene without running it.
pub fn check(name: &str) -> Result<()> {
    if triangles::thousands(name).is_some() || path(name).is_file() {
        return Ok(());
    }
    let known = [all()?, convergence()?].concat().join(", ");
    Err(format!("there is no scene '{name}'; known are {known}").into())
}

fn elsewhere(name: &str) -> Option<&'static (&'static str, &'static str, [u32; 2], u32)> {
    ELSEWHERE.iter().find(|(own, ..)| *own == name)
}

fn path(name: &str) -> PathBuf {
    elsewhere(name).map_or_else(|| Path::new(FOLDER).join(format!("{name}.lua")), |(_, path, ..)| PathBuf::from(path))
}

/// The only picture of a scene, at another size or number of camera samples where given.
pub fn load(name: &str, size: Option<[u32; 2]>, samples: Option<u32>) -> Result<Scene> {
    if let Some(thousands) = triangles::thousands(name) {
        let mut scene = triangles::scene(thousands)?;
        scene.size = size.unwrap_or(scene.size);
        scene.sampling.camera = samples.unwrap_or(scene.sampling.camera);
        return Ok(scene);
    }
    check(name)?;
    let path = path(name);
    let scenes = load_scene(&path, &ScriptOptions::default())?;
    let [mut scene] = <[Scene; 1]>::try_from(scenes)
        .map_err(|scenes| format!("{}: {} pictures where the benchmark takes one", path.display(), scenes.len()))?;
    if let Some((.., own_size, own_samples)) = elsewhere(name) {
        (scene.size, scene.sampling.camera) = (*own_size, *own_samples);
    }
    scene.size = size.unwrap_or(scene.size);
    scene.sampling.camera = samples.unwrap_or(scene.sampling.camera);
    Ok(scene)
}

/// "640x480" as width and height.
pub fn parse_size(text: &str) -> Result<[u32; 2], String> {
    let edges = text.split_once('x').and_then(|(width, height)| Some([width.parse().ok()?, height.parse().ok()?]));
    let [width, height] = edges.ok_or("expected a width and a height in pixels, such as 640x480")?;
    Film::check_size(width, height).map_err(|error| error.to_string())?;
    Ok([width, height])
}
