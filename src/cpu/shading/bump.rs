//! Normals turned by a height field (Blinn 1978, "Simulation of Wrinkled Surfaces"). Twin of
//! `shaders/shading/bump.wgsl`.

use super::texture::{texture_lookup, texture_size};
use crate::cpu::bindings::Bindings;
use crate::cpu::geometry::hit::Parameterisation;
use crate::cpu::math::elementary::unit_vector;
use crate::cpu::math::noise::perlin_octaves;
use crate::layout::{MATERIAL_NOISE_BUMP, Material};
use glam::{Vec2, Vec3};

/// Perlin bumps take differences as if the noise were an image this wide and high.
pub const NOISE_TEXELS: f32 = 512.0;
/// The noise at neighbouring 512ths differs by some 0.004, which would turn a normal by less than a degree: its heights
/// count for this much more than an image's.
pub const NOISE_HEIGHT: f32 = 32.0;

/// Height of a material's bump map: the mean of an image's red, green and blue, or noise.
pub fn bump_height(scene: &Bindings, material: &Material, uv: Vec2, footprint: f32) -> f32 {
    if material.flags & MATERIAL_NOISE_BUMP != 0 {
        return NOISE_HEIGHT * perlin_octaves(uv.x, uv.y, material.noise_z);
    }
    let colour = texture_lookup(scene, material.bump, uv, footprint);
    (colour.x + colour.y + colour.z) / 3.0
}

/// Change of the height from texel to texel along u and v. Where the footprint is wider than a texel, the difference is
/// taken across it, and is the mean over it: bumps too small to see fade out and do not sparkle.
pub fn bump_slope(scene: &Bindings, material: &Material, uv: Vec2, footprint: f32) -> Vec2 {
    let texel = if material.flags & MATERIAL_NOISE_BUMP == 0 {
        1.0 / texture_size(scene, material.bump)
    } else {
        Vec2::splat(1.0 / NOISE_TEXELS)
    };
    let width = texel.max(Vec2::splat(footprint));
    let mut slope = Vec2::ZERO;
    for tap in 0..4 {
        let side = if tap & 1 == 0 { -0.5 } else { 0.5 };
        let axis = if tap < 2 { Vec2::X } else { Vec2::Y };
        let height = 2.0 * side * bump_height(scene, material, uv + side * (width * axis), footprint);
        slope += height * axis;
    }
    slope * (texel / width)
}

/// The unit normal of the surface after its points have moved along the unit normal n by heights that change by
/// `slope` = (Bu, Bv): n + Bu (n × Pv) − Bv (n × Pu) where Pu, Pv, n are right-handed, and the opposite tilt where they
/// are left-handed, so that greater heights rise on n's side. Blinn's division by |Pu × Pv| is left out, so
/// that slopes have no unit.
pub fn tilted_normal(n: Vec3, dpdu: Vec3, dpdv: Vec3, slope: Vec2) -> Vec3 {
    let c = dpdu.cross(dpdv);
    let tilt = slope.x * n.cross(dpdv) - slope.y * n.cross(dpdu);
    let turned = n + if c.x * n.x + c.y * n.y + c.z * n.z < 0.0 { -tilt } else { tilt };
    let length_squared = turned.x * turned.x + turned.y * turned.y + turned.z * turned.z;
    // The tilt is across n, so that the length is at least 1, but for tangents that are not finite.
    if length_squared < 3.0e38 { turned / length_squared.sqrt() } else { n }
}

/// The unit outward normal under the material's bump map; all in the space of the parameterisation, the footprint in
/// units of uv.
pub fn bump_normal(
    scene: &Bindings,
    material: &Material,
    parameterisation: &Parameterisation,
    normal: Vec3,
    footprint: f32,
) -> Vec3 {
    let slope = bump_slope(scene, material, parameterisation.uv, footprint);
    tilted_normal(normal, parameterisation.dpdu, parameterisation.dpdv, slope)
}

/// The unit normal n bent towards the true normal as little as makes it face the viewer and mirror the view to above
/// the surface, as Cycles does (Blender, kernel/closure/bsdf_util.h, ensure_valid_specular_reflection). n·v ends up at
/// least half as large as for the true normal, so that no visible point goes black that the viewer's own lamp lights.
/// `view` is unit, towards the viewer.
pub fn visible_normal(n: Vec3, geometric_normal: Vec3, view: Vec3) -> Vec3 {
    let view_z = view.dot(geometric_normal).max(1.0e-4);
    // Mirrored rays may leave as low as the view came, and this low at any rate.
    let lowest = (0.9 * view_z).min(0.01);
    let n_z = n.dot(geometric_normal);
    if n_z > 0.0 && 2.0 * n.dot(view) * n_z - view_z >= lowest {
        return n;
    }
    // In the plane of both normals: with the angle a of n from the true normal (z) towards x, the mirrored view's
    // height is view_x sin(2a) + view_z cos(2a). It falls to `lowest` where (cos 2a, sin 2a) is (c, s).
    let across = n - n_z * geometric_normal;
    let across_squared = across.dot(across);
    if across_squared < 1.0e-12 {
        return geometric_normal;
    }
    let x = across / across_squared.sqrt();
    let view_x = view.dot(x);
    let a = view_x * view_x + view_z * view_z;
    let rest = (a - lowest * lowest).sqrt();
    let c = (lowest * view_z - rest * view_x) / a;
    let s = (lowest * view_x + rest * view_z) / a;
    unit_vector((1.0 + c) * geometric_normal + s * x)
}
