// Normals turned by a height field (Blinn 1978).
