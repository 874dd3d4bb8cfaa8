// Texture coordinates and tangents of the surface at a hit.
