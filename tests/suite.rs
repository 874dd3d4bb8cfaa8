//! All tests in one program: one link, and one start of the Vulkan driver.

mod support;

mod analytic;
mod devices;
mod gpu;
mod layout;
mod loop_cap;
mod parity;
mod shaders;
mod single_rays;
mod statistics;
