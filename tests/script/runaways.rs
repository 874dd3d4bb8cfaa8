//! Scripts that would not end, or would take all memory.

use super::{Sandbox, message};
use gpu_trace::script::ScriptOptions;

fn limited() -> Sandbox {
    let mut sandbox = Sandbox::new();
    sandbox.options =
        ScriptOptions { instruction_limit: 3_000_000, memory_limit: 64 << 20, ..ScriptOptions::default() };
    sandbox
}

#[test]
fn endless_loops_end_and_cannot_be_caught() {
    let scripts = [
        "while true do end",
        "while true do pcall(function() while true do end end) end",
        "while true do xpcall(function() while true do end end, function(e) while true do end end) end",
        "local function f() while true do pcall(f) end end f()",
        "while true do coroutine.wrap(function() for i = 1, 100 do end end)() end",
        "while true do coroutine.resume(coroutine.create(function() while true do end end)) end",
        "while true do load(function() while true do end end) end",
        "local t = setmetatable({}, {__index = function(t, k) return t[k + 1] end}) while true do pcall(function() return t[1] end) end",
        "while true do local t <close> = setmetatable({}, {__close = function() while true do end end}) pcall(error) end",
        "for i = 1, 1e12 do gr.translate(gr.node('n'), 1, 2, 3) end",
        "repeat until false",
        "::again:: goto again",
    ];
    for script in scripts {
        let (message, _) = limited().failure(script);
        assert!(
            message
                == "scene.lua:1: the script ran for more than 3000000 Lua instructions and was ended; is there an endless loop?"
                || (message.starts_with("scene.lua:1: the script needs more than 64 MiB")
                    && script.contains("gr.node")),
            "{script}\n gave {message}"
        );
    }
}

#[test]
fn the_place_of_an_endless_loop_is_named() {
    let (message, calls) = limited().failure("local function spin()\n  while true do\n  end\nend\n\nspin()");
    assert!(message.starts_with("scene.lua:2: ") || message.starts_with("scene.lua:3: "), "{message}");
    assert_eq!(calls.len(), 2, "{calls:?}");
    assert_eq!(calls[1], "in the main chunk (scene.lua:6)");
}

#[test]
fn memory_hogs_end_and_cannot_be_caught() {
    let scripts = [
        "local t = {}\nwhile true do t[#t + 1] = {} end",
        "local s = 'x'\nwhile true do s = s .. s end",
        "local s = string.rep('x', 1e9)",
        "while true do pcall(string.rep, 'x', 1e9) end",
        "local t = {}\npcall(function() while true do t[#t + 1] = {} end end) while true do end",
        "while true do coroutine.resume(coroutine.create(function() return string.rep('x', 1e9) end)) end",
    ];
    for script in scripts {
        let mut sandbox = limited();
        sandbox.options.instruction_limit = 100_000_000;
        let (message, _) = sandbox.failure(script);
        assert!(
            message.contains("the script needs more than 64 MiB of memory and was ended"),
            "{script}\n gave {message}"
        );
    }
}

#[test]
fn the_place_of_a_memory_hog_is_named() {
    let mut sandbox = limited();
    sandbox.options.instruction_limit = 100_000_000;
    let (message, _) = sandbox.failure("\nlocal t = {}\nfor i = 1, 1e7 do t[i] = {i} end");
    assert_eq!(message, "scene.lua:3: the script needs more than 64 MiB of memory and was ended");
}

#[test]
fn nodes_and_meshes_count_as_memory() {
    let mut sandbox = Sandbox::new();
    sandbox.options =
        ScriptOptions { instruction_limit: 1_000_000_000, memory_limit: 4 << 20, ..ScriptOptions::default() };
    for script in [
        "for i = 1, 1e7 do gr.node('n') end",
        "local a, b = gr.node('a'), gr.node('b') for i = 1, 1e8 do a:add_child(b) end",
        "for i = 1, 1e7 do gr.material({1,1,1}, {0,0,0}, 1) end",
    ] {
        let (message, _) = sandbox.failure(script);
        assert!(message.starts_with("scene.lua:1: the script needs more than 4 MiB of memory"), "{script}: {message}");
    }
}

#[test]
fn the_default_limits_leave_room_for_a_million_triangles() {
    let summary = Sandbox::new()
        .run(
            "gr.conventions{transforms='pre'}
             local n, verts, faces = 708, {}, {}
             for i = 0, n do for j = 0, n do verts[#verts + 1] = {i, math.sin(i * j * 0.001), j} end end
             for i = 0, n - 1 do for j = 0, n - 1 do
               local k = i * (n + 1) + j
               faces[#faces + 1] = {k, k + 1, k + n + 1}
               faces[#faces + 1] = {k + 1, k + n + 2, k + n + 1}
             end end
             gr.mesh('field', verts, faces)",
        )
        .unwrap();
    assert_eq!(summary.warnings, [""; 0]);
}

#[test]
fn finalisers_which_no_limit_holds_are_refused() {
    assert_eq!(
        message("setmetatable({}, {__gc = function() while true do end end})"),
        "scene.lua:1: setmetatable: scenes cannot have finalisers (__gc)"
    );
    assert!(limited().run("local m = getmetatable(io.open('scene.lua')) assert(m == nil)").is_ok());
}
