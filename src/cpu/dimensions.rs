//! Keys of the random decisions of a ray, and of the rays it spawns; see `hash_combine`. Twin of
//! `shaders/dimensions.wgsl`.

pub const DIMENSION_PIXEL: u32 = 1;
pub const DIMENSION_LENS: u32 = 2;
pub const DIMENSION_GLOSSY: u32 = 3;
pub const DIMENSION_CHOICE: u32 = 4;
pub const DIMENSION_LIGHT_CHOICE: u32 = 5;
pub const BRANCH_REFLECTED: u32 = 6;
pub const BRANCH_REFRACTED: u32 = 7;
pub const DIMENSION_MIST: u32 = 8;
/// Light i has the dimension `DIMENSION_LIGHT + i`.
pub const DIMENSION_LIGHT: u32 = 16;
