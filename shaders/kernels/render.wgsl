// One pass of some camera samples for each pixel of a run of 8 x 8 blocks.

@compute @workgroup_size(64)
fn render(@builtin(workgroup_id) group: vec3<u32>, lane: Lane) {
    claim_lane(lane);
    tally = Tally(0u, vec4<u32>(0u));
    // Bounded by the pixels of the dispatch, each of which is taken once.
    for (var turn = 0u; ; turn++) {
        let work = take_work(group.x, turn, lane);
        if (work.x >= dispatch.first_block + dispatch.block_count) {
            break;
        }
        let in_band = block_at(work.x) * BLOCK_EDGE + pixel_in_block(work.y);
        if (in_band.x < frame.image_size.x && in_band.y < dispatch.band_rows) {
            render_pixel(in_band);
        }
    }

    // Drivers that cap the turns of all loops of an invocation (Mesa before 23: 65,535) leave every loop early from then
    // on without a word; this one would too.
    var turns = 0u;
    for (var turn = 0u; turn < dispatch.canary_turns; turn++) {
        turns++;
    }
    if (turns != dispatch.canary_turns) {
        tally.flags |= STATUS_LOOP_BOUND;
    }

    if (tally.flags != 0u) {
        atomicOr(&status.flags, tally.flags);
    }
    // Counters are spread over slots, since all invocations add to them.
    let slot = group.x % RAY_SLOTS;
    for (var kind = 0u; kind < RAY_KINDS; kind++) {
        if (tally.rays[kind] > 0u) {
            atomicAdd(&status.rays[kind * RAY_SLOTS + slot], tally.rays[kind]);
        }
    }
}

// Adds the samples of the dispatch to a pixel, whose column and row are counted from the band's upper left corner.
fn render_pixel(in_band: vec2<u32>) {
    let pixel = in_band + vec2<u32>(0u, dispatch.band_row);
    let film_index = in_band.y * frame.image_size.x + in_band.x;
    var sum = film[film_index];
    for (var i = 0u; i < dispatch.sample_count; i++) {
        let sample_index = dispatch.sample_index + i;
        tally.rays[RAY_CAMERA] += 1u;
        let camera = camera_ray(pixel, sample_index);
        // Passes share a sample: each counts for its part, so that a film sums whole samples.
        let radiance = path_radiance(camera, sample_index) / f32(frame.pass_count);
        sum = film_add(sum, radiance);
    }
    film[film_index] = sum;
}
