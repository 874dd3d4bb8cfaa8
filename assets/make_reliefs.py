#!/usr/bin/env python3
"""Makes height maps from textures of make_textures.py: small grey pictures of their brightness, black to white.

    python3 assets/make_reliefs.py

A bump map tilts the normal by the change of height from texel to texel, so that a small picture with its full range of
greys has steeper slopes than a large and fine one: that is what makes a relief of a picture. They tile as their
textures do.
"""

import make_textures

# Texture, and how many of its pixels along an edge make one of the relief.
RELIEFS = ((make_textures.brick, 3), (make_textures.bark, 2))


def relief(rows, channels, factor):
    """The mean of red, green and blue over squares of `factor` pixels, from the darkest at 0 to the lightest at 255;
    the darkest and lightest 2 % are clipped, so that a single pixel doesn't set the range."""
    heights = []
    for y in range(0, len(rows), factor):
        lines = rows[y:y + factor]
        edge = factor * channels
        heights.append([sum(sum(line[x:x + edge]) for line in lines) for x in range(0, len(rows[0]), edge)])
    ordered = sorted(height for row in heights for height in row)
    low, high = ordered[len(ordered) // 50], ordered[-len(ordered) // 50]
    return [bytes(min(255, max(0, (height - low) * 255 // (high - low))) for height in row) for row in heights]


if __name__ == "__main__":
    for texture, factor in RELIEFS:
        target = make_textures.FOLDER / f"{texture.__name__}-relief.png"
        make_textures.write_png(target, relief(*texture(), factor), 1)
        print(f"{target.name}: {target.stat().st_size // 1024} KiB")
