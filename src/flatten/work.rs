//! How the splits of a camera ray are shared out over passes, so that one pass is a bounded amount of work.

use crate::layout::Frame;

/// Light samples at depth 0 in one pass.
pub const MAX_LIGHT_SAMPLES: u32 = 64;
/// Glossy reflection rays at depth 0 in one pass: what the stack of rays in `shaders/path.wgsl` holds.
pub const MAX_GLOSSY_SAMPLES: u32 = 4;
/// Light samples at each deeper hit.
pub const MAX_DEEP_LIGHT_SAMPLES: u32 = 8;

/// The work of each pass. Pass i takes the light samples from `i * light_samples` on, as far as there are any.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct WorkPlan {
    pub pass_count: u32,
    /// Shadow rays for each light over all passes.
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

/// Plans `shadow` shadow rays for each of `lights` lights and `glossy` reflected rays, in the fewest passes that keep
/// within [`MAX_LIGHT_SAMPLES`] and [`MAX_GLOSSY_SAMPLES`] each, but no fewer than `min_passes`.
///
/// Asked for twice the passes of a plan that [can be halved](WorkPlan::can_halve), it gives a plan with about half the
/// samples in each pass.
pub fn plan_work(lights: u32, shadow: u32, glossy: u32, min_passes: u32) -> WorkPlan {
    let (shadow, glossy) = (shadow.max(1), glossy.max(1));
    let light_samples = u64::from(lights) * u64::from(shadow);
    let passes = light_samples
        .div_ceil(u64::from(MAX_LIGHT_SAMPLES))
        .max(u64::from(glossy.div_ceil(MAX_GLOSSY_SAMPLES)))
        .max(u64::from(min_passes.max(1)))
        .min(u64::from(u32::MAX));
    WorkPlan {
        pass_count: passes as u32,
        shadow_count: shadow,
        light_samples: light_samples.div_ceil(passes) as u32,
        deep_light_samples: lights.min(MAX_DEEP_LIGHT_SAMPLES),
        glossy_samples: u64::from(glossy).div_ceil(passes) as u32,
    }
}
