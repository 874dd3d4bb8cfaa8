// Shapes placed in the world. Affine maps are three rows of (linear part, translation).

fn transform_point(m: mat3x4<f32>, p: vec3<f32>) -> vec3<f32> {
    return vec3<f32>(
        m[0].x * p.x + m[0].y * p.y + m[0].z * p.z + m[0].w,
        m[1].x * p.x + m[1].y * p.y + m[1].z * p.z + m[1].w,
        m[2].x * p.x + m[2].y * p.y + m[2].z * p.z + m[2].w,
    );
}

fn transform_vector(m: mat3x4<f32>, v: vec3<f32>) -> vec3<f32> {
    return vec3<f32>(
        m[0].x * v.x + m[0].y * v.y + m[0].z * v.z,
        m[1].x * v.x + m[1].y * v.y + m[1].z * v.z,
        m[2].x * v.x + m[2].y * v.y + m[2].z * v.z,
    );
}

// Normals go by the inverse transpose: `inverse` is the map back, whose transpose is applied. Unit length.
fn transform_normal(inverse: mat3x4<f32>, n: vec3<f32>) -> vec3<f32> {
    return unit_vector_of_any_size(vec3<f32>(
        inverse[0].x * n.x + inverse[1].x * n.y + inverse[2].x * n.z,
        inverse[0].y * n.x + inverse[1].y * n.y + inverse[2].y * n.z,
        inverse[0].z * n.x + inverse[1].z * n.y + inverse[2].z * n.z,
    ));
}

// Scales by the largest component first, so that the squares of tiny and huge vectors stay in range.
fn unit_vector_of_any_size(v: vec3<f32>) -> vec3<f32> {
    let scaled = v / max(max(abs(v.x), abs(v.y)), abs(v.z));
    return scaled / sqrt(scaled.x * scaled.x + scaled.y * scaled.y + scaled.z * scaled.z);
}

// Nearest hit of an instance of this shape, neither plane nor mesh, by a ray in the instance's object space. The
// direction is not normalised there, so that t is the same in the world.
fn instance_intersect(index: u32, shape: u32, origin: vec3<f32>, direction: vec3<f32>, t_max: f32) -> ShapeHit {
    var hit = ShapeHit(MISS, 0u);
    switch shape {
        case SHAPE_SPHERE: {
            if HAS_SPHERE { hit = sphere_intersect(origin, direction, t_max); }
        }
        case SHAPE_CUBE: {
            if HAS_CUBE { hit = cube_intersect(origin, direction, t_max); }
        }
        case SHAPE_CYLINDER: {
            if HAS_CYLINDER { hit = cylinder_intersect(origin, direction, t_max); }
        }
        case SHAPE_CONE: {
            if HAS_CONE { hit = cone_intersect(origin, direction, t_max); }
        }
        case SHAPE_TORUS: {
            if HAS_TORUS { hit = torus_intersect(origin, direction, t_max, parameters_of(index).xy); }
        }
        default: {}
    }
    return hit;
}

// The surface at a hit of the world-space ray (origin, direction).
fn surface_at(hit: Hit, origin: vec3<f32>, direction: vec3<f32>) -> Surface {
    let object_from_world = object_from_world_of(hit.instance);
    let object_direction = transform_vector(object_from_world, direction);
    var point = transform_point(object_from_world, origin) + hit.t * object_direction;
    var normal = vec3<f32>(0.0, 1.0, 0.0);
    var is_smooth = false;
    var smooth_normal = vec3<f32>(0.0, 1.0, 0.0);
    switch shape_of(hit.instance) {
        case SHAPE_SPHERE: {
            if HAS_SPHERE {
                point = sphere_project(point, hit.primitive);
                normal = sphere_normal(point, hit.primitive);
            }
        }
        case SHAPE_CUBE: {
            if HAS_CUBE {
                point = cube_project(point, hit.primitive);
                normal = cube_normal(point, hit.primitive);
            }
        }
        case SHAPE_CYLINDER: {
            if HAS_CYLINDER {
                point = cylinder_project(point, hit.primitive);
                normal = cylinder_normal(point, hit.primitive);
            }
        }
        case SHAPE_CONE: {
            if HAS_CONE {
                point = cone_project(point, hit.primitive);
                normal = cone_normal(point, hit.primitive);
            }
        }
        case SHAPE_TORUS: {
            if HAS_TORUS {
                let radii = parameters_of(hit.instance).xy;
                point = torus_project(point, hit.primitive, radii);
                normal = torus_normal(point, hit.primitive, radii);
            }
        }
        case SHAPE_PLANE: {
            if HAS_PLANE {
                point = plane_project(point, hit.primitive);
                normal = plane_normal(point, hit.primitive);
            }
        }
        case SHAPE_MESH: {
            if HAS_MESH {
                let triangle = triangle_at(hit.primitive);
                let b0 = 1.0 - hit.b1 - hit.b2;
                point = b0 * triangle.p0 + hit.b1 * triangle.p1 + hit.b2 * triangle.p2;
                normal = triangle_geometric_normal(triangle.p0, triangle.p1, triangle.p2);
                is_smooth = (triangle.flags & TRIANGLE_SMOOTH) != 0u;
                smooth_normal = triangle_shading_normal(triangle.n0, triangle.n1, triangle.n2, hit.b1, hit.b2);
            }
        }
        default: {}
    }

    let cosine = normal.x * object_direction.x + normal.y * object_direction.y + normal.z * object_direction.z;
    let entering = cosine < 0.0;
    var geometric_normal = transform_normal(object_from_world, normal);
    geometric_normal = select(-geometric_normal, geometric_normal, entering);
    var shading_normal = geometric_normal;
    if HAS_MESH && is_smooth {
        shading_normal = transform_normal(object_from_world, smooth_normal);
        let side = shading_normal.x * geometric_normal.x + shading_normal.y * geometric_normal.y
            + shading_normal.z * geometric_normal.z;
        shading_normal = select(shading_normal, -shading_normal, side < 0.0);
    }
    return Surface(
        transform_point(world_from_object_of(hit.instance), point),
        geometric_normal,
        shading_normal,
        entering,
        material_of(hit.instance),
        materials[material_of(hit.instance)].diffuse,
    );
}
