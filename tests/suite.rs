//! All tests in one program: one link, and one start of the Vulkan driver.

mod support;

mod suite {
    mod function_tables;
    mod intersections;
    mod math_tables;
    mod roots;
    mod triangles;
}
