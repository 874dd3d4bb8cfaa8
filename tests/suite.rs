//! All tests in one program: one link, and one start of the Vulkan driver.

mod support;

mod analytic;
mod cli;
mod compare;
mod devices;
mod film;
mod gpu;
mod layout;
mod shaders;
mod statistics;
