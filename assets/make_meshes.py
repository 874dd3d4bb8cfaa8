#!/usr/bin/env python3
"""Makes bunny.obj and suzanne.obj from the models of the npm package @pmndrs/assets.

    npm pack @pmndrs/assets@1.7.0 && tar xzf pmndrs-assets-1.7.0.tgz
    python3 assets/make_meshes.py package

The package holds each model as a JavaScript module around a base64 string of a .glb file, whose geometry is Draco
compressed. Draco is undone by glTF-Transform (`npx @gltf-transform/cli copy`), so Node.js must be installed; the
rest needs Python's standard library alone.

Both meshes are written with y up, the middle of their bounding box on the y axis, the lowest point at y = 0, and a
height of 1. The bunny, a closed mesh of 5,648 triangles, is refined by one step of Loop subdivision (Loop 1987,
"Smooth Subdivision Surfaces Based on Triangles"), which rounds its silhouette.
"""

import argparse
import base64
import json
import math
import pathlib
import re
import struct
import subprocess
import tempfile

CLI = "@gltf-transform/cli@4.5.1"


def unpack_module(module, target):
    """Writes the .glb that the JavaScript module carries as a data URL."""
    match = re.search(r"base64,([A-Za-z0-9+/=]+)", module.read_text())
    if match is None:
        raise SystemExit(f"{module}: no base64 data URL found")
    target.write_bytes(base64.b64decode(match.group(1)))


def read_glb(path):
    """Returns (positions, normals, triangles) of the first primitive of an uncompressed .glb (glTF 2.0, section 4)."""
    data = path.read_bytes()
    if data[:4] != b"glTF":
        raise SystemExit(f"{path}: not a binary glTF file")
    json_length = struct.unpack_from("<I", data, 12)[0]
    gltf = json.loads(data[20 : 20 + json_length])
    binary = data[20 + json_length + 8 :]
    formats = {(5123, "SCALAR"): "<H", (5125, "SCALAR"): "<I", (5126, "VEC3"): "<3f"}

    def accessor(index):
        entry = gltf["accessors"][index]
        view = gltf["bufferViews"][entry["bufferView"]]
        layout = formats[entry["componentType"], entry["type"]]
        start = view.get("byteOffset", 0) + entry.get("byteOffset", 0)
        stride = view.get("byteStride", struct.calcsize(layout))
        return [struct.unpack_from(layout, binary, start + i * stride) for i in range(entry["count"])]

    primitive = gltf["meshes"][0]["primitives"][0]
    indices = [index for (index,) in accessor(primitive["indices"])]
    triangles = list(zip(indices[0::3], indices[1::3], indices[2::3]))
    return accessor(primitive["attributes"]["POSITION"]), accessor(primitive["attributes"]["NORMAL"]), triangles


def loop_subdivide(positions, triangles):
    """One step of Loop's scheme. The mesh must be closed: each edge belongs to two triangles."""
    opposite = {}
    neighbours = [set() for _ in positions]
    for a, b, c in triangles:
        for i, j, k in ((a, b, c), (b, c, a), (c, a, b)):
            opposite.setdefault((min(i, j), max(i, j)), []).append(k)
            neighbours[i].add(j)
            neighbours[j].add(i)

    def blend(*terms):
        return tuple(sum(weight * positions[i][axis] for weight, i in terms) for axis in range(3))

    refined = []
    for i, ring in enumerate(neighbours):
        n = len(ring)
        beta = (5 / 8 - (3 / 8 + math.cos(2 * math.pi / n) / 4) ** 2) / n
        refined.append(blend((1 - n * beta, i), *((beta, j) for j in sorted(ring))))
    middle = {}
    for (i, j), tips in opposite.items():
        if len(tips) != 2:
            raise SystemExit(f"the edge {i}-{j} belongs to {len(tips)} triangles: the mesh isn't closed")
        middle[i, j] = middle[j, i] = len(refined)
        refined.append(blend((3 / 8, i), (3 / 8, j), (1 / 8, tips[0]), (1 / 8, tips[1])))
    quarters = []
    for a, b, c in triangles:
        ab, bc, ca = middle[a, b], middle[b, c], middle[c, a]
        quarters += [(a, ab, ca), (b, bc, ab), (c, ca, bc), (ab, bc, ca)]
    return refined, quarters


def vertex_normals(positions, triangles):
    """Averages the face normals around each vertex, weighted by the angle at the vertex (Thürmer & Wüthrich 1998)."""
    sums = [[0.0, 0.0, 0.0] for _ in positions]
    for triangle in triangles:
        for corner in range(3):
            i, j, k = (triangle[(corner + step) % 3] for step in range(3))
            u = [positions[j][axis] - positions[i][axis] for axis in range(3)]
            v = [positions[k][axis] - positions[i][axis] for axis in range(3)]
            normal = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
            length = math.hypot(*normal)
            if length > 0:
                angle = math.atan2(length, sum(p * q for p, q in zip(u, v)))
                for axis in range(3):
                    sums[i][axis] += angle * normal[axis] / length
    return [tuple(x / math.hypot(*total) for x in total) for total in sums]


def stand_on_floor(positions):
    """Moves and scales the mesh uniformly: centred over the origin, lowest point at y = 0, height 1."""
    low = [min(p[axis] for p in positions) for axis in range(3)]
    high = [max(p[axis] for p in positions) for axis in range(3)]
    scale = 1 / (high[1] - low[1])
    origin = ((low[0] + high[0]) / 2, low[1], (low[2] + high[2]) / 2)
    return [tuple((x - o) * scale for x, o in zip(p, origin)) for p in positions]


def write_obj(path, heading, positions, normals, triangles):
    with path.open("w", encoding="ascii", newline="\n") as out:
        out.write("".join(f"# {line}\n" for line in heading))
        for p in positions:
            out.write("v {:.5f} {:.5f} {:.5f}\n".format(*(x + 0.0 for x in p)))
        for n in normals:
            out.write("vn {:.4f} {:.4f} {:.4f}\n".format(*n))
        for a, b, c in triangles:
            out.write(f"f {a + 1}//{a + 1} {b + 1}//{b + 1} {c + 1}//{c + 1}\n")
    print(f"{path}: {len(positions)} vertices, {len(triangles)} triangles, {path.stat().st_size} bytes")


def load(package, name, scratch):
    packed, plain = scratch / f"{name}.glb", scratch / f"{name}-plain.glb"
    unpack_module(package / "models" / f"{name}.glb.js", packed)
    subprocess.run(["npx", "--yes", CLI, "copy", str(packed), str(plain)], check=True, stdout=subprocess.DEVNULL)
    return read_glb(plain)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("package", type=pathlib.Path, help="the unpacked npm package @pmndrs/assets")
    parser.add_argument("--into", type=pathlib.Path, default=pathlib.Path(__file__).parent, help="output folder")
    arguments = parser.parse_args()
    made_by = "Made by assets/make_meshes.py; y up, lowest point at y = 0, height 1."
    with tempfile.TemporaryDirectory() as folder:
        scratch = pathlib.Path(folder)

        positions, _, triangles = load(arguments.package, "bunny", scratch)
        positions, triangles = loop_subdivide(positions, triangles)
        positions = stand_on_floor(positions)
        heading = ("The Stanford bunny (Stanford Computer Graphics Laboratory), see assets/README.md", made_by)
        normals = vertex_normals(positions, triangles)
        write_obj(arguments.into / "bunny.obj", heading, positions, normals, triangles)

        positions, normals, triangles = load(arguments.package, "suzi", scratch)
        heading = ("Suzanne, the monkey of Blender, see assets/README.md", made_by)
        write_obj(arguments.into / "suzanne.obj", heading, stand_on_floor(positions), normals, triangles)


if __name__ == "__main__":
    main()
