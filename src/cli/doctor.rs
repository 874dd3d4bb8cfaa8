//! `gpu-trace doctor`: what devices there are, what they allow, and whether they compute right.

use super::compare::print_line;
use super::reference::{agrees, compare_tiles, render_known_answer, render_tile};
use gpu_trace::device::DeviceInfo;
use gpu_trace::film::Film;
use gpu_trace::gpu::device::INSTALL_HINT;
use gpu_trace::gpu::{Description, Device, DeviceLimits, GpuOptions, GpuRenderer, probe};
use gpu_trace::renderer::Renderer;
use gpu_trace::{Error, Result};

/// Prints a block of lines for each device.
///
/// # Errors
/// [`Error::Device`] with the names of the devices that failed a test.
pub fn run() -> Result<()> {
    print_line(&format!("gpu-trace {}", env!("CARGO_PKG_VERSION")))?;
    let mut failed = Vec::new();

    let (mut cpu, info) = gpu_trace::device::open_cpu(String::new());
    print_line(&format!("\n{info}"))?;
    let known = known_answer(cpu.as_mut())?;
    let tile = render_tile(cpu.as_mut());
    let rendered = match &tile {
        Ok(tile) => verdict(true, &format!("{} rays", tile.tally.total_rays())),
        Err(error) => verdict(false, &error.to_string()),
    };
    print_tile(&rendered)?;
    if !known || tile.is_err() {
        failed.push(info.name);
    }
    let reference = tile.ok().map(|tile| tile.film);

    let devices = Device::open_each();
    if devices.is_empty() {
        print_line(&format!("\nNo Vulkan, Metal or Direct3D 12 device was found; {INSTALL_HINT}."))?;
    }
    for (description, limits, device) in devices {
        if !examine(&description, &limits, device, reference.as_ref())? {
            failed.push(description.name);
        }
    }

    if failed.is_empty() {
        return print_line("\nEvery device computes right.");
    }
    Err(Error::Device(format!("these devices failed a test: {}", failed.join(", "))))
}

/// Whether the device passed its tests. Errors are those of printing.
fn examine(
    description: &Description,
    limits: &DeviceLimits,
    device: Result<Device>,
    reference: Option<&Film>,
) -> Result<bool> {
    print_line(&format!("\n{}", DeviceInfo::new(description, String::new())))?;
    print_line(&format!(
        "  limits          {} in one binding, {} in one buffer, {} storage buffers, {} workgroups of up to {}",
        bytes(limits.storage_binding),
        bytes(limits.buffer),
        limits.storage_buffers,
        limits.workgroups,
        limits.workgroup_invocations
    ))?;
    let device = match device {
        Ok(device) => device,
        Err(error) => {
            return print_line(&format!("  open            {}", verdict(false, &error.to_string()))).map(|()| false);
        }
    };

    let loops = match probe::loop_cap(&device).map(|cap| cap.turns()) {
        // Rendering copes with a cap: the kernel notices loops that were cut short.
        Ok(Some(turns)) => (true, format!("the driver ends loops after {turns} turns of one invocation; allowed for")),
        Ok(None) => (true, "run as long as they should".to_owned()),
        Err(error) => (false, error.to_string()),
    };
    print_line(&format!("  loops           {}", verdict(loops.0, &loops.1)))?;

    let mut renderer = match GpuRenderer::new(device, GpuOptions::default()) {
        Ok(renderer) => renderer,
        Err(error) => {
            return print_line(&format!("  kernel          {}", verdict(false, &error.to_string()))).map(|()| false);
        }
    };
    let known = known_answer(&mut renderer)?;
    let tile = match (render_tile(&mut renderer), reference) {
        (Ok(tile), Some(reference)) => match compare_tiles(reference, &tile.film) {
            Ok(comparison) => (agrees(&comparison), format!("against the CPU {comparison}")),
            Err(error) => (false, error.to_string()),
        },
        (Ok(_), None) => (false, "nothing to compare with, as the CPU failed".to_owned()),
        (Err(error), _) => (false, error.to_string()),
    };
    print_tile(&verdict(tile.0, &tile.1))?;
    Ok(loops.0 && known && tile.0)
}

/// Whether the renderer gave the known answer. Errors are those of printing.
fn known_answer(renderer: &mut dyn Renderer) -> Result<bool> {
    let (right, text) = match render_known_answer(renderer) {
        Ok(answer) if answer.is_right() => (true, "Lambert's law holds".to_owned()),
        Ok(answer) => (false, format!("expected {:?}, found {:?}", answer.expected, answer.found)),
        Err(error) => (false, error.to_string()),
    };
    print_line(&format!("  known answer    {}", verdict(right, &text)))?;
    Ok(right)
}

fn print_tile(text: &str) -> Result<()> {
    print_line(&format!("  reference tile  {text}"))
}

fn verdict(passed: bool, text: &str) -> String {
    format!("{}: {text}", if passed { "ok" } else { "FAILED" })
}

fn bytes(count: u64) -> String {
    indicatif::BinaryBytes(count).to_string()
}
