// What maps do to a surface: its colour from a texture, its normal from a bump map.
