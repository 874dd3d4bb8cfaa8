// Normals turned by a height field (Blinn 1978, "Simulation of Wrinkled Surfaces").

// Perlin bumps take differences as if the noise were an image this wide and high.
const NOISE_TEXELS: f32 = 512.0;
// The noise at neighbouring 512ths differs by some 0.004, which would turn a normal by less than a degree: its heights
// count for this much more than an image's.
const NOISE_HEIGHT: f32 = 32.0;

// Height of a material's bump map: the mean of an image's red, green and blue, or noise.
fn bump_height(material: Material, uv: vec2<f32>, footprint: f32) -> f32 {
    if (material.flags & MATERIAL_NOISE_BUMP) != 0u {
        return NOISE_HEIGHT * perlin_octaves(uv.x, uv.y, material.noise_z);
    }
    let colour = texture_lookup(material.bump, uv, footprint);
    return (colour.x + colour.y + colour.z) / 3.0;
}

// Change of the height from texel to texel along u and v. Where the footprint is wider than a texel, the difference is
// taken across it, and is the mean over it: bumps too small to see fade out and do not sparkle.
fn bump_slope(material: Material, uv: vec2<f32>, footprint: f32) -> vec2<f32> {
    var texel = vec2<f32>(1.0 / NOISE_TEXELS);
    if (material.flags & MATERIAL_NOISE_BUMP) == 0u {
        texel = 1.0 / texture_size(material.bump);
    }
    let width = max(texel, vec2<f32>(footprint));
    // One call site for the four heights: u's two, then v's.
    var slope = vec2<f32>(0.0);
    for (var tap = 0u; tap < 4u; tap++) {
        let side = select(0.5, -0.5, (tap & 1u) == 0u);
        let along_u = tap < 2u;
        let offset = side * select(vec2<f32>(0.0, width.y), vec2<f32>(width.x, 0.0), along_u);
        let height = 2.0 * side * bump_height(material, uv + offset, footprint);
        slope += select(vec2<f32>(0.0, height), vec2<f32>(height, 0.0), along_u);
    }
    return slope * (texel / width);
}

// The unit normal of the surface after its points have moved along the unit normal n by heights that change by
// `slope` = (Bu, Bv): n + Bu (n x Pv) - Bv (n x Pu) where Pu, Pv, n are right-handed, and the opposite tilt where they
// are left-handed, so that greater heights rise on n's side. Blinn's division by |Pu x Pv| is left out, so
// that slopes have no unit.
fn tilted_normal(n: vec3<f32>, dpdu: vec3<f32>, dpdv: vec3<f32>, slope: vec2<f32>) -> vec3<f32> {
    let c = cross(dpdu, dpdv);
    let tilt = slope.x * cross(n, dpdv) - slope.y * cross(n, dpdu);
    let turned = n + select(tilt, -tilt, c.x * n.x + c.y * n.y + c.z * n.z < 0.0);
    let length_squared = turned.x * turned.x + turned.y * turned.y + turned.z * turned.z;
    // The tilt is across n, so that the length is at least 1, but for tangents that are not finite.
    return select(n, turned / sqrt(length_squared), length_squared < 3.0e38);
}

// The unit outward normal under the material's bump map; all in the space of the parameterisation, the footprint in
// units of uv.
fn bump_normal(material: Material, parameterisation: Parameterisation, normal: vec3<f32>, footprint: f32) -> vec3<f32> {
    let slope = bump_slope(material, parameterisation.uv, footprint);
    return tilted_normal(normal, parameterisation.dpdu, parameterisation.dpdv, slope);
}

// The unit normal n bent towards the true normal as little as makes it face the viewer and mirror the view to above the
// surface, as Cycles does (Blender, kernel/closure/bsdf_util.h, ensure_valid_specular_reflection). n.v ends up at least
// half as large as for the true normal, so that no visible point goes black that the viewer's own lamp lights.
// `view` is unit, towards the viewer.
fn visible_normal(n: vec3<f32>, geometric_normal: vec3<f32>, view: vec3<f32>) -> vec3<f32> {
    let view_z = max(dot(view, geometric_normal), 1.0e-4);
    // Mirrored rays may leave as low as the view came, and this low at any rate.
    let lowest = min(0.9 * view_z, 0.01);
    let n_z = dot(n, geometric_normal);
    if n_z > 0.0 && 2.0 * dot(n, view) * n_z - view_z >= lowest {
        return n;
    }
    // In the plane of both normals: with the angle a of n from the true normal (z) towards x, the mirrored view's height
    // is view_x sin(2a) + view_z cos(2a). It falls to `lowest` where (cos 2a, sin 2a) is (c, s).
    let across = n - n_z * geometric_normal;
    let across_squared = dot(across, across);
    if across_squared < 1.0e-12 {
        return geometric_normal;
    }
    let x = across / sqrt(across_squared);
    let view_x = dot(view, x);
    let a = view_x * view_x + view_z * view_z;
    let rest = sqrt(a - lowest * lowest);
    let c = (lowest * view_z - rest * view_x) / a;
    let s = (lowest * view_x + rest * view_z) / a;
    return unit_vector((1.0 + c) * geometric_normal + s * x);
}
