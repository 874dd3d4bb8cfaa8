// Incoherent diffuse paths, for their rays alone: `walk` in benches/rays/main.rs is the same in Rust, and
// benches/peers/rays.cpp on Embree.

const SAMPLES: u32 = 4u;
const BOUNCES: u32 = 3u;
// Blocks that one workgroup walks, so that a lane has the paths of this many pixels: the more paths, the less they differ
// in their sum of rays, and lanes wait for the longest sum.
const BLOCKS: u32 = 4u;

fn pcg(value: u32) -> u32 {
    let state = value * 747796405u + 2891336453u;
    let word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    return (word >> 22u) ^ word;
}

var<private> random_state: u32;

fn uniform_number() -> f32 {
    random_state = pcg(random_state);
    return unit_from_bits(random_state);
}

@compute @workgroup_size(64)
fn walk(@builtin(workgroup_id) group: vec3<u32>, lane: Lane) {
    claim_lane(lane);
    tally = Tally(0u, vec4<u32>(0u));
    for (var turn = 0u; ; turn++) {
        let work = take_work(group.x, turn, lane);
        if (work.x >= dispatch.first_block + dispatch.block_count) {
            break;
        }
        walk_paths(work);
    }
    atomicAdd(&status.rays[group.x % RAY_SLOTS], tally.rays[0]);
    if (tally.flags != 0u) {
        atomicOr(&status.flags, tally.flags);
    }
}

// All paths of a pixel in each of BLOCKS blocks.
fn walk_paths(work: vec2<u32>) {
    var pixel: vec2<u32>;
    var origin: vec3<f32>;
    var direction: vec3<f32>;
    var path = 0u;
    var bounce = 0u;
    // Each turn traces one ray, so that lanes whose path has ended go on with the next.
    while (path < BLOCKS * SAMPLES) {
        if (bounce == 0u) {
            if (path % SAMPLES == 0u) {
                pixel = block_at(work.x * BLOCKS + path / SAMPLES) * BLOCK_EDGE + pixel_in_block(work.y);
                random_state = pcg(pixel.x + pixel.y * frame.image_size.x);
            }
            let x = (f32(pixel.x) + uniform_number()) / f32(frame.image_size.x) * 2.0 - 1.0;
            let y = 1.0 - (f32(pixel.y) + uniform_number()) / f32(frame.image_size.y) * 2.0;
            origin = vec3<f32>(0.0, 1.2, 3.2);
            direction = normalize(vec3<f32>(0.8 * x, 0.8 * y - 0.35, -1.0));
        }
        tally.rays[0] += 1u;
        let hit = traverse(origin, direction, T_INFINITY, false, INSTANCE_SEEN);
        if (hit.t < 0.0) {
            path++;
            bounce = 0u;
            continue;
        }
        let triangle = triangle_at(hit.primitive);
        var normal = triangle_geometric_normal(triangle.p0, triangle.p1, triangle.p2);
        normal = select(normal, -normal, dot(normal, direction) > 0.0);
        origin += hit.t * direction + 1e-3 * normal;
        let phi = 6.2831853 * uniform_number();
        let z = 2.0 * uniform_number() - 1.0;
        let sine = sqrt(max(1.0 - z * z, 0.0));
        direction = normalize(normal + 0.999 * vec3<f32>(sine * cos(phi), sine * sin(phi), z));
        bounce++;
        if (bounce > BOUNCES) {
            path++;
            bounce = 0u;
        }
    }
}
