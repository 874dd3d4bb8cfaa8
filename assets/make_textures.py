#!/usr/bin/env python3
"""Makes the pictures in assets/: surfaces, a height map, an earth-like map and a sky.

    python3 assets/make_textures.py            # all of them, about a minute
    python3 assets/make_textures.py bark sky   # some

Nothing but Python's standard library is used, and every texture has its own fixed seed, so the files come out the same
each time. All tile: bark to leaves and dimples to stripes in both directions, earth and sky, which are
equirectangular, around the vertical axis.
"""

import math
import pathlib
import random
import struct
import sys
import zlib

FOLDER = pathlib.Path(__file__).resolve().parent


# ---------------------------------------------------------------- writing

def write_png(path, rows, channels):
    """Writes 8-bit rows of `channels` values a pixel (1: grey, 3: RGB); PNG specification 1.2, sections 4 and 6."""
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    packed, above = bytearray(), bytes(len(rows[0]))
    for row in rows:
        left = bytes(channels) + row[:-channels]
        above_left = bytes(channels) + above[:-channels]
        best = None
        for kind, predicted in enumerate((bytes(len(row)), left, above, None, map(paeth, left, above, above_left))):
            if predicted is not None:
                line = bytes((a - b) & 255 for a, b in zip(row, predicted))
                cost = sum(value if value < 128 else 256 - value for value in line)
                if best is None or cost < best[0]:
                    best = cost, kind, line
        packed.append(best[1])
        packed += best[2]
        above = row
    header = struct.pack(">IIBBBBB", len(rows[0]) // channels, len(rows), 8, 0 if channels == 1 else 2, 0, 0, 0)
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header)
                     + chunk(b"IDAT", zlib.compress(bytes(packed), 9)) + chunk(b"IEND", b""))


def paeth(a, b, c):
    p = a + b - c
    pa, pb, pc = abs(p - a), abs(p - b), abs(p - c)
    return a if pa <= pb and pa <= pc else b if pb <= pc else c


def render(width, height, shade, steps=255):
    """Rows of bytes from `shade(x, y)`, x and y in [0,1) at the pixel's middle, which returns a colour in [0,1].

    Fewer steps from black to white make a smaller file.
    """
    def level(value):
        return min(255, max(0, int(value * steps + 0.5) * 255 // steps))
    return [bytes(level(value) for x in range(width) for value in shade((x + 0.5) / width, (y + 0.5) / height))
            for y in range(height)]


# ---------------------------------------------------------------- noise and colour

class Noise:
    """Gradient noise (Perlin 2002) on a lattice that repeats after `periods` cells; about [-1,1]."""

    def __init__(self, seed, *periods):
        rng = random.Random(seed)
        self.periods = periods
        self.table = list(range(256))
        rng.shuffle(self.table)
        self.table += self.table
        self.gradients = []
        for _ in range(256):
            g = [rng.gauss(0, 1) for _ in range(3)]
            size = math.sqrt(sum(c * c for c in g[:len(periods)]))
            self.gradients.append([c / size for c in g])

    def at(self, x, y):
        px, py = self.periods
        t, gradients = self.table, self.gradients
        ix, iy = math.floor(x), math.floor(y)
        fx, fy = x - ix, y - iy
        a, b = t[ix % px], t[(ix + 1) % px]
        y0, y1 = iy % py, (iy + 1) % py
        g = gradients[t[a + y0]]
        n00 = g[0] * fx + g[1] * fy
        g = gradients[t[b + y0]]
        n10 = g[0] * (fx - 1) + g[1] * fy
        g = gradients[t[a + y1]]
        n01 = g[0] * fx + g[1] * (fy - 1)
        g = gradients[t[b + y1]]
        n11 = g[0] * (fx - 1) + g[1] * (fy - 1)
        sx = fx * fx * fx * (fx * (fx * 6 - 15) + 10)
        sy = fy * fy * fy * (fy * (fy * 6 - 15) + 10)
        low = n00 + sx * (n10 - n00)
        return 1.5 * (low + sy * (n01 + sx * (n11 - n01) - low))

    def at3(self, x, y, z):
        t, gradients = self.table, self.gradients
        ix, iy, iz = math.floor(x), math.floor(y), math.floor(z)
        fx, fy, fz = x - ix, y - iy, z - iz
        sx = fx * fx * fx * (fx * (fx * 6 - 15) + 10)
        sy = fy * fy * fy * (fy * (fy * 6 - 15) + 10)
        sz = fz * fz * fz * (fz * (fz * 6 - 15) + 10)
        total = 0.0
        for cx, wx in ((0, 1 - sx), (1, sx)):
            a = t[(ix + cx) & 255]
            for cy, wy in ((0, 1 - sy), (1, sy)):
                b = t[a + ((iy + cy) & 255)]
                for cz, wz in ((0, 1 - sz), (1, sz)):
                    g = gradients[t[b + ((iz + cz) & 255)]]
                    total += wx * wy * wz * (g[0] * (fx - cx) + g[1] * (fy - cy) + g[2] * (fz - cz))
        return 1.5 * total


class Fractal:
    """Octaves of noise over the unit square, each twice as fine and half as strong."""

    def __init__(self, seed, px, py, octaves):
        self.layers = [(0.5 ** i, px << i, py << i, Noise(seed * 100 + i, px << i, py << i)) for i in range(octaves)]

    def at(self, x, y):
        return sum(a * noise.at(x * px, y * py) for a, px, py, noise in self.layers)


def fractal3(noise, x, y, z, octaves, gain=0.5):
    total, a = 0.0, 1.0
    for i in range(octaves):
        total += a * noise.at3(x + 17 * i, y, z)
        x, y, z, a = 2 * x, 2 * y, 2 * z, gain * a
    return total


class Cells:
    """Voronoi cells around jittered points of a repeating grid (Worley 1996)."""

    def __init__(self, seed, px, py, jitter):
        rng = random.Random(seed)
        self.px, self.py = px, py
        self.points = [[(0.5 + jitter * (rng.random() - 0.5), 0.5 + jitter * (rng.random() - 0.5), rng.random())
                        for _ in range(px)] for _ in range(py)]

    def at(self, x, y):
        """Distances to the nearest and the second nearest point, in grid cells, and the nearest one's own number."""
        x, y = x * self.px, y * self.py
        ix, iy = math.floor(x), math.floor(y)
        first = second = 9.0
        own = 0.0
        for cy in range(iy - 1, iy + 2):
            for cx in range(ix - 1, ix + 2):
                qx, qy, number = self.points[cy % self.py][cx % self.px]
                d = (cx + qx - x) ** 2 + (cy + qy - y) ** 2
                if d < first:
                    first, second, own = d, first, number
                elif d < second:
                    second = d
        return math.sqrt(first), math.sqrt(second), own


def step(low, high, value):
    t = min(1.0, max(0.0, (value - low) / (high - low)))
    return t * t * (3 - 2 * t)


def mix(a, b, t):
    return tuple(p + (q - p) * t for p, q in zip(a, b))


def ramp(stops, t):
    """Colour at `t` between stops of (position, colour)."""
    for (p, a), (q, b) in zip(stops, stops[1:]):
        if t < q:
            return mix(a, b, max(0.0, (t - p) / (q - p)))
    return stops[-1][1]


def scaled(colour, k):
    return tuple(c * k for c in colour)


# ---------------------------------------------------------------- painting

class Canvas:
    """A square that wraps around, painted at twice the final size."""

    def __init__(self, size, colour):
        self.size, self.n = size, 2 * size
        self.pixels = [[colour] * self.n for _ in range(self.n)]

    def rows(self):
        rows = []
        for y in range(0, self.n, 2):
            upper, lower, row = self.pixels[y], self.pixels[y + 1], bytearray()
            for x in range(0, self.n, 2):
                for a, b, c, d in zip(upper[x], upper[x + 1], lower[x], lower[x + 1]):
                    row.append(min(255, max(0, int((a + b + c + d) * 63.75 + 0.5))))
            rows.append(bytes(row))
        return rows

    def paint(self, x, y, radius, shade):
        """Calls `shade(dx, dy, old)` for the pixels within `radius` of (x, y); None leaves the old colour."""
        for j in range(math.floor(y - radius), math.ceil(y + radius) + 1):
            row = self.pixels[j % self.n]
            for i in range(math.floor(x - radius), math.ceil(x + radius) + 1):
                new = shade(i - x, j - y, row[i % self.n])
                if new is not None:
                    row[i % self.n] = new


# ---------------------------------------------------------------- the textures

def bark():
    """Long rough plates between upright furrows, as on an oak."""
    plates, warp, lean = Cells(1, 8, 2, 0.85), Fractal(2, 6, 3, 4), Fractal(4, 4, 4, 3)
    grain, streaks = Fractal(3, 32, 10, 3), Fractal(17, 20, 4, 4)

    def shade(x, y):
        bent = warp.at(x, y)
        first, second, own = plates.at(x + 0.05 * bent, y + 0.13 * lean.at(x, y))
        fine = grain.at(x + 0.02 * bent, y)
        streak = 1 - abs(streaks.at(x + 0.03 * bent, y)) * 2.2
        height = step(-0.10, 0.28, second - first + 0.07 * fine) * (0.82 + 0.18 * own)
        height -= 0.22 * step(0.86, 1.0, streak)
        colour = ramp([(0.0, (0.13, 0.09, 0.065)), (0.4, (0.33, 0.24, 0.17)), (0.75, (0.50, 0.40, 0.31)),
                       (1.0, (0.64, 0.55, 0.45))], height * 0.92 + 0.16 * fine)
        return scaled(colour, 0.90 + 0.2 * own)
    return render(256, 256, shade), 3


def grass():
    """A lawn from above: blades over blades, the lower ones in the shade of the upper ones."""
    rng, canvas = random.Random(5), Canvas(256, (0.05, 0.10, 0.03))
    count = 2800
    for i in range(count):
        depth = i / count
        x, y = rng.random() * canvas.n, rng.random() * canvas.n
        angle, bend = rng.random() * 2 * math.pi, rng.gauss(0, 0.9)
        length, width = rng.uniform(36, 78), rng.uniform(2.8, 4.4)
        tint = mix((0.20, 0.40, 0.10), (0.50, 0.60, 0.20), rng.random() ** 2)
        if rng.random() < 0.05:
            tint = (0.66, 0.60, 0.34)  # a dry one
        steps = int(length / 1.5)
        for k in range(steps + 1):
            s = k / steps
            radius = width * (1 - s) ** 0.6 * 0.5 + 0.5
            lit = (0.35 + 0.75 * depth) * (0.6 + 0.65 * s)

            def blade(dx, dy, old):
                d = math.hypot(dx, dy)
                if d > radius:
                    return None
                side = (dx * math.sin(angle) - dy * math.cos(angle)) / radius
                return scaled(tint, lit * (1 + 0.18 * side))
            canvas.paint(x, y, radius, blade)
            x += 1.5 * math.cos(angle)
            y += 1.5 * math.sin(angle)
            angle += bend / steps
    return canvas.rows(), 3


def leaves():
    """Fallen leaves, each with its midrib and side veins, and the shadow it throws on those below."""
    rng, canvas = random.Random(6), Canvas(320, (0.10, 0.07, 0.04))
    tints = [(0.72, 0.30, 0.08), (0.80, 0.50, 0.12), (0.62, 0.18, 0.08), (0.78, 0.64, 0.20), (0.46, 0.48, 0.14),
             (0.50, 0.28, 0.12), (0.34, 0.44, 0.14)]
    for _ in range(300):
        cx, cy = rng.random() * canvas.n, rng.random() * canvas.n
        angle, length = rng.random() * 2 * math.pi, rng.uniform(95, 150)
        breadth, curve = rng.uniform(0.24, 0.32), rng.uniform(-0.12, 0.12)
        tint = scaled(rng.choice(tints), rng.uniform(0.8, 1.12))
        edge = mix(tint, (0.35, 0.18, 0.06), 0.55)
        vein = mix(tint, (0.95, 0.85, 0.55), 0.45)
        co, si = math.cos(angle), math.sin(angle)

        def inside(dx, dy):
            """Place along the leaf in [0,1] and across it in half widths, which is beyond 1 outside."""
            s = (dx * co + dy * si) / length + 0.5
            t = (dy * co - dx * si) / length - curve * 4 * s * (1 - s)
            if not 0.0 < s < 1.0:
                return s, 9.0
            blade = (s - 0.12) / 0.88
            half = 0.008 if blade <= 0 else max(0.008, breadth * 2.0 * blade ** 0.62 * (1 - blade) ** 0.85)
            half *= 1 + (0.05 * math.sin(s * 75) if blade > 0.03 else 0)
            return s, t / half

        def shadow(dx, dy, old):
            s, t = inside(dx / 1.07 - 4, dy / 1.07 - 6)
            return scaled(old, 0.52 + 0.48 * step(0.75, 1.25, abs(t))) if abs(t) < 1.25 else None

        def blade(dx, dy, old):
            s, t = inside(dx, dy)
            if abs(t) > 1:
                return None
            across = abs(t)
            ribs = (s * 9 - across * 1.1) % 1.0
            colour = mix(tint, edge, step(0.55, 1.0, across) * 0.8)
            colour = scaled(colour, (1.08 if t > 0 else 0.88) * (0.93 + 0.2 * ribs))
            if ribs < 0.10 and s > 0.12:
                colour = mix(colour, vein, 0.5)
            if across < 0.075 + 0.05 * (1 - s) or s < 0.12:
                colour = vein
            return colour
        canvas.paint(cx, cy, length * 0.56, shadow)
        canvas.paint(cx, cy, length * 0.52, blade)
    return canvas.rows(), 3


def stripes():
    """Awning cloth: red and cream with a thin gold line between."""
    def shade(x, y):
        t = (x * 8) % 1.0
        if t < 0.45:
            return 0.72, 0.13, 0.12
        return (0.95, 0.91, 0.80) if 0.5 < t < 0.95 else (0.80, 0.60, 0.20)
    return render(256, 256, shade), 3


def brick():
    """Running bond, four bricks wide and eight high; the mortar is darker, so the picture serves as height too."""
    rough, stain, mortar = Fractal(7, 24, 24, 3), Fractal(8, 6, 6, 3), Fractal(9, 48, 48, 2)
    rng = random.Random(10)
    tints = [[rng.random() for _ in range(4)] for _ in range(8)]

    def shade(x, y):
        row = int(y * 8)
        along = x * 4 + 0.5 * (row % 2) + 0.004 * rough.at(x, y)
        column = int(along) % 4
        u, v = along % 1.0, y * 8 - row
        # Distance to the brick's edge, in brick heights: a brick is twice as wide as high.
        gap = min(min(u, 1 - u) * 2, min(v, 1 - v)) + 0.012 * rough.at(x, y)
        t = tints[row][column]
        colour = ramp([(0.0, (0.52, 0.20, 0.14)), (0.5, (0.67, 0.30, 0.20)), (0.85, (0.74, 0.40, 0.27)),
                       (1.0, (0.60, 0.33, 0.28))], t)
        colour = scaled(colour, 1 + 0.13 * rough.at(x, y) + 0.10 * stain.at(x, y))
        joint = scaled((0.19, 0.18, 0.17), 1 + 0.12 * mortar.at(x, y))
        return mix(joint, colour, step(0.06, 0.115, gap))
    return render(384, 384, shade), 3


def dimples():
    """Round hollows in staggered rows, twenty around and twelve from top to bottom; a height map, white is high."""
    columns, rows = 20, 12

    def shade(x, y):
        row = int(y * rows)
        u = (x * columns + 0.5 * (row % 2)) % 1.0 - 0.5
        v = (y * rows - row - 0.5) * columns / (2 * rows)  # in columns too: the map is twice as wide as high
        d = math.hypot(u, v)
        return (0.9 - 0.75 * max(0.0, 1 - (d / 0.45) ** 2) + 0.05 * step(0.45, 0.5, d),)
    return render(640, 320, shade), 1


def floor():
    """Oak boards, laid in staggered courses along x."""
    grain, fibre, wave = Fractal(11, 2, 16, 4), Fractal(12, 6, 128, 2), Fractal(13, 2, 6, 3)
    rng = random.Random(14)
    courses = 6
    boards = [[(rng.random(), rng.random(), rng.random()) for _ in range(2)] for _ in range(courses)]
    starts = [rng.random() for _ in range(courses)]

    def shade(x, y):
        course = int(y * courses)
        along = (x + starts[course]) * 2
        tone, ox, oy = boards[course][int(along) % 2]
        u, v = along % 1.0, y * courses - course
        gx, gy = x + ox, y + oy
        rings = math.sin(2 * math.pi * (5 * v * (0.6 + tone) + 2.2 * wave.at(gx, gy) + 3 * oy))
        value = 0.5 + 0.17 * rings + 0.20 * grain.at(gx, gy) + 0.13 * fibre.at(gx, gy) + 0.42 * (tone - 0.5)
        colour = ramp([(0.0, (0.34, 0.20, 0.10)), (0.5, (0.58, 0.38, 0.21)), (1.0, (0.74, 0.54, 0.33))], value)
        gap = min(min(v, 1 - v) / courses, min(u, 1 - u) / 2)
        return scaled(colour, 0.25 + 0.75 * step(0.0008, 0.0042, gap))
    return render(384, 384, shade), 3


def sphere_direction(x, y):
    """The direction that an equirectangular picture shows at (x, y): u = 1/2 - phi / 2 pi, the top is +y."""
    phi, theta = (0.5 - x) * 2 * math.pi, (0.5 - y) * math.pi
    return math.cos(theta) * math.cos(phi), math.sin(theta), math.cos(theta) * math.sin(phi)


def earth():
    """Not our earth but one like it: continents, deserts about the tropics, ice at the poles."""
    ground, wet, cloud = Noise(21, 1, 1, 1), Noise(22, 1, 1, 1), Noise(23, 1, 1, 1)
    lush, dry, cold = (0.13, 0.31, 0.10), (0.76, 0.64, 0.40), (0.40, 0.40, 0.29)

    def shade(x, y):
        px, py, pz = sphere_direction(x, y)
        height = fractal3(ground, 1.35 * px + 5, 1.35 * py, 1.35 * pz, 7, 0.55) - 0.08
        latitude = abs(py) + 0.10 * fractal3(wet, 3 * px + 9, 3 * py, 3 * pz, 3)
        ice = step(0.93, 0.99, latitude + (0.03 if height > 0 else 0))
        if height < 0:
            colour = ramp([(-0.9, (0.02, 0.07, 0.22)), (-0.18, (0.04, 0.16, 0.38)), (-0.03, (0.10, 0.34, 0.52)),
                           (0.0, (0.26, 0.54, 0.62))], height)
            return mix(colour, (0.90, 0.94, 0.97), ice)
        moisture = 1.1 * fractal3(wet, 2.2 * px, 2.2 * py + 4, 2.2 * pz, 4) - 1.0 * math.exp(
            -((latitude - 0.42) / 0.16) ** 2) + 0.45
        colour = mix(dry, lush, step(-0.25, 0.35, moisture))
        colour = mix(colour, cold, step(0.70, 0.92, latitude))
        colour = mix(colour, (0.46, 0.37, 0.29), step(0.42, 0.75, height) * 0.85)
        colour = mix(colour, (0.97, 0.97, 0.98), step(0.80, 0.98, height))
        # Light from the north-west, as maps have it.
        lower = fractal3(ground, 1.35 * (px + 0.012) + 5, 1.35 * (py + 0.012), 1.35 * pz, 6, 0.55) - 0.08
        colour = scaled(colour, min(1.25, max(0.7, 1 + 1.6 * (height - lower))))
        return mix(colour, (0.95, 0.96, 0.98), ice)

    return render(1024, 512, shade, 51), 3


def sky():
    """A summer sky with fair-weather clouds; the sun stands at (-5, 6, 6), behind and left of a camera facing -z."""
    puffs, wisps = Fractal(31, 8, 8, 6), Fractal(32, 3, 3, 5)
    sun = scaled((-5, 6, 6), 1 / math.sqrt(97))

    def shade(x, y):
        dx, dy, dz = sphere_direction(x, y)
        if dy < 0:  # hazy land below the horizon
            return ramp([(0.0, (0.66, 0.70, 0.70)), (0.10, (0.42, 0.44, 0.38)), (1.0, (0.24, 0.26, 0.20))], -dy)
        colour = ramp([(0.0, (0.80, 0.87, 0.92)), (0.12, (0.62, 0.77, 0.91)), (0.5, (0.32, 0.55, 0.84)),
                       (1.0, (0.16, 0.36, 0.70))], dy)
        toward = dx * sun[0] + dy * sun[1] + dz * sun[2]
        colour = mix(colour, (1.0, 0.96, 0.86), 0.55 * max(0.0, toward) ** 24)
        # Clouds lie on a plane overhead and draw together towards the horizon.
        k = 0.11 / (dy + 0.11)
        cx, cy = 0.9 * dx * k + 0.5, 0.9 * dz * k + 0.5
        density = puffs.at(cx, cy) + 0.5 * wisps.at(cx, cy)
        cover = step(0.02, 0.62, density) * step(0.02, 0.16, dy)
        shaded = puffs.at(cx - 0.010 * sun[0], cy - 0.010 * sun[2]) + 0.5 * wisps.at(cx, cy)
        white = mix((1.0, 0.99, 0.97), (0.76, 0.80, 0.86), step(0.05, 0.9, 0.55 * density + 1.0 * (shaded - density)))
        colour = mix(colour, white, 0.94 * cover)
        return mix(colour, (1.0, 1.0, 0.97), step(math.cos(0.075), math.cos(0.055), toward))
    return render(1024, 512, shade), 3


TEXTURES = (bark, grass, leaves, stripes, brick, dimples, floor, earth, sky)

if __name__ == "__main__":
    names = {texture.__name__: texture for texture in TEXTURES}
    for name in sys.argv[1:] or names:
        if name not in names:
            raise SystemExit(f"no texture {name!r}; there are: {', '.join(names)}")
        rows, channels = names[name]()
        target = FOLDER / f"{name}.png"
        write_png(target, rows, channels)
        print(f"{target.name}: {len(rows[0]) // channels}x{len(rows)}, {target.stat().st_size // 1024} KiB")
