/// An image in memory, rows from the top. 8-bit values are used as they stand in the file, over 255 and without decoding;
/// float values are linear radiance.
#[derive(Clone, Debug, PartialEq)]
pub struct Image {
    /// For messages: the file it came from.
    pub name: String,
    /// Pixels; both at least 1.
    pub width: u32,
    pub height: u32,
    pub texels: Texels,
}

/// The pixels of an [`Image`], `width * height` of them, row by row.
#[derive(Clone, Debug, PartialEq)]
pub enum Texels {
    Rgba8(Vec<[u8; 4]>),
    Rgb32F(Vec<[f32; 3]>),
}

impl Texels {
    /// Memory that they take.
    pub fn bytes(&self) -> usize {
        match self {
            Texels::Rgba8(texels) => size_of_val(texels.as_slice()),
            Texels::Rgb32F(texels) => size_of_val(texels.as_slice()),
        }
    }
}
