//! What `gpu-trace doctor` finds out about devices.
