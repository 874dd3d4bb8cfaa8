//! Where the files named in a scene are looked for, and which of them Lua itself may read.

use std::fs;
use std::path::{Path, PathBuf};

/// The working folder, the scene's folder, its parent and its grandparent; each also with `Assets/`.
#[derive(Debug)]
pub(super) struct SearchPath {
    folders: Vec<Folder>,
}

#[derive(Debug)]
struct Folder {
    /// What a file's name is appended to, as short as the user's own words allow.
    path: PathBuf,
    /// Absolute, with symbolic links resolved.
    real: PathBuf,
}

/// Why a file was not found.
#[derive(Debug)]
pub(super) enum NotFound {
    /// The places looked at, in order.
    Nowhere(Vec<PathBuf>),
    /// It is there, but Lua may not read it.
    Outside(PathBuf),
}

impl NotFound {
    pub fn message(&self, name: &str) -> String {
        match self {
            NotFound::Nowhere(places) => {
                let places: Vec<String> = places.iter().map(|place| format!("'{}'", place.display())).collect();
                format!("cannot find '{name}'; looked for {}", places.join(", "))
            }
            NotFound::Outside(path) => {
                format!("'{name}' is outside the scene's folders ('{}'), and may not be read", path.display())
            }
        }
    }
}

impl SearchPath {
    /// For the scene at `scene`, which need not exist.
    pub fn new(scene: &Path) -> Self {
        let scene_folder = match scene.parent() {
            Some(folder) if !folder.as_os_str().is_empty() => folder.to_owned(),
            _ => PathBuf::from("."),
        };
        let mut search = SearchPath { folders: Vec::new() };
        search.add(PathBuf::from("."));
        search.add(scene_folder.clone());
        if let Ok(real) = fs::canonicalize(&scene_folder) {
            for above in real.ancestors().skip(1).take(2) {
                search.add(above.to_owned());
            }
        }
        search
    }

    fn add(&mut self, path: PathBuf) {
        if let Ok(real) = fs::canonicalize(&path)
            && !self.folders.iter().any(|folder| folder.real == real)
        {
            self.folders.push(Folder { path, real });
        }
    }

    /// The first regular file of that name.
    ///
    /// # Errors
    /// [`NotFound::Nowhere`].
    pub fn find(&self, name: &str) -> Result<PathBuf, NotFound> {
        let mut tried = Vec::new();
        for place in self.places(name) {
            if place.is_file() {
                return Ok(place);
            }
            tried.push(place);
        }
        Err(NotFound::Nowhere(tried))
    }

    /// The first regular file of that name that lies in the scene's folders, symbolic links resolved.
    ///
    /// # Errors
    /// [`NotFound`].
    pub fn find_inside(&self, name: &str) -> Result<PathBuf, NotFound> {
        let mut tried = Vec::new();
        let mut outside = None;
        for place in self.places(name) {
            if place.is_file() {
                match fs::canonicalize(&place) {
                    Ok(real) if self.contains(&real) => return Ok(place),
                    _ => outside = outside.or(Some(place.clone())),
                }
            }
            tried.push(place);
        }
        Err(outside.map_or(NotFound::Nowhere(tried), NotFound::Outside))
    }

    fn places(&self, name: &str) -> Vec<PathBuf> {
        let name = Path::new(name);
        if name.is_absolute() {
            return vec![name.to_owned()];
        }
        self.folders
            .iter()
            .flat_map(|folder| {
                let start = if folder.path == Path::new(".") { Path::new("") } else { &folder.path };
                [start.join(name), start.join("Assets").join(name)]
            })
            .collect()
    }

    /// Whether a resolved path lies in one of the folders. The root of the file system stands for its own files only:
    /// a scene two folders below it does not open the whole disk.
    fn contains(&self, real: &Path) -> bool {
        self.folders.iter().any(|folder| match folder.real.parent() {
            Some(_) => real.starts_with(&folder.real),
            None => real.parent().is_some_and(|parent| parent == folder.real || parent == folder.real.join("Assets")),
        })
    }
}
