//! Volumes of mist among the instances: each has a material of its own, whose number says which volume a ray is in.

use super::bounds::Bounds;
use crate::layout::{INSTANCE_MIST, Instance, MATERIAL_MIST, Material};
use crate::{Error, Result};
use glam::{DAffine3, DVec3};

/// How far a ray goes on to be past a boundary, as a share of the largest coordinate: more than single precision is off.
const STEP: f64 = 1.0 / (1 << 20) as f64;
/// Volumes grow by this many steps, or by two, three or four times as many, one after another.
const GROWTH: f64 = 4.0;

/// Gives each volume of mist what tells it from the others.
///
/// Mist is often modelled with sides in common with what it touches: a fog bank on the floor, slabs one above the other.
/// Every volume therefore grows by a few of the steps with which rays cross boundaries, and neighbours by different
/// numbers of them, so that no boundary is passed unseen. The largest growth is 2^-16 of the largest coordinate.
pub struct Mists<'a> {
    materials: &'a mut Vec<Material>,
    used: Vec<bool>,
    eye: DVec3,
    count: u32,
}

impl<'a> Mists<'a> {
    /// `eye` is the camera's place in the world; far from the scene, rays from there are less exact.
    pub fn new(materials: &'a mut Vec<Material>, eye: DVec3) -> Self {
        Mists { used: vec![false; materials.len()], materials, eye, count: 0 }
    }

    /// Whether the material at this index is mist's.
    pub fn holds(&self, material: u32) -> bool {
        self.materials.get(material as usize).is_some_and(|material| material.flags & MATERIAL_MIST != 0)
    }

    /// The transform of the next volume: `world_from_object`, grown about the middle of `object_bounds`. Also the step
    /// across its boundary.
    pub fn grown(&mut self, world_from_object: &DAffine3, object_bounds: &Bounds) -> (DAffine3, f64) {
        let world = object_bounds.transformed(world_from_object);
        let step = STEP * world.min.abs().max(world.max.abs()).max(self.eye.abs()).max_element();
        let growth = step * GROWTH * f64::from(1 + self.count % 4);
        self.count += 1;
        let centre = (object_bounds.min + object_bounds.max) * 0.5;
        let half = (object_bounds.max - object_bounds.min) * 0.5;
        let columns = world_from_object.matrix3;
        let lengths = half * DVec3::new(columns.x_axis.length(), columns.y_axis.length(), columns.z_axis.length());
        let factor = |length: f64| if length > growth { 1.0 + growth / length } else { 1.0 };
        let scale = DVec3::new(factor(lengths.x), factor(lengths.y), factor(lengths.z));
        let grow =
            DAffine3::from_translation(centre) * DAffine3::from_scale(scale) * DAffine3::from_translation(-centre);
        (*world_from_object * grow, step)
    }

    /// Marks the instance and gives it a material of its own.
    ///
    /// # Errors
    /// [`Error::Scene`] where the numbers of the materials would not fit 16 bits.
    pub fn mark(&mut self, instance: &mut Instance, step: f64) -> Result<()> {
        let shared = instance.material as usize;
        if std::mem::replace(&mut self.used[shared], true) {
            instance.material = self.materials.len() as u32;
            self.materials.push(self.materials[shared]);
            self.used.push(true);
        }
        let Ok(number) = u16::try_from(instance.material + 1) else {
            return Err(Error::Scene(format!(
                "the scene has too many volumes of mist: with its other materials at most {} are possible",
                u16::MAX
            )));
        };
        let material = &mut self.materials[instance.material as usize];
        material.medium = u32::from(number);
        material.mist_step = step as f32;
        instance.flags = INSTANCE_MIST;
        Ok(())
    }
}
