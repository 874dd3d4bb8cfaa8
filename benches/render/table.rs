//! The figures as a Markdown table.

use crate::measurement::Measurement;

pub fn print(measurements: &[Measurement]) {
    println!(
        "| scene | device | Mray/s | s | camera, shadow, reflected, refracted rays (M) | first dispatch s | script s \
         | flatten s | of that BVH s | longest submit ms | peak MiB |"
    );
    println!("|---|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|");
    for run in measurements {
        let millions = |rays: u64| format!("{:.2}", rays as f64 / 1e6);
        let rays = [run.camera_rays, run.shadow_rays, run.reflected_rays, run.refracted_rays].map(millions);
        println!(
            "| {} {}x{}, {} samples | {} | {:.2} | {:.2} | {} | {:.2} | {:.2} | {:.3} | {:.3} | {:.0} | {} |",
            run.scene,
            run.width,
            run.height,
            run.samples,
            run.device,
            run.mrays_per_second(),
            run.seconds,
            rays.join(", "),
            run.first_dispatch_seconds,
            run.script_seconds,
            run.flatten_seconds,
            run.mesh_seconds,
            run.longest_submit_seconds * 1e3,
            run.peak_memory >> 20,
        );
    }
    println!();
    for pair in measurements.windows(2).filter(|pair| pair[0].scene == pair[1].scene) {
        let ratio = pair[1].seconds / pair[0].seconds;
        println!("{}: {} is {ratio:.2} times as fast as {}", pair[0].scene, pair[0].device, pair[1].device);
    }
}
