//! How the splits of a camera ray are shared out over passes, so that one pass is a bounded amount of work.

use crate::layout::Frame;

/// Light samples at depth 0 in one pass.
pub const MAX_LIGHT_SAMPLES: u32 = 64;
/// Glossy reflection rays at depth 0 in one pass: what the stack of rays in `shaders/path.wgsl` holds.
pub const MAX_GLOSSY_SAMPLES: u32 = 4;
/// Light samples at each deeper hit.
pub const MAX_DEEP_LIGHT_SAMPLES: u32 = 8;

/// What a pass costs beside its shadow rays, in shadow rays: the camera ray, and the tree of rays under it.
const PASS_COST: u64 = 4;

/// The work of each pass; `light_samples * pass_count == lights * shadow_count`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct WorkPlan {
    pub pass_count: u32,
    /// Shadow rays for each light over all passes: what was asked for, or more where the passes need it.
    pub shadow_count: u32,
    pub light_samples: u32,
    pub deep_light_samples: u32,
    pub glossy_samples: u32,
}

impl WorkPlan {
    /// Whether more passes would make each pass smaller.
    pub fn can_halve(&self) -> bool {
        self.light_samples > 1 || self.glossy_samples > 1
    }

    pub fn applied_to(&self, frame: Frame) -> Frame {
        Frame {
            pass_count: self.pass_count,
            shadow_count: self.shadow_count,
            light_samples: self.light_samples,
            deep_light_samples: self.deep_light_samples,
            glossy_samples: self.glossy_samples,
            ..frame
        }
    }
}

/// Plans `shadow` shadow rays for each of `lights` lights and `glossy` reflected rays, in at least `min_passes` passes.
///
/// Every pass takes the same number of light samples, at most [`MAX_LIGHT_SAMPLES`] and at most an even share of what
/// was asked for, and of all such plans the one with the least work is taken. Several lights with no common divisor
/// can make it necessary to round `shadow` up.
pub fn plan_work(lights: u32, shadow: u32, glossy: u32, min_passes: u32) -> WorkPlan {
    let min_passes = u64::from(min_passes.max(1));
    let (lights, shadow, glossy) = (u64::from(lights), u64::from(shadow.max(1)), u64::from(glossy.max(1)));
    let max_glossy = glossy.div_ceil(min_passes).min(u64::from(MAX_GLOSSY_SAMPLES));
    let least_passes = min_passes.max(glossy.div_ceil(max_glossy));
    let max_samples = (lights * shadow).div_ceil(min_passes).min(u64::from(MAX_LIGHT_SAMPLES));
    let plans = (1..=max_samples).map(|samples| {
        // The smallest count whose samples fill whole passes.
        let step = samples / greatest_common_divisor(samples, lights);
        let count = shadow.max((least_passes * samples).div_ceil(lights)).next_multiple_of(step);
        let passes = lights * count / samples;
        (passes * PASS_COST + lights * count, passes, count, samples)
    });
    let (_, passes, count, samples) = plans.min().unwrap_or((0, least_passes, shadow, 0));
    WorkPlan {
        pass_count: clamp(passes),
        shadow_count: clamp(count),
        light_samples: clamp(samples),
        deep_light_samples: clamp(lights.min(u64::from(MAX_DEEP_LIGHT_SAMPLES))),
        glossy_samples: clamp(glossy.div_ceil(passes)),
    }
}

fn greatest_common_divisor(a: u64, b: u64) -> u64 {
    if b == 0 { a } else { greatest_common_divisor(b, a % b) }
}

fn clamp(value: u64) -> u32 {
    u32::try_from(value).unwrap_or(u32::MAX)
}
