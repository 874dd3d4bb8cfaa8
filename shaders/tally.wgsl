// What one invocation reports at its end: STATUS_* flags, and rays traced of each RAY_* kind.
struct Tally {
    flags: u32,
    rays: vec4<u32>,
};

var<private> tally: Tally;
