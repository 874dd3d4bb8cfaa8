//! All tests in one program: one link, and one start of the Vulkan driver.

mod support;

mod analytic;
mod flatten;
mod flatten_tables;
mod gpu;
mod layout;
mod shaders;
mod statistics;
mod surfaces;
mod traversal;
mod traversal_gpu;
