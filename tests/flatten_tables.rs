//! The smaller tables that a scene becomes: materials, lights, the frame, features, the plan of the work.

use crate::support::Stage;
use crate::support::placed::*;
use glam::{DAffine3, DVec3, Vec3};
use gpu_trace::flatten::{FeatureSet, MAX_GLOSSY_SAMPLES, MAX_LIGHT_SAMPLES, WorkPlan, plan_work};
use gpu_trace::layout::{
    FRAME_BLINN, FRAME_SAMPLE_CENTRE, FRAME_SAMPLE_CORNER, FRAME_TRANSPARENT, Frame, LIGHT_PARALLELOGRAM, LIGHT_POINT,
    LIGHT_SPHERE, NONE,
};
use gpu_trace::scene::{Conventions, LightExtent, Material, PixelOrigin, Shape, Specular};
use std::sync::Arc;

#[test]
fn only_materials_in_use_are_kept_and_media_are_numbered() {
    let mut stage = Stage::new(8, 8);
    let glass = Material { ior: Some(1.5), ..Material::default() };
    let water = Material { ior: Some(1.33), reflection: 0.5, ..Material::default() };
    let red = Material { diffuse: Vec3::X, ..Material::default() };
    for (material, x) in [(red, 0.0), (glass, 3.0), (water, 6.0)] {
        stage.add(Shape::Sphere, DAffine3::from_translation(DVec3::new(x, 0.0, 0.0)), material);
    }
    let mut scene = stage.finish();
    let mut graph = (*scene.graph).clone();
    graph.add_material(Material { ior: Some(9.0), ..Material::default() });
    add_child(&mut graph, scene.root, DAffine3::from_translation(DVec3::new(9.0, 0.0, 0.0)), Some(Shape::Sphere));
    scene.graph = Arc::new(graph);
    let buffers = flattened(&scene);
    // The node without a material has the default one.
    assert_eq!(buffers.materials.len(), 4);
    for instance in &buffers.instances {
        let material = &buffers.materials[instance.material as usize];
        let expected = match instance.world_from_object[0].w {
            0.0 => (Vec3::X, 0.0),
            3.0 => (Vec3::splat(0.5), 1.5),
            6.0 => (Vec3::splat(0.5), 1.33),
            _ => (Vec3::splat(0.5), 0.0),
        };
        assert_eq!((material.diffuse, material.ior), expected);
        let medium = if material.ior > 0.0 { instance.material + 1 } else { 0 };
        assert_eq!(material.medium, medium);
        assert_eq!((material.texture, material.bump), (NONE, NONE));
    }
}

#[test]
fn too_many_media_are_refused() {
    let mut stage = Stage::new(8, 8);
    for i in 0..65_536 {
        stage.add(Shape::Sphere, DAffine3::IDENTITY, Material { ior: Some(1.0 + i as f32), ..Material::default() });
    }
    let message = refusal(&stage.finish());
    assert!(message.contains("65536 refractive materials"), "{message}");
}

#[test]
fn lights_take_the_kind_that_the_shadow_count_allows() {
    let extents = [
        LightExtent::Classic,
        LightExtent::Parallelogram { u: DVec3::new(2.0, 0.0, 0.0), v: DVec3::new(0.0, 3.0, 0.0) },
        LightExtent::Sphere { radius: 0.25 },
    ];
    for (shadow, classic) in [(1, LIGHT_POINT), (2, LIGHT_PARALLELOGRAM)] {
        let mut stage = Stage::new(8, 8);
        for extent in extents {
            stage.add_light(DVec3::new(1.0, 2.0, 3.0), Vec3::ONE, extent);
        }
        stage.scene.sampling.shadow = shadow;
        let buffers = flattened(&stage.finish());
        let kinds: Vec<u32> = buffers.lights.iter().map(|light| light.kind).collect();
        assert_eq!(kinds, [classic, LIGHT_PARALLELOGRAM, LIGHT_SPHERE]);
        assert_eq!(buffers.lights[1].v, Vec3::new(0.0, 3.0, 0.0));
        assert_eq!((buffers.lights[2].radius, buffers.lights[2].position), (0.25, Vec3::new(1.0, 2.0, 3.0)));
        if classic == LIGHT_PARALLELOGRAM {
            assert_eq!((buffers.lights[0].u, buffers.lights[0].v), (Vec3::X, Vec3::Z));
        }
        assert_eq!(buffers.frame.light_count, 3);
    }
}

#[test]
fn the_frame_holds_the_camera_and_the_flags() {
    let mut stage = Stage::new(200, 100);
    stage.scene.camera.forward = DVec3::new(0.0, 0.0, -1.0);
    stage.scene.camera.up = DVec3::new(0.3, 5.0, 2.0);
    stage.scene.camera.fov = 90.0;
    let buffers = flattened(&stage.finish());
    let frame = buffers.frame;
    assert!((frame.tan_half_fov - 1.0).abs() < 1e-6);
    assert_eq!(frame.aspect, 2.0);
    assert!((frame.right.cross(frame.forward) - frame.up).length() < 1e-6);
    assert!(frame.right.x > 0.9 && frame.up.y > 0.9 && frame.right.dot(frame.up).abs() < 1e-6);
    assert_eq!(frame.flags, FRAME_SAMPLE_CENTRE);

    let mut stage = Stage::new(8, 8);
    stage.scene.sampling.camera = 4;
    stage.scene.background.transparent = true;
    stage.scene.conventions = Conventions { specular: Specular::Blinn, sample: PixelOrigin::Corner };
    let flags = flattened(&stage.finish()).frame.flags;
    assert_eq!(flags, FRAME_SAMPLE_CORNER | FRAME_TRANSPARENT | FRAME_BLINN);

    for (up, fov, part) in
        [(DVec3::Z, 60.0, "parallel"), (DVec3::Y, 180.0, "angle of view"), (DVec3::Y, f64::NAN, "angle")]
    {
        let mut stage = Stage::new(8, 8);
        stage.scene.camera.up = up;
        stage.scene.camera.fov = fov;
        let message = refusal(&stage.finish());
        assert!(message.contains(part), "{message}");
    }
}

#[test]
fn features_are_those_of_the_scene() {
    let torus = Shape::Torus { major: 1.0, minor: 0.25 };
    let mesh = Shape::Mesh(Arc::new(quad()));
    let shapes = [Shape::Sphere, Shape::Cube, Shape::Cylinder, Shape::Cone, torus, Shape::Plane, mesh];
    let names = ["HAS_SPHERE", "HAS_CUBE", "HAS_CYLINDER", "HAS_CONE", "HAS_TORUS", "HAS_PLANE", "HAS_MESH"];
    let on = |features: FeatureSet| -> Vec<&str> {
        features.overrides().into_iter().filter(|(_, value)| *value).map(|(name, _)| name).collect()
    };
    for (shape, name) in shapes.into_iter().zip(names) {
        let analytic = !["HAS_PLANE", "HAS_MESH"].contains(&name);
        let expected = if analytic { vec![name, "HAS_ANALYTIC", "HAS_INSTANCES"] } else { vec![name] };
        assert_eq!(on(flattened(&scene_of([(shape, DAffine3::IDENTITY)])).features), expected);
    }
    // One mesh is met without a search for instances: beside planes, but beside nothing else.
    let quad = || (Shape::Mesh(Arc::new(quad())), DAffine3::IDENTITY);
    let plane = (Shape::Plane, DAffine3::IDENTITY);
    assert_eq!(on(flattened(&scene_of([quad(), plane])).features), ["HAS_PLANE", "HAS_MESH"]);
    assert_eq!(on(flattened(&scene_of([quad(), quad()])).features), ["HAS_MESH", "HAS_INSTANCES"]);
    let with_material = |material| {
        let mut stage = Stage::new(8, 8);
        stage.scene.sampling.glossy = 2;
        stage.add(Shape::Cube, DAffine3::IDENTITY, material);
        on(flattened(&stage.finish()).features)
    };

    let of_cube = |further: &[&'static str]| [&["HAS_CUBE", "HAS_ANALYTIC", "HAS_INSTANCES"], further].concat();
    assert_eq!(with_material(Material { glossy: 0.5, ..Material::default() }), of_cube(&[]));
    let mirror = Material { reflection: 0.5, ..Material::default() };
    assert_eq!(with_material(mirror), of_cube(&["HAS_REFLECTION"]));
    let glossy = Material { reflection: 0.5, glossy: 0.1, ..Material::default() };
    assert_eq!(with_material(glossy), of_cube(&["HAS_REFLECTION", "HAS_GLOSSY"]));
    // Total internal reflection needs no reflective material.
    let glass = Material { ior: Some(1.5), ..Material::default() };
    assert_eq!(with_material(glass), of_cube(&["HAS_REFLECTION", "HAS_REFRACTION"]));
    let mut stage = Stage::new(8, 8);
    stage.scene.camera.lens_edge = 0.5;
    stage.add_light(DVec3::Y, Vec3::ONE, LightExtent::Sphere { radius: 1.0 });
    assert_eq!(on(flattened(&stage.finish()).features), ["HAS_AREA_LIGHT", "HAS_LENS"]);
    assert_eq!(on(FeatureSet::ALL_OFF), [""; 0]);
    assert_eq!(on(FeatureSet::ALL_ON).len(), FeatureSet::ALL_ON.overrides().len());
}

#[test]
fn work_is_shared_out_over_passes() {
    // (lights, shadow, glossy, passes asked for) -> (passes, light samples, deep light samples, glossy samples)
    let table = [
        ((0, 1, 1, 1), (1, 0, 0, 1)),
        ((1, 1, 1, 1), (1, 1, 1, 1)),
        ((2, 16, 4, 1), (1, 32, 2, 4)),
        ((4, 16, 1, 1), (1, 64, 4, 1)),
        ((1, 65, 1, 1), (2, 33, 1, 1)),
        ((101, 1, 1, 1), (2, 51, 8, 1)),
        ((3, 1, 16, 1), (4, 1, 3, 4)),
        ((0, 1, 17, 1), (5, 0, 0, 4)),
        ((4, 16, 4, 2), (2, 32, 4, 2)),
        ((1, 1, 1, 8), (8, 1, 1, 1)),
    ];
    for ((lights, shadow, glossy, min_passes), expected) in table {
        let plan = plan_work(lights, shadow, glossy, min_passes);
        let got = (plan.pass_count, plan.light_samples, plan.deep_light_samples, plan.glossy_samples);
        assert_eq!(got, expected, "{lights} lights, {shadow} shadow rays, {glossy} glossy rays, {min_passes} passes");
        assert_eq!(plan.shadow_count, shadow);
    }
}

#[test]
fn plans_cover_what_was_asked_for_and_can_be_halved_to_the_end() {
    let mut random = Random(3);
    for _ in 0..2000 {
        let (lights, shadow) = (random.below(300) as u32, 1 + random.below(300) as u32);
        let glossy = 1 + random.below(100) as u32;
        let mut plan = plan_work(lights, shadow, glossy, 1);
        for halvings in 0.. {
            assert!(plan.light_samples <= MAX_LIGHT_SAMPLES && plan.glossy_samples <= MAX_GLOSSY_SAMPLES);
            assert!(u64::from(plan.light_samples) * u64::from(plan.pass_count) >= u64::from(lights * shadow));
            assert!(plan.glossy_samples * plan.pass_count >= glossy);
            if !plan.can_halve() {
                assert!(plan.light_samples <= 1 && plan.glossy_samples == 1);
                break;
            }
            assert!(halvings < 10, "{plan:?} is not halved");
            let smaller = plan_work(lights, shadow, glossy, 2 * plan.pass_count);
            let halved = |before: u32, after: u32| after <= before.div_ceil(2);
            assert!(halved(plan.light_samples, smaller.light_samples), "{plan:?} {smaller:?}");
            assert!(halved(plan.glossy_samples, smaller.glossy_samples), "{plan:?} {smaller:?}");
            plan = smaller;
        }
    }
    let huge = plan_work(u32::MAX, u32::MAX, u32::MAX, u32::MAX);
    assert_eq!(huge.pass_count, u32::MAX);
    assert_eq!(WorkPlan::default().applied_to(Frame::default()), Frame::default());
}

#[test]
fn shadow_rays_beyond_reason_are_refused() {
    let mut stage = Stage::new(8, 8);
    stage.add_light(DVec3::Y, Vec3::ONE, LightExtent::Classic);
    stage.scene.sampling.shadow = u32::MAX;
    let message = refusal(&stage.finish());
    assert!(message.contains("4294967295 shadow rays"), "{message}");
}
