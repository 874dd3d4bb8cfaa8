# Writes hills in CELLS x CELLS squares, two triangles each, as an OBJ file whose faces have corners of a FORM:
# "shared" i, "full" i/j/k with smooth normals, "apart" three `v` lines a face.
#
#   awk -v cells=707 -v form=shared -f obj.awk

function height(x, z) {
    return 0.05 * sin(17 * x) * sin(13 * z) + 0.01 * sin(71 * x + 40 * z)
}

function vertex(row, column,    x, z) {
    x = column / cells
    z = row / cells
    printf "v %.6f %.6f %.6f\n", x, height(x, z), z
    if (form == "full") {
        printf "vt %.6f %.6f\nvn %.4f %.4f %.4f\n", x, z, -0.85 * cos(17 * x) * sin(13 * z) - 0.71 * cos(71 * x + 40 * z),
            1, -0.65 * sin(17 * x) * cos(13 * z) - 0.4 * cos(71 * x + 40 * z)
    }
}

function face(a, b, c) {
    if (form == "full") {
        printf "f %d/%d/%d %d/%d/%d %d/%d/%d\n", a, a, a, b, b, b, c, c, c
    } else {
        printf "f %d %d %d\n", a, b, c
    }
}

BEGIN {
    if (form == "apart") {
        for (row = 0; row < cells; row++) {
            for (column = 0; column < cells; column++) {
                vertex(row, column); vertex(row + 1, column); vertex(row + 1, column + 1)
                vertex(row, column); vertex(row + 1, column + 1); vertex(row, column + 1)
                face(count + 1, count + 2, count + 3); face(count + 4, count + 5, count + 6)
                count += 6
            }
        }
        exit
    }
    for (row = 0; row <= cells; row++) {
        for (column = 0; column <= cells; column++) {
            vertex(row, column)
        }
    }
    for (row = 0; row < cells; row++) {
        for (column = 0; column < cells; column++) {
            corner = row * (cells + 1) + column + 1
            below = corner + cells + 1
            face(corner, below, below + 1); face(corner, below + 1, corner + 1)
        }
    }
}
