// Texture coordinates and tangents of the surface at a hit. v = 0 is the image's top row, so that in a space that is
// not mirrored dpdu x dpdv points into the shape.

// In world space; the tangents are not of unit length, but the true derivatives of the point.
fn parameterise_at(hit: Hit, surface: Surface) -> Parameterisation {
    let point = transform_point(object_from_world_of(hit.instance), surface.point);
    // Once for all shapes that share it: it costs much code.
    let around = revolution(point);
    var result = Parameterisation(vec2<f32>(0.0), vec3<f32>(1.0, 0.0, 0.0), vec3<f32>(0.0, 0.0, 1.0));
    switch shape_of(hit.instance) {
        case SHAPE_SPHERE: {
            if HAS_SPHERE { result = sphere_parameterise(point, hit.primitive, around); }
        }
        case SHAPE_CUBE: {
            if HAS_CUBE { result = cube_parameterise(point, hit.primitive); }
        }
        case SHAPE_CYLINDER: {
            if HAS_CYLINDER { result = cylinder_parameterise(point, hit.primitive, around); }
        }
        case SHAPE_CONE: {
            if HAS_CONE { result = cone_parameterise(point, hit.primitive, around); }
        }
        case SHAPE_TORUS: {
            if HAS_TORUS {
                result = torus_parameterise(point, hit.primitive, around, parameters_of(hit.instance).xy);
            }
        }
        case SHAPE_PLANE: {
            if HAS_PLANE { result = plane_parameterise(point, hit.primitive); }
        }
        case SHAPE_MESH: {
            if HAS_MESH {
                let triangle = triangle_at(hit.primitive);
                result = triangle_parameterise(
                    triangle.p0, triangle.p1, triangle.p2, triangle.uv0, triangle.uv1, triangle.uv2, hit.b1, hit.b2,
                    parameters_of(hit.instance),
                );
            }
        }
        default: {}
    }
    let world_from_object = world_from_object_of(hit.instance);
    return Parameterisation(
        result.uv,
        transform_vector(world_from_object, result.dpdu),
        transform_vector(world_from_object, result.dpdv),
    );
}
