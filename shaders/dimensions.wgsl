// Keys of the random decisions of a ray, and of the rays it spawns; see hash_combine.
const DIMENSION_PIXEL: u32 = 1u;
const DIMENSION_LENS: u32 = 2u;
const DIMENSION_GLOSSY: u32 = 3u;
const DIMENSION_CHOICE: u32 = 4u;
const DIMENSION_LIGHT_CHOICE: u32 = 5u;
const BRANCH_REFLECTED: u32 = 6u;
const BRANCH_REFRACTED: u32 = 7u;
const DIMENSION_MIST: u32 = 8u;
// Light i has the dimension DIMENSION_LIGHT + i.
const DIMENSION_LIGHT: u32 = 16u;
