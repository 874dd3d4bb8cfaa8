//! What a surface does to light; twin of `shaders/shading/material.wgsl`.

use crate::cpu::bindings::Bindings;
use crate::cpu::math::elementary::{power, unit_vector};
use crate::layout::Material;
use glam::{UVec2, Vec3};

/// Reflected light of one light's unit irradiance: n, l (to the light) and v (to the viewer) are unit vectors.
/// The highlight, Phong's (r·v)^p or Blinn's (n·h)^p, is not multiplied by the diffuse colour and is there only where
/// n·l > 0.
pub fn phong(material: &Material, n: Vec3, l: Vec3, v: Vec3, blinn: bool) -> Vec3 {
    let n_dot_l = n.dot(l);
    let cosine = if blinn { n.dot(unit_vector(l + v)) } else { (2.0 * n_dot_l * n - l).dot(v) };
    let highlight = power(cosine.max(0.0), material.shininess);
    let lit = material.diffuse * n_dot_l + material.specular * highlight;
    if n_dot_l > 0.0 { lit } else { Vec3::ZERO }
}

/// Schlick 1994, from the indices on the two sides. The cosine is that of the larger angle, which on leaving the denser
/// side is the refracted one.
pub fn fresnel_schlick(n1: f32, n2: f32, cos_incident: f32, cos_refracted: f32) -> f32 {
    let ratio = (n1 - n2) / (n1 + n2);
    let r0 = ratio * ratio;
    let c = 1.0 - if n1 > n2 { cos_refracted } else { cos_incident };
    r0 + (1.0 - r0) * (c * c * c * c * c)
}

/// A refracted direction, unit; meaningless under total internal reflection.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Refraction {
    pub direction: Vec3,
    pub cos_incident: f32,
    pub cos_refracted: f32,
    pub total: bool,
}

/// Snell's law for the unit direction d against the unit normal n on its side, from index n1 into n2.
pub fn refract_direction(d: Vec3, n: Vec3, n1: f32, n2: f32) -> Refraction {
    let eta = n1 / n2;
    let cos_incident = -d.dot(n);
    let k = 1.0 - eta * eta * (1.0 - cos_incident * cos_incident);
    let cos_refracted = k.max(0.0).sqrt();
    Refraction {
        direction: eta * d + (eta * cos_incident - cos_refracted) * n,
        cos_incident,
        cos_refracted,
        total: k < 0.0,
    }
}

/// Whether a list of media (see the WGSL twin) holds `medium`.
pub fn media_contains(media: UVec2, medium: u32) -> bool {
    media.x & 0xffff == medium || media.x >> 16 == medium || media.y & 0xffff == medium || media.y >> 16 == medium
}

pub fn media_enter(media: UVec2, medium: u32) -> UVec2 {
    UVec2::new((media.x << 16) | medium, (media.y << 16) | (media.x >> 16))
}

pub fn media_leave(media: UVec2, medium: u32) -> UVec2 {
    let first = media.x & 0xffff;
    let second = media.x >> 16;
    let third = media.y & 0xffff;
    let fourth = media.y >> 16;
    let from_first = first == medium;
    let from_second = from_first || second == medium;
    let from_third = from_second || third == medium;
    let from_fourth = from_third || fourth == medium;
    UVec2::new(
        if from_first { second } else { first } | (if from_second { third } else { second } << 16),
        if from_third { fourth } else { third } | (if from_fourth { 0 } else { fourth } << 16),
    )
}

/// Refractive index at a point within these media; 1 outside them all.
pub fn media_index(scene: &Bindings, media: UVec2) -> f32 {
    let medium = media.x & 0xffff;
    if medium == 0 {
        return 1.0;
    }
    scene.materials[medium as usize - 1].ior
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn media_form_a_list() {
        let media = [7, 8, 9, 10].into_iter().fold(UVec2::ZERO, media_enter);
        assert_eq!(media.x & 0xffff, 10);
        for (gone, innermost) in [(10, 9), (8, 10), (9, 10), (7, 10), (99, 10)] {
            let rest = media_leave(media, gone);
            assert_eq!(rest.x & 0xffff, innermost);
            assert!(!media_contains(rest, gone));
            let kept = [7, 8, 9, 10].into_iter().filter(|medium| media_contains(rest, *medium)).count();
            assert_eq!(kept, if gone == 99 { 4 } else { 3 });
        }
        assert_eq!([10, 9, 8, 7].into_iter().fold(media, media_leave), UVec2::ZERO);
    }
}
