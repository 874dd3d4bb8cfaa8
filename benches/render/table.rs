//! The figures as a Markdown table.

use crate::measurement::Measurement;

/// One row a measurement; those must have been asked for the same errors.
pub fn print(measurements: &[Measurement]) {
    let errors = measurements.first().map_or(&[][..], |run| &run.times_to_rmse);
    println!(
        "| scene | device | Mray/s | s | camera, shadow, reflected, refracted rays (M) | first dispatch s | script s \
         | flatten s | of that BVH s | longest submit ms | peak MiB |{}",
        errors.iter().map(|error| format!(" s to RMSE {} |", error.rmse)).collect::<String>()
    );
    println!("|---|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|{}", "--:|".repeat(errors.len()));
    for run in measurements {
        let millions = |rays: u64| format!("{:.2}", rays as f64 / 1e6);
        let times = run.times_to_rmse.iter().map(|time| match time.seconds {
            Some(seconds) => format!(" {seconds:.3} |"),
            None => " – |".to_owned(),
        });
        let rays = [run.camera_rays, run.shadow_rays, run.reflected_rays, run.refracted_rays].map(millions);
        println!(
            "| {} {}x{}, {} samples | {} | {:.2} | {:.2} | {} | {:.2} | {:.2} | {:.3} | {:.3} | {:.0} | {} |{}",
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
            times.collect::<String>(),
        );
    }
    println!();
    let mut drivers: Vec<_> = measurements.iter().map(|run| (&run.device, &run.driver)).collect();
    drivers.sort();
    drivers.dedup();
    for (device, driver) in drivers {
        println!("{device}: {driver}");
    }
    for pair in measurements.windows(2).filter(|pair| pair[0].scene == pair[1].scene) {
        let ratio = pair[1].seconds / pair[0].seconds;
        println!("{}: {} is {ratio:.2} times as fast as {}", pair[0].scene, pair[0].device, pair[1].device);
    }
}
