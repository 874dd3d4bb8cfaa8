//! All tests in one program: one link, and one start of the Vulkan driver.

mod suite {
    mod script;
}
