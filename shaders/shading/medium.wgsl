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
    return select(0.0, materials[max(number, 1u) - 1u].density, number != 0u);
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

// Which of the mists scatters, in proportion to their densities. Numbers of 0 come last and have no share.
fn choose_mist(mists: vec2<u32>, xi: f32) -> u32 {
    let second = mists.x >> 16u;
    let third = mists.y & 0xffffu;
    let fourth = mists.y >> 16u;
    let to_first = mist_density(mists.x & 0xffffu);
    let to_second = to_first + mist_density(second);
    let to_third = to_second + mist_density(third);
    let aim = xi * (to_third + mist_density(fourth));
    let chosen = select(mists.x & 0xffffu, second, second != 0u && aim >= to_first);
    let later = select(chosen, third, third != 0u && aim >= to_second);
    return select(later, fourth, fourth != 0u && aim >= to_third);
}

// A scattering event as light_sample takes it: a surface without a normal.
fn mist_event(point: vec3<f32>, number: u32) -> Surface {
    let none = vec3<f32>(0.0);
    return Surface(point, none, none, false, number - 1u, materials[number - 1u].diffuse);
}

fn is_mist_event(surface: Surface) -> bool {
    return all(surface.geometric_normal == vec3<f32>(0.0));
}
