// Perlin's improved gradient noise (Perlin 2002).
