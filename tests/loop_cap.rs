//! Mesa before 23 lets one invocation turn 65,535 times through all its loops, then leaves every loop without a word.
//! No picture may come out wrong for it: work is divided until it fits, or rendering stops with an error.

use crate::support::{Stage, paint, render_with};
use glam::{DAffine3, DVec3, Vec3};
use gpu_trace::device::{DeviceChoice, open_renderer};
use gpu_trace::flatten::{WorkPlan, flatten};
use gpu_trace::layout::STATUS_LOOP_BOUND;
use gpu_trace::render::{RenderOptions, Unattended, render};
use gpu_trace::scene::{LightExtent, Shape};
use std::sync::Arc;

/// Many lights over a wood of thin tori seen along their rows: long walks through the hierarchy for every shadow ray.
fn heavy_stage(lights: u32, shadow: u32) -> Stage {
    let mut stage = Stage::new(16, 8);
    stage.scene.ambient = Vec3::splat(0.1);
    stage.scene.sampling.shadow = shadow;
    stage.add(Shape::Plane, DAffine3::from_translation(DVec3::new(0.0, -1.0, 0.0)), paint(0.7, 0.7, 0.7));
    for i in 0..400 {
        let place =
            DVec3::new(f64::from(i % 20) * 0.5 - 5.0, f64::from(i % 7) * 0.15 - 0.8, -2.0 - f64::from(i / 20) * 0.5);
        let turned = DAffine3::from_translation(place) * DAffine3::from_rotation_x(f64::from(i));
        stage.add(Shape::Torus { major: 0.5, minor: 0.02 }, turned, paint(0.9, 0.5, 0.2));
    }
    for i in 0..lights {
        let angle = f64::from(i) * 0.7;
        let position = DVec3::new(angle.cos() * 9.0, 0.5 + f64::from(i % 5) * 0.3, angle.sin() * 9.0 - 6.0);
        stage.add_light(position, Vec3::splat(1.0 / lights as f32), LightExtent::Classic);
    }
    stage
}

/// With every shadow ray in one pass an invocation passes the cap of old drivers: the renderer has to notice.
#[test]
fn work_beyond_the_cap_renders_right() {
    let scene = heavy_stage(100, 16).finish();
    let buffers = Arc::new(flatten(&scene).unwrap_or_else(|error| panic!("{error}")));
    // One pass for all 1600 shadow rays, many times the ordinary budget.
    let plan =
        WorkPlan { pass_count: 1, shadow_count: 16, light_samples: 1600, deep_light_samples: 8, glossy_samples: 1 };
    let picture = |choice: DeviceChoice| {
        let (mut renderer, info) = open_renderer(&choice, false).unwrap_or_else(|error| panic!("{error}"));
        let options = RenderOptions { plan: Some(plan), ..RenderOptions::whole(&buffers) };
        let rendered = render(buffers.clone(), renderer.as_mut(), &options, &mut Unattended)
            .unwrap_or_else(|error| panic!("{error}"));
        println!("{}: {} passes, {} rays", info.name, rendered.passes, rendered.tally.total_rays());
        rendered
    };
    let (gpu, cpu) = (picture(DeviceChoice::Gpu), picture(DeviceChoice::Cpu));
    let worst = gpu
        .film
        .pixels
        .iter()
        .zip(&cpu.film.pixels)
        .flat_map(|(a, b)| (0..4).map(|channel| a[channel].abs_diff(b[channel])))
        .max();
    // A lost shadow ray of 1600 would show as 1/1600 of a light's share, some 650 units.
    assert!(worst < Some(400), "GPU and CPU differ by {worst:?} film units");
    if std::env::var("GPU_TRACE_EXPECT_DRIVER").is_ok_and(|driver| driver.starts_with("22.")) {
        assert!(gpu.passes > 1, "the old driver's cap was not noticed, or the scene does not reach it");
    }
}

/// A single ray, without lights or depth, that passes through the holes of so many rings that its one walk through the
/// hierarchy is beyond the cap. Nothing is left undone that would show it: only the loop at the end of the invocation
/// can tell that the wall behind was lost. There is nothing to divide, so the answer is the picture or an error.
#[test]
fn one_ray_beyond_the_cap_is_right_or_an_error() {
    let mut stage = Stage::new(8, 8);
    stage.scene.camera.fov = 5.0;
    stage.scene.ambient = Vec3::ONE;
    stage.scene.sampling.max_depth = 0;
    let facing = DAffine3::from_translation(DVec3::NEG_Z * 5.0) * DAffine3::from_rotation_x(1.57);
    for i in 0..30_000 {
        let ring = Shape::Torus { major: 1.0 + f64::from(i) * 1e-4, minor: 0.02 };
        stage.add(ring, facing, paint(0.0, 0.0, 1.0));
    }
    stage.add_box(DVec3::new(-9.0, -9.0, -20.0), DVec3::new(9.0, 9.0, -19.0), paint(1.0, 0.5, 0.0));
    let buffers = Arc::new(flatten(&stage.finish()).unwrap_or_else(|error| panic!("{error}")));
    let picture = |choice: DeviceChoice| {
        let (mut renderer, _) = open_renderer(&choice, false).unwrap_or_else(|error| panic!("{error}"));
        render(buffers.clone(), renderer.as_mut(), &RenderOptions::whole(&buffers), &mut Unattended)
    };
    let cpu = picture(DeviceChoice::Cpu).unwrap_or_else(|error| panic!("{error}"));
    assert!(cpu.film.radiance(4, 4)[0] > 0.99, "the wall is not seen through the rings");
    let old = std::env::var("GPU_TRACE_EXPECT_DRIVER").is_ok_and(|driver| driver.starts_with("22."));
    match picture(DeviceChoice::Gpu) {
        Ok(gpu) => {
            assert!(gpu.film == cpu.film, "the GPU's picture is wrong, and nothing was said");
            assert!(!old, "the scene does not reach the old driver's cap");
        }
        Err(error) => {
            println!("{error}");
            assert!(error.to_string().contains("loop turns"), "{error}");
        }
    }
}

/// The probe that every invocation ends with is what notices: a kernel whose loops are cut short must say so.
#[test]
fn the_driver_is_known_by_its_loop_cap() {
    for (device, cap) in gpu_trace::gpu::probe::loop_caps().unwrap_or_else(|error| panic!("{error}")) {
        println!("{device}: {cap:?}");
        let capped = cap.turns().is_some();
        assert_eq!(cap.single.made, if capped { 65_535 } else { 100_000 });
        let old = std::env::var("GPU_TRACE_EXPECT_DRIVER").is_ok_and(|driver| driver.starts_with("22."));
        assert!(!old || capped, "the old driver is expected to cap loops");
    }
}

/// Invocations that take pixel after pixel would only lose what they rendered where loops are cut short.
#[test]
fn drivers_that_cut_loops_short_are_known_before_the_first_pixel() {
    use gpu_trace::gpu::probe::loop_cap;
    use gpu_trace::gpu::{Device, DeviceSelector, GpuOptions, GpuRenderer};
    use gpu_trace::renderer::Renderer;
    use gpu_trace::shader::MemoryAccess;

    let device = Device::open(&DeviceSelector::Any).unwrap_or_else(|error| panic!("{error}"));
    let is_capped = loop_cap(&device).unwrap_or_else(|error| panic!("{error}")).turns().is_some();
    let may_take = device.memory_access() == MemoryAccess::SharedPairs;
    let mut renderer = GpuRenderer::new(device, GpuOptions::default()).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(renderer.takes_work(), may_take);
    let buffers = Arc::new(flatten(&heavy_stage(1, 1).finish()).unwrap_or_else(|error| panic!("{error}")));
    renderer.prepare(buffers).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(renderer.takes_work(), may_take && !is_capped);
}

/// A renderer that reports the bound whatever is asked of it ends in an error, not in a picture.
#[test]
fn a_bound_that_never_goes_away_is_an_error() {
    use gpu_trace::film::Film;
    use gpu_trace::flatten::SceneBuffers;
    use gpu_trace::layout::{Dispatch, Frame};
    use gpu_trace::renderer::{Renderer, Tally};

    struct AlwaysBounded;
    impl Renderer for AlwaysBounded {
        fn prepare(&mut self, _: Arc<SceneBuffers>) -> gpu_trace::Result<()> {
            Ok(())
        }
        fn max_band_pixels(&self) -> u64 {
            u64::MAX
        }
        fn begin_band(&mut self, _: std::ops::Range<u32>) -> gpu_trace::Result<()> {
            Ok(())
        }
        fn submit(&mut self, _: &Frame, _: &[Dispatch]) -> gpu_trace::Result<Tally> {
            Ok(Tally { flags: STATUS_LOOP_BOUND, ..Tally::default() })
        }
        fn end_band(&mut self, _: &mut Film) -> gpu_trace::Result<()> {
            panic!("a band that met a bound must not reach the film");
        }
    }
    let buffers = Arc::new(flatten(&heavy_stage(3, 7).finish()).unwrap_or_else(|error| panic!("{error}")));
    let options = RenderOptions::whole(&buffers);
    let error = render(buffers, &mut AlwaysBounded, &options, &mut Unattended).expect_err("there is no picture");
    assert!(error.to_string().contains("loop turns"), "{error}");
}

/// Where the bound goes away once invocations have one pixel, passes stay as they were, and rays count once.
#[test]
fn a_bound_that_goes_away_with_one_pixel_an_invocation_costs_a_repetition() {
    use gpu_trace::film::Film;
    use gpu_trace::flatten::SceneBuffers;
    use gpu_trace::layout::{Dispatch, Frame};
    use gpu_trace::renderer::{Renderer, Tally};

    struct BoundedWhileTaking {
        takes: bool,
        submits: u64,
        bands: u32,
    }
    impl Renderer for BoundedWhileTaking {
        fn prepare(&mut self, _: Arc<SceneBuffers>) -> gpu_trace::Result<()> {
            Ok(())
        }
        fn max_band_pixels(&self) -> u64 {
            u64::MAX
        }
        fn begin_band(&mut self, _: std::ops::Range<u32>) -> gpu_trace::Result<()> {
            self.submits = 0;
            self.bands += 1;
            Ok(())
        }
        fn submit(&mut self, _: &Frame, dispatches: &[Dispatch]) -> gpu_trace::Result<Tally> {
            assert!(dispatches.iter().all(|dispatch| dispatch.takes_work == u32::from(self.takes)));
            self.submits += 1;
            let flags = if self.takes { STATUS_LOOP_BOUND } else { 0 };
            Ok(Tally { flags, rays: [1, 0, 0, 0] })
        }
        fn end_band(&mut self, _: &mut Film) -> gpu_trace::Result<()> {
            Ok(())
        }
        fn takes_work(&self) -> bool {
            self.takes
        }
        fn stop_taking_work(&mut self) {
            self.takes = false;
        }
    }
    let buffers = Arc::new(flatten(&heavy_stage(3, 7).finish()).unwrap_or_else(|error| panic!("{error}")));
    let options = RenderOptions::whole(&buffers);
    let mut renderer = BoundedWhileTaking { takes: true, submits: 0, bands: 0 };
    let rendered = render(buffers, &mut renderer, &options, &mut Unattended).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!((renderer.takes, renderer.bands, rendered.passes), (false, 2, 1));
    assert_eq!(rendered.tally, Tally { flags: 0, rays: [renderer.submits, 0, 0, 0] });
}

/// The ordinary budget, on the same scene: the passes are planned so that nothing has to be repeated.
#[test]
fn work_within_the_budget_is_not_repeated() {
    let scene = heavy_stage(4, 16).finish();
    let rendered = render_with(&scene, &DeviceChoice::Gpu, |_| ());
    assert_eq!(rendered.passes, 1);
}
