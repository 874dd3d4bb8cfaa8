//! Embree on the same rays: benches/peers/rays.cpp, compiled where Embree and a compiler are installed.

use crate::{Result, Traced, mesh};
use gpu_trace::scene::Mesh;
use std::path::{Path, PathBuf};
use std::process::Command;

const FOLDER: &str = "target/bench";

pub struct Embree {
    program: PathBuf,
    mesh: PathBuf,
}

impl Embree {
    /// Compiles the program and writes the mesh; `None` where Embree's headers are not installed.
    pub fn prepare(mesh: &Mesh) -> Result<Option<Self>> {
        std::fs::create_dir_all(FOLDER)?;
        let embree =
            Embree { program: Path::new(FOLDER).join("embree_rays"), mesh: Path::new(FOLDER).join("rays.mesh") };
        let built = Command::new("g++")
            .args(["-O3", "-march=native", "-o"])
            .arg(&embree.program)
            .args(["benches/peers/rays.cpp", "-lembree3", "-lpthread"])
            .output();
        match built {
            Ok(output) if output.status.success() => {}
            Ok(output) if String::from_utf8_lossy(&output.stderr).contains("embree3/") => return Ok(None),
            Ok(output) => return Err(String::from_utf8_lossy(&output.stderr).into()),
            Err(_) => return Ok(None),
        }
        std::fs::write(&embree.mesh, mesh::corners(mesh))?;
        Ok(Some(embree))
    }

    /// One run, on all cores, in a process of its own: rays and seconds as the program prints them.
    pub fn trace(&self) -> Result<Traced> {
        let threads = std::thread::available_parallelism()?.to_string();
        let output = Command::new(&self.program).arg(&self.mesh).arg(threads).output()?;
        let text = String::from_utf8(output.stdout)?;
        let mut words = text.split_whitespace();
        let mut next = || words.next().ok_or_else(|| format!("Embree's program printed {text:?}"));
        let (rays, seconds) = (next()?.parse()?, next()?.parse()?);
        Ok(Traced { rays, seconds })
    }
}
