//! All tests in one program: one link, and one start of the Vulkan driver.

mod support;

mod analytic;
mod backgrounds;
mod bump;
mod cli;
mod compare;
mod detail;
mod devices;
mod film;
mod flatten;
mod flatten_tables;
mod function_tables;
mod gpu;
mod images;
mod intersections;
mod layout;
mod lights;
mod loop_cap;
mod math_tables;
mod mist;
mod mist_tables;
mod noise;
mod parameterisation;
mod parity;
mod roots;
mod script;
mod shaders;
mod shading_tables;
mod single_rays;
mod statistics;
mod surfaces;
mod textures;
mod traversal;
mod traversal_gpu;
mod triangles;
