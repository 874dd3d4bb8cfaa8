//! What a running script has built so far.

use super::conventions::{ConventionSources, TransformOrder};
use super::library::Library;
use super::search::SearchPath;
use super::{ScriptOptions, diagnostics};
use crate::scene::{
    Background, Bump, FrameRate, Geometry, Image, Material, MaterialId, Mesh, Node, NodeId, SceneGraph,
};
use glam::DAffine3;
use mlua::Lua;
use std::collections::{HashMap, HashSet};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Warnings about single nodes in one picture before they are summed up.
const NODE_WARNINGS: usize = 8;

pub(super) struct State {
    /// Shared with the scenes that were rendered; copied when the script changes it while one still lives.
    graph: Arc<SceneGraph>,
    /// One a node.
    transforms: Vec<NodeTransform>,
    pub conventions: ConventionSources,
    pub files: SearchPath,
    /// By resolved path.
    pub meshes: HashMap<PathBuf, Arc<Mesh>>,
    /// By resolved path.
    pub images: HashMap<PathBuf, Arc<Image>>,
    /// Of the pictures that follow.
    pub background: Background,
    /// Names of the files that were compiled, as messages show them.
    pub chunks: HashSet<String>,
    pub frame: u32,
    pub frames: u32,
    pub rate: FrameRate,
    pub seed: u32,
    pub library: Arc<Library>,
    /// The number of this run in the library.
    pub run: u64,
    pub pictures: u32,
    pub warnings: Vec<String>,
    /// Functions that were called with more arguments than they know.
    pub surplus: HashSet<&'static str>,
    /// Geometry nodes already reported as being without a material.
    bare: HashSet<NodeId>,
    /// The name last looked up in `gr` without success.
    pub missed: Option<String>,
}

/// A node's transform under both orders of multiplication: which one holds may turn out only later in the script.
#[derive(Clone, Copy)]
struct NodeTransform {
    pre: DAffine3,
    post: DAffine3,
    /// Rotation of a joint: applied to the subtree before the rest, in either order.
    joint: Option<glam::DQuat>,
    has_parent: bool,
}

impl NodeTransform {
    fn under(&self, order: TransformOrder) -> DAffine3 {
        let product = match order {
            TransformOrder::Pre => self.pre,
            TransformOrder::Post => self.post,
        };
        self.joint.map_or(product, |joint| product * DAffine3::from_quat(joint))
    }
}

impl State {
    pub fn new(scene: &Path, options: &ScriptOptions) -> Self {
        State {
            graph: Arc::default(),
            transforms: Vec::new(),
            conventions: ConventionSources { command_line: options.conventions, ..ConventionSources::default() },
            files: SearchPath::new(scene),
            meshes: HashMap::new(),
            images: HashMap::new(),
            background: Background::default(),
            chunks: HashSet::new(),
            frame: options.frame,
            frames: options.frames,
            rate: options.rate,
            seed: options.seed,
            run: options.library.begin_run(),
            library: Arc::clone(&options.library),
            pictures: 0,
            warnings: Vec::new(),
            surplus: HashSet::new(),
            bare: HashSet::new(),
            missed: None,
        }
    }

    pub fn graph(&self) -> &Arc<SceneGraph> {
        &self.graph
    }

    /// Bytes that one node takes.
    pub const NODE_BYTES: usize = size_of::<Node>() + size_of::<NodeTransform>() + 32;

    pub fn add_node(&mut self, name: String, geometry: Option<Geometry>, joint: Option<glam::DQuat>) -> NodeId {
        let own = NodeTransform { pre: DAffine3::IDENTITY, post: DAffine3::IDENTITY, joint, has_parent: false };
        self.transforms.push(own);
        let id = Arc::make_mut(&mut self.graph).add_node(Node::new(name, geometry));
        self.place_node(id);
        id
    }

    pub fn add_material(&mut self, material: Material) -> MaterialId {
        Arc::make_mut(&mut self.graph).add_material(material)
    }

    pub fn set_material(&mut self, node: NodeId, material: MaterialId) {
        Arc::make_mut(&mut self.graph).node_mut(node).material = Some(material);
    }

    pub fn set_texture(&mut self, node: NodeId, texture: Option<Arc<Image>>) {
        Arc::make_mut(&mut self.graph).node_mut(node).texture = texture;
    }

    pub fn set_bump(&mut self, node: NodeId, bump: Option<Bump>) {
        Arc::make_mut(&mut self.graph).node_mut(node).bump = bump;
    }

    /// Makes `child` a child of `parent`; `false` and nothing done if that would close a cycle.
    pub fn add_child(&mut self, parent: NodeId, child: NodeId) -> bool {
        // Only a parent that itself has one, and a child that itself has one, can lie on a cycle: this keeps building
        // a scene from either end linear.
        let possible = self.transforms[parent.0 as usize].has_parent && !self.graph.node(child).children.is_empty();
        if parent == child || (possible && self.graph.reaches(child, parent)) {
            return false;
        }
        Arc::make_mut(&mut self.graph).node_mut(parent).children.push(child);
        self.transforms[child.0 as usize].has_parent = true;
        true
    }

    /// Multiplies `step` to the node's transform; `false` and nothing done if the result could not be inverted.
    pub fn transform_node(&mut self, node: NodeId, step: DAffine3) -> bool {
        let own = &mut self.transforms[node.0 as usize];
        let changed = NodeTransform { pre: step * own.pre, post: own.post * step, ..*own };
        let usable = |m: DAffine3| m.is_finite() && m.matrix3.determinant().is_normal();
        if !usable(changed.pre) || !usable(changed.post) {
            return false;
        }
        *own = changed;
        self.place_node(node);
        true
    }

    fn place_node(&mut self, node: NodeId) {
        let transform = self.transforms[node.0 as usize].under(self.conventions.transforms());
        Arc::make_mut(&mut self.graph).node_mut(node).transform = transform;
    }

    /// Changes the conventions, and with them the transforms of all nodes made so far.
    pub fn change_conventions(&mut self, change: impl FnOnce(&mut ConventionSources)) {
        let before = self.conventions.transforms();
        change(&mut self.conventions);
        let order = self.conventions.transforms();
        if order != before {
            let nodes = &mut Arc::make_mut(&mut self.graph).nodes;
            for (node, own) in nodes.iter_mut().zip(&self.transforms) {
                node.transform = own.under(order);
            }
        }
    }

    /// The script does what only scripts for the skeleton from before 2015 do.
    pub fn recognise_old_skeleton(&mut self, lua: &Lua, sign: &str) {
        if self.conventions.old_skeleton || self.conventions.transforms_stated() {
            return;
        }
        self.change_conventions(|conventions| conventions.old_skeleton = true);
        self.warn(
            lua,
            &format!(
                "{sign} marks a scene of the pre-2015 skeleton: transforms post-multiply (M <- M*T) in the whole scene; \
                 gr.conventions{{transforms=\"pre\"}} or --conventions transforms=pre keeps the order of today"
            ),
        );
    }

    /// Warns on stderr, with the place in the script.
    pub fn warn(&mut self, lua: &Lua, message: &str) {
        let place = diagnostics::place(lua).map_or_else(String::new, |place| format!("{place}: "));
        let warning = format!("{place}{message}");
        if self.library.first_time(&warning) {
            log::warn!("{warning}");
        }
        self.warnings.push(warning);
    }

    /// Warns once of each geometry node under `root` that has no material.
    pub fn warn_of_bare_nodes(&mut self, lua: &Lua, root: NodeId) {
        let mut seen = HashSet::new();
        let mut pending = vec![root];
        let mut names = Vec::new();
        while let Some(id) = pending.pop() {
            if !seen.insert(id) {
                continue;
            }
            let node = self.graph.node(id);
            if node.geometry.is_some() && node.material.is_none() && self.bare.insert(id) {
                names.push(node.name.clone());
            }
            pending.extend(node.children.iter().rev());
        }
        for name in names.iter().take(NODE_WARNINGS) {
            self.warn(lua, &format!("'{name}' has no material and is drawn in mid-grey"));
        }
        if names.len() > NODE_WARNINGS {
            self.warn(lua, &format!("{} more nodes have no material", names.len() - NODE_WARNINGS));
        }
    }
}
