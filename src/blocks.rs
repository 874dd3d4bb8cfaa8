//! The 8 × 8 pixel blocks of a band of rows, and the order in which they are rendered; twin of `shaders/blocks.wgsl`.
//!
//! Blocks are taken tile by tile, so that neighbours in time are neighbours in the picture and read the same parts of
//! the scene; the tiles are taken by strides over the whole band, so that any run of blocks sees a share of every part
//! of the picture: its time is foreseen from the run before, and processors that take contiguous halves of a run have
//! the same to do.

use glam::UVec2;

/// Edge of a block, pixels. A workgroup has one invocation for each pixel of its block.
pub const BLOCK_EDGE: u32 = 8;
/// Edge of a tile, blocks.
pub const TILE_EDGE: u32 = 4;
/// Blocks in a tile. Those of the last tiles may lie outside the picture.
pub const TILE_BLOCKS: u32 = TILE_EDGE * TILE_EDGE;

/// The places of a band's blocks in the order of rendering.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BlockOrder {
    tiles_across: u32,
    tiles: u32,
}

impl BlockOrder {
    /// For a picture `width` pixels wide and a band of `rows` rows of pixels.
    pub fn new(width: u32, rows: u32) -> Self {
        let tile = BLOCK_EDGE * TILE_EDGE;
        let tiles_across = width.div_ceil(tile);
        BlockOrder { tiles_across, tiles: tiles_across * rows.div_ceil(tile) }
    }

    /// The number of places, some of which may be of blocks outside the band.
    pub fn places(self) -> u32 {
        self.tiles * TILE_BLOCKS
    }

    /// A stride for [`block_at`](Self::block_at): near the golden section of the number of tiles where 32 bits hold its
    /// steps, and coprime to it. Multiples modulo that number visit every tile once, and any few in a row are spread
    /// over the band.
    pub fn stride(self) -> u32 {
        let golden = (f64::from(self.tiles) * 0.618_034) as u32;
        let most = golden.min(u32::MAX / self.tiles.max(1)).max(1);
        (1..=most).rev().find(|&stride| self.visits_all(stride)).unwrap_or(1)
    }

    /// Whether a stride leads to every tile, by steps that 32 bits hold.
    pub fn visits_all(self, stride: u32) -> bool {
        let fits = u64::from(self.tiles) * u64::from(stride) <= u64::from(u32::MAX);
        self.tiles <= 1 || fits && greatest_common_divisor(stride, self.tiles) == 1
    }

    /// Column and row of the block at a place, counted in blocks from the band's upper left corner.
    pub fn block_at(self, place: u32, stride: u32) -> UVec2 {
        let tile = (place / TILE_BLOCKS).wrapping_mul(stride) % self.tiles;
        let in_tile = place % TILE_BLOCKS;
        let corner = UVec2::new(tile % self.tiles_across, tile / self.tiles_across) * TILE_EDGE;
        corner + UVec2::new(in_tile % TILE_EDGE, in_tile / TILE_EDGE)
    }
}

fn greatest_common_divisor(a: u32, b: u32) -> u32 {
    if b == 0 { a } else { greatest_common_divisor(b, a % b) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashSet;

    #[test]
    fn every_block_has_one_place() {
        for (width, rows) in [(1, 1), (37, 29), (320, 240), (641, 8), (33, 700), (1920, 1080), (8000, 9000)] {
            let order = BlockOrder::new(width, rows);
            let stride = order.stride();
            assert!(order.visits_all(stride));
            let blocks: HashSet<UVec2> = (0..order.places()).map(|place| order.block_at(place, stride)).collect();
            assert_eq!(blocks.len(), order.places() as usize, "{width} x {rows}");
            let across = UVec2::new(width, rows).map(|pixels| pixels.div_ceil(BLOCK_EDGE));
            let inside = blocks.iter().filter(|block| block.cmplt(across).all()).count();
            assert_eq!(inside as u32, across.x * across.y, "{width} x {rows}");
        }
    }

    #[test]
    fn huge_bands_have_strides_too() {
        for edge in [1 << 14, 1 << 16, 1 << 19] {
            let order = BlockOrder::new(edge, edge);
            let stride = order.stride();
            assert!(order.visits_all(stride) && stride > 1, "{edge}: {stride}");
        }
    }

    #[test]
    fn strides_that_skip_tiles_or_overflow_are_known() {
        let order = BlockOrder::new(5 * 32, 4 * 32);
        assert!(order.visits_all(3) && order.visits_all(21));
        assert!(!order.visits_all(5) && !order.visits_all(0) && !order.visits_all(858_993_461));
    }
}
