// What a surface does to light: Whitted's model with Phong's or Blinn's highlight, Schlick's Fresnel term, Snell's law.

// Reflected light of one light's unit irradiance: n, l (to the light) and v (to the viewer) are unit vectors.
// The highlight, Phong's (r.v)^p or Blinn's (n.h)^p, is not multiplied by the diffuse colour and is there only where
// n.l > 0.
fn phong(material: Material, n: vec3<f32>, l: vec3<f32>, v: vec3<f32>, blinn: bool) -> vec3<f32> {
    let n_dot_l = dot(n, l);
    var cosine: f32;
    if (blinn) {
        cosine = dot(n, unit_vector(l + v));
    } else {
        cosine = dot(2.0 * n_dot_l * n - l, v);
    }
    let highlight = power(max(cosine, 0.0), material.shininess);
    let lit = material.diffuse * n_dot_l + material.specular * highlight;
    return select(vec3<f32>(0.0), lit, n_dot_l > 0.0);
}

// Schlick 1994, from the indices on the two sides. The cosine is that of the larger angle, which on leaving the denser
// side is the refracted one.
fn fresnel_schlick(n1: f32, n2: f32, cos_incident: f32, cos_refracted: f32) -> f32 {
    let ratio = (n1 - n2) / (n1 + n2);
    let r0 = ratio * ratio;
    let c = 1.0 - select(cos_incident, cos_refracted, n1 > n2);
    return r0 + (1.0 - r0) * (c * c * c * c * c);
}

struct Refraction {
    // Unit; meaningless under total internal reflection.
    direction: vec3<f32>,
    cos_incident: f32,
    cos_refracted: f32,
    total: bool,
};

// Snell's law for the unit direction d against the unit normal n on its side, from index n1 into n2.
fn refract_direction(d: vec3<f32>, n: vec3<f32>, n1: f32, n2: f32) -> Refraction {
    let eta = n1 / n2;
    let cos_incident = -dot(d, n);
    let k = 1.0 - eta * eta * (1.0 - cos_incident * cos_incident);
    let cos_refracted = sqrt(max(k, 0.0));
    return Refraction(eta * d + (eta * cos_incident - cos_refracted) * n, cos_incident, cos_refracted, k < 0.0);
}

// The media around a point, innermost first: four 16-bit numbers, 0 for none. The number of a refractive medium is the
// index of its material plus 1. Where solids overlap, leaving one that is not innermost changes nothing. Mists have
// lists of the same form (shading/medium.wgsl).
fn media_contains(media: vec2<u32>, medium: u32) -> bool {
    return (media.x & 0xffffu) == medium || (media.x >> 16u) == medium
        || (media.y & 0xffffu) == medium || (media.y >> 16u) == medium;
}

fn media_enter(media: vec2<u32>, medium: u32) -> vec2<u32> {
    return vec2<u32>((media.x << 16u) | medium, (media.y << 16u) | (media.x >> 16u));
}

// Without branches, since the kernel holds several copies: each place takes the next one's number from the medium on.
fn media_leave(media: vec2<u32>, medium: u32) -> vec2<u32> {
    let first = media.x & 0xffffu;
    let second = media.x >> 16u;
    let third = media.y & 0xffffu;
    let fourth = media.y >> 16u;
    let from_first = first == medium;
    let from_second = from_first || second == medium;
    let from_third = from_second || third == medium;
    let from_fourth = from_third || fourth == medium;
    return vec2<u32>(
        select(first, second, from_first) | (select(second, third, from_second) << 16u),
        select(third, fourth, from_third) | (select(fourth, 0u, from_fourth) << 16u),
    );
}

// Refractive index at a point within these media; 1 outside them all.
fn media_index(media: vec2<u32>) -> f32 {
    let medium = media.x & 0xffffu;
    if (medium == 0u) {
        return 1.0;
    }
    return materials[medium - 1u].ior;
}
