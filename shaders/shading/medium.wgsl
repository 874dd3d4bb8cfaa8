// Mist: closed volumes that are equally dense throughout and scatter light once. Along a ray, the way to the next
// scattering event is distributed exponentially (free flight; Shirley, Morley, "Realistic Ray Tracing", 2003, ch. on
// participating media); where volumes overlap, their densities add up.
// A list of mists is one of media (shading/material.wgsl), used as a set: a mist's number is the index of its material
// plus 1, and src/flatten/mist.rs gives every volume a material of its own. What of it happens twice changes nothing.

// Boundaries that one ray may cross.
const MIST_CROSSINGS: u32 = 256u;

// The list beyond a boundary.
fn mist_cross(mists: vec2<u32>, number: u32, entering: bool) -> vec2<u32> {
    if (!entering) {
        return media_leave(mists, number);
    }
    if (media_contains(mists, number)) {
        return mists;
    }
    return media_enter(mists, number);
}

// Where a ray goes on that met a boundary at t and `point`, which is more exact than t. A boundary that is met again
// just after it was crossed is one whose intersection is less exact than the step: there the ray is moved on from where
// it was, lest `point` takes it back.
fn beyond_boundary(point: vec3<f32>, origin: vec3<f32>, direction: vec3<f32>, t: f32, step: f32) -> vec3<f32> {
    let along = dot(point - origin, direction);
    return select(origin + (t + 4.0 * step) * direction, point + step * direction, along > step);
}

// Scattering events a world unit of one mist; number 0 is none.
fn mist_density(number: u32) -> f32 {
    if (number == 0u) {
        return 0.0;
    }
    return materials[number - 1u].density;
}

// The same of all the mists together.
fn mists_density(mists: vec2<u32>) -> f32 {
    return mist_density(mists.x & 0xffffu) + mist_density(mists.x >> 16u)
        + mist_density(mists.y & 0xffffu) + mist_density(mists.y >> 16u);
}

// World units to the next scattering event, by inversion of exp(-density * s).
fn free_flight(density: f32, xi: f32) -> f32 {
    if (density <= 0.0) {
        return T_INFINITY;
    }
    return -0.6931472 * log2_poly(1.0 - xi) / density;
}

// Which of the mists scatters, in proportion to their densities.
fn choose_mist(mists: vec2<u32>, xi: f32) -> u32 {
    var left = xi * mists_density(mists);
    left -= mist_density(mists.x & 0xffffu);
    if (left < 0.0 || (mists.x >> 16u) == 0u) {
        return mists.x & 0xffffu;
    }
    left -= mist_density(mists.x >> 16u);
    if (left < 0.0 || (mists.y & 0xffffu) == 0u) {
        return mists.x >> 16u;
    }
    left -= mist_density(mists.y & 0xffffu);
    if (left < 0.0 || (mists.y >> 16u) == 0u) {
        return mists.y & 0xffffu;
    }
    return mists.y >> 16u;
}

// A scattering event as light_sample takes it: a surface without a normal.
fn mist_event(point: vec3<f32>, number: u32) -> Surface {
    let none = vec3<f32>(0.0);
    return Surface(point, none, none, false, number - 1u, materials[number - 1u].diffuse);
}

fn is_mist_event(surface: Surface) -> bool {
    return all(surface.geometric_normal == vec3<f32>(0.0));
}
