//! Finding devices, choosing among them, and what there is to read where none is.

use gpu_trace::Error;
use gpu_trace::gpu::{Device, DeviceKind, DeviceSelector, list_adapters, probe};

#[test]
fn devices_are_chosen_by_kind_and_name() {
    let adapters = list_adapters();
    let (best, _) = adapters.first().unwrap_or_else(|| panic!("no device; see `tests/run`"));
    assert!(adapters.is_sorted_by_key(|(description, _)| description.kind));
    let any = Device::open(&DeviceSelector::Any).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(any.description(), best);
    let kind_of = |selector| Device::open(&selector).map(|device| device.description().kind);
    let has_hardware = adapters.iter().any(|(description, _)| description.kind != DeviceKind::Software);
    let has_software = adapters.iter().any(|(description, _)| description.kind == DeviceKind::Software);
    assert_eq!(kind_of(DeviceSelector::Hardware).is_ok_and(|kind| kind != DeviceKind::Software), has_hardware);
    assert_eq!(kind_of(DeviceSelector::Software).is_ok_and(|kind| kind == DeviceKind::Software), has_software);

    let named = Device::open(&DeviceSelector::Named(best.name.to_uppercase())).unwrap();
    assert_eq!(named.description().name, best.name);
    let error = Device::open(&DeviceSelector::Named("no such device".into())).unwrap_err().to_string();
    assert!(error.contains("no such device") && error.contains(&best.name), "{error}");
}

#[test]
fn every_listed_device_opens_and_counts_loop_turns() {
    let devices = Device::open_each();
    assert_eq!(devices.len(), list_adapters().len());
    assert!(!devices.is_empty(), "no device; see `tests/run`");
    for (description, limits, device) in devices {
        let device = device.unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(device.limits().storage_binding, limits.storage_binding, "{description}");
        let cap = probe::loop_cap(&device).unwrap();
        assert_eq!((cap.single.expected, cap.nested.expected), (100_000, 600_000));
        assert!(cap.single.made <= 100_000 && cap.nested.made <= 600_000, "{description}: {cap:?}");
        assert!(cap.single.made >= 65_535 && cap.nested.made >= 54_000, "{description}: {cap:?}");
    }
}

/// What a machine without a driver, and one without the Vulkan loader, gets to read.
#[test]
#[cfg(target_os = "linux")]
fn without_vulkan_the_error_says_how_to_install_it() {
    let folder = tempfile::tempdir().unwrap();
    // The loader finds no driver; or what is found as the loader is no library.
    std::fs::write(folder.path().join("libvulkan.so.1"), "").unwrap();
    let no_driver = [("VK_DRIVER_FILES", "/nonexistent.json"), ("VK_ICD_FILENAMES", "/nonexistent.json")];
    let no_loader = [("LD_LIBRARY_PATH", folder.path().to_str().unwrap())];
    for environment in [&no_driver[..], &no_loader[..]] {
        // The name of the test below as the test program knows it, without the name of the program.
        let (_, module) = module_path!().split_once("::").expect("a module of the test program");
        let output = std::process::Command::new(std::env::current_exe().unwrap())
            .args([&format!("{module}::the_error_of_a_machine_without_vulkan"), "--exact", "--nocapture"])
            .env(HIDDEN, "1")
            .envs(environment.iter().copied())
            .output()
            .unwrap();
        let text = String::from_utf8_lossy(&output.stdout) + String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success() && text.contains("1 passed"), "{environment:?}: {text}");
    }
}

/// Set where Vulkan is hidden from the process.
const HIDDEN: &str = "GPU_TRACE_TEST_WITHOUT_VULKAN";

/// Run by the test above in a process whose environment hides Vulkan; anywhere else there has to be a device.
#[test]
fn the_error_of_a_machine_without_vulkan() {
    let hidden = std::env::var_os(HIDDEN).is_some();
    for selector in [DeviceSelector::Any, DeviceSelector::Named("llvmpipe".into())] {
        match Device::open(&selector) {
            Err(Error::Device(message)) => {
                assert!(hidden || selector != DeviceSelector::Any, "{message}");
                assert!(!hidden || message.contains("apt-get install mesa-vulkan-drivers libvulkan1"), "{message}");
            }
            Ok(device) => assert!(!hidden, "{} was found", device.description()),
            Err(other) => panic!("{other:?}"),
        }
    }
    assert_eq!(list_adapters().is_empty(), hidden);
}
