#!/usr/bin/env python3
"""Makes the pictures of the waterfall scene: rock, the forest's floor, pebbles, bark and a late afternoon's sky.

    python3 assets/make_landscape_textures.py              # all of them, about a minute
    python3 assets/make_landscape_textures.py rock pebbles # some

Values are linear: the scene is written with the sRGB curve, so seen by themselves the pictures look dark. Nothing but
Python's standard library is used, and the files come out the same each time. All tile in both directions but the sky,
which is equirectangular and tiles around the vertical axis.
"""

import math
import sys

from make_textures import (FOLDER, Cells, Fractal, Noise, fractal3, mix, ramp, render, scaled, step, write_png)


def rock():
    """Weathered stone: faint uneven beds, stains that run down, a few cracks and pale lichen."""
    warp, beds, grain = Fractal(31, 3, 3, 5), Fractal(32, 2, 7, 4), Fractal(33, 22, 26, 4)
    stain, lichen, cracks = Fractal(34, 9, 2, 4), Fractal(35, 7, 7, 5), Fractal(36, 3, 4, 5)

    def shade(x, y):
        bent, g = warp.at(x, y), grain.at(x, y)
        tone = 0.5 + 0.36 * beds.at(x + 0.06 * bent, y + 0.08 * bent) + 0.26 * g + 0.15 * bent
        colour = ramp([(0.0, (0.050, 0.050, 0.050)), (0.4, (0.105, 0.103, 0.098)), (0.7, (0.165, 0.158, 0.143)),
                       (1.0, (0.25, 0.235, 0.20))], tone)
        crack = abs(cracks.at(x + 0.05 * bent, y + 0.02 * g))
        colour = scaled(colour, 0.42 + 0.58 * step(0.0, 0.045, crack))
        colour = mix(colour, (0.042, 0.041, 0.036), 0.75 * step(0.10, 0.75, stain.at(x + 0.02 * bent, y)))
        spots = step(0.40, 0.66, lichen.at(x, y) + 0.1 * g)
        return mix(colour, (0.20, 0.21, 0.13), 0.5 * spots)
    return render(512, 512, shade, 127), 3


def forest_floor():
    """Moss, short grass and litter, in patches."""
    patch, moss, grain = Fractal(41, 3, 3, 4), Fractal(42, 20, 20, 3), Fractal(43, 60, 60, 2)
    litter = Cells(44, 26, 26, 1.0)

    def shade(x, y):
        p, m, g = patch.at(x, y), moss.at(x, y), grain.at(x, y)
        green = ramp([(-0.9, (0.022, 0.040, 0.010)), (0.0, (0.060, 0.098, 0.020)), (0.9, (0.125, 0.150, 0.034))],
                     m + 0.5 * g)
        first, _, own = litter.at(x + 0.01 * m, y + 0.01 * g)
        brown = ramp([(0.0, (0.060, 0.040, 0.022)), (0.6, (0.115, 0.075, 0.038)), (1.0, (0.19, 0.125, 0.060))], own)
        brown = scaled(brown, 1.1 - 0.7 * first + 0.25 * g)
        return mix(green, brown, step(-0.05, 0.55, p + 0.35 * m))
    return render(512, 512, shade, 127), 3


def pebbles():
    """River stones of many greys and browns, wet, in a darker gap."""
    stones, small, grain = Cells(51, 9, 9, 0.9), Cells(52, 30, 30, 0.9), Fractal(53, 30, 30, 3)
    tints = [(0.20, 0.17, 0.13), (0.26, 0.25, 0.23), (0.13, 0.13, 0.125), (0.27, 0.20, 0.13), (0.17, 0.19, 0.16),
             (0.33, 0.30, 0.25)]

    def shade(x, y):
        g = grain.at(x, y)
        first, second, own = stones.at(x, y)
        edge = second - first
        if edge < 0.10 + 0.05 * g:
            a, b, number = small.at(x, y)
            colour = scaled(tints[int(number * 6)], 0.30 + 0.5 * step(0, 0.3, b - a))
        else:
            colour = scaled(tints[int(own * 97) % 6], (0.72 + 0.55 * own) * (0.55 + 0.5 * step(0.08, 0.5, edge)))
        return scaled(colour, 1 + 0.22 * g)
    return render(384, 384, shade, 127), 3


def trunk():
    """Furrowed bark with moss on one side."""
    plates, warp, grain = Cells(61, 9, 3, 0.9), Fractal(62, 5, 3, 4), Fractal(63, 36, 10, 3)
    moss = Fractal(64, 4, 4, 4)

    def shade(x, y):
        bent, g = warp.at(x, y), grain.at(x, y)
        first, second, own = plates.at(x + 0.05 * bent, y + 0.10 * bent)
        height = step(-0.02, 0.35, second - first + 0.08 * g) * (0.75 + 0.25 * own)
        colour = ramp([(0.0, (0.018, 0.013, 0.010)), (0.5, (0.085, 0.062, 0.045)), (1.0, (0.19, 0.15, 0.115))],
                      height + 0.2 * g)
        green = 0.6 * step(0.0, 0.8, moss.at(x, y) + 0.35 * math.cos(2 * math.pi * x))
        return mix(colour, scaled((0.085, 0.11, 0.03), 0.4 + 0.8 * height), green)
    return render(256, 384, shade, 127), 3


def afternoon():
    """A late afternoon: deep blue above, warm haze at the horizon, warmest towards the sun, and soft torn clouds."""
    cloud, wisp = Noise(71, 1, 1, 1), Noise(72, 1, 1, 1)
    sun = (-0.70, 0.42, 0.57)
    size = math.sqrt(sum(c * c for c in sun))

    def shade(x, y):
        # The middle of the picture is towards -z, its right half towards +x.
        azimuth, height = (x - 0.5) * 2 * math.pi, (0.5 - y) * math.pi
        d = (math.cos(height) * math.sin(azimuth), math.sin(height), -math.cos(height) * math.cos(azimuth))
        up = max(0.0, d[1])
        near = max(0.0, sum(a * b for a, b in zip(d, sun)) / size)
        low = mix((0.72, 0.60, 0.48), (0.98, 0.74, 0.44), near ** 2)
        colour = ramp([(0.0, low), (0.14, mix(low, (0.56, 0.60, 0.66), 0.55)), (0.40, (0.25, 0.40, 0.66)),
                       (1.0, (0.08, 0.19, 0.46))], up ** 0.85)
        spread = 1 / (0.25 + up)
        n = fractal3(cloud, 2.1 * d[0] * spread + 7, 2.0, 2.1 * d[2] * spread, 5, 0.52)
        torn = fractal3(wisp, 1.1 * d[0] * spread, 5.0, 2.6 * d[2] * spread + 3, 4, 0.5)
        cover = step(0.02, 0.62, n + 0.35 * torn) * step(0.01, 0.14, up)
        bright = mix((0.66, 0.62, 0.62), (1.0, 0.90, 0.76), step(-0.2, 0.6, near + 0.5 * torn))
        colour = mix(colour, bright, 0.85 * cover)
        colour = mix(colour, (1.0, 0.93, 0.74), 0.85 * near ** 60)
        if d[1] < 0:
            colour = mix(colour, (0.10, 0.11, 0.08), step(0.0, 0.12, -d[1]))
        return colour
    return render(1024, 512, shade, 127), 3


def main(names):
    makers = {"rock": rock, "forest-floor": forest_floor, "pebbles": pebbles, "trunk": trunk, "afternoon": afternoon}
    for name in names or makers:
        rows, channels = makers[name]()
        write_png(FOLDER / f"{name}.png", rows, channels)


if __name__ == "__main__":
    main(sys.argv[1:])
