// Images in the texel buffer: bilinear, repeated, filtered by the width of the ray.
