// What maps do to a surface: its colour from a texture, its normal from a bump map.

// Wider filters than this many repetitions of a map see its mean.
const FOOTPRINT_MAX: f32 = 1024.0;

// Edge, in units of uv, of the square of the map that a cone of rays covers: the cone's width (world units) over the
// cosine of its incidence and the root of |Pu x Pv|, the area of the unit square of uv (Akenine-Möller et al., "Texture
// Level of Detail Strategies for Real-Time Ray Tracing", Ray Tracing Gems, 2019, chapter 20).
fn map_footprint(cone_width: f32, cosine: f32, dpdu: vec3<f32>, dpdv: vec3<f32>) -> f32 {
    let c = cross(dpdu, dpdv);
    let area = sqrt(c.x * c.x + c.y * c.y + c.z * c.z);
    let width = cone_width / max(abs(cosine), 1.0e-3);
    return clamp(width / sqrt(max(area, 1.0e-20)), 0.0, FOOTPRINT_MAX);
}

// The surface with the colour and the normal that its material's maps give it, for a ray of the unit direction and of
// the width `cone_width` (world units) there.
fn surface_detail(hit: Hit, surface: Surface, direction: vec3<f32>, cone_width: f32) -> Surface {
    var detailed = surface;
    if !HAS_TEXTURE && !HAS_BUMP {
        return detailed;
    }
    let material = materials[surface.material];
    let textured = HAS_TEXTURE && (material.flags & MATERIAL_TEXTURE_REPLACES) != 0u && material.texture != NONE;
    let bumped = HAS_BUMP && ((material.flags & MATERIAL_NOISE_BUMP) != 0u || material.bump != NONE);
    if !textured && !bumped {
        return detailed;
    }
    var parameterisation = parameterise_at(hit, surface);
    let cosine = dot(direction, surface.geometric_normal);
    let footprint = map_footprint(cone_width, cosine, parameterisation.dpdu, parameterisation.dpdv);
    if textured {
        detailed.diffuse = texture_lookup(material.texture, parameterisation.uv, footprint);
    }
    if bumped {
        // In object space, so that bumps grow with the shape. Heights rise out of the shape: the inner side, whose
        // normals point inwards, shows dents.
        let object_from_world = object_from_world_of(hit.instance);
        parameterisation.dpdu = transform_vector(object_from_world, parameterisation.dpdu);
        parameterisation.dpdv = transform_vector(object_from_world, parameterisation.dpdv);
        let side = select(-1.0, 1.0, surface.entering);
        let outward = transform_normal(world_from_object_of(hit.instance), side * surface.shading_normal);
        let turned = bump_normal(material, parameterisation, outward, footprint);
        let normal = side * transform_normal(object_from_world, turned);
        detailed.shading_normal = visible_normal(normal, surface.geometric_normal, -direction);
    }
    return detailed;
}
