// The 8 x 8 pixel blocks of a band of rows, and the order in which they are rendered; src/blocks.rs says why.

const BLOCK_EDGE: u32 = 8u;
// Edge of a tile, blocks.
const TILE_EDGE: u32 = 4u;
const TILE_BLOCKS: u32 = TILE_EDGE * TILE_EDGE;

// The place that a workgroup takes. The last ones of a portion may lie beyond the dispatch's blocks, and have nothing to
// do. Lavapipe's threads take contiguous portions of the workgroups: each gets its share of every few neighbouring
// blocks, so that all have the same to do.
fn place_of(group: u32) -> u32 {
    let portion = (dispatch.block_count + dispatch.portions - 1u) / dispatch.portions;
    return dispatch.first_block + (group % portion) * dispatch.portions + group / portion;
}

// What an invocation takes that renders one pixel: the place of its workgroup's block and its own number there; a place
// behind the last one from turn 1 on.
fn own_work(group: u32, turn: u32, lane: u32) -> vec2<u32> {
    return vec2<u32>(select(dispatch.first_block + dispatch.block_count, place_of(group), turn == 0u), lane);
}

// Column and row of the block at a place, counted in blocks from the band's upper left corner.
fn block_at(place: u32) -> vec2<u32> {
    let tile_size = BLOCK_EDGE * TILE_EDGE;
    let tiles_across = (frame.image_size.x + tile_size - 1u) / tile_size;
    let tiles = tiles_across * ((dispatch.band_rows + tile_size - 1u) / tile_size);
    let tile = ((place / TILE_BLOCKS) * dispatch.tile_stride) % tiles;
    let in_tile = place % TILE_BLOCKS;
    let corner = vec2<u32>(tile % tiles_across, tile / tiles_across) * TILE_EDGE;
    return corner + vec2<u32>(in_tile % TILE_EDGE, in_tile / TILE_EDGE);
}

// Pixel in its block: eight neighbouring lanes share a patch of 4 x 2 pixels, so that they walk the same nodes.
fn pixel_in_block(lane: u32) -> vec2<u32> {
    return vec2<u32>((lane & 3u) | ((lane >> 1u) & 4u), ((lane >> 2u) & 1u) | ((lane >> 3u) & 6u));
}
