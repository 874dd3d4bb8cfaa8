//! What a scene cannot reach, and what older scenes still find.

use super::{RENDER, Sandbox, message, only_scene};
use gpu_trace::script::ScriptOptions;

#[test]
fn escapes_are_refused() {
    for (script, expected) in [
        ("os.execute('true')", "os.execute: not available to scenes"),
        ("os.exit()", "os.exit: not available to scenes"),
        ("os.remove('scene.lua')", "os.remove: not available to scenes"),
        ("os.rename('scene.lua', 'x')", "os.rename: not available to scenes"),
        ("os.tmpname()", "os.tmpname: not available to scenes"),
        ("io.popen('ls')", "io.popen: not available to scenes"),
        ("io.tmpfile()", "io.tmpfile: not available to scenes"),
        ("io.output('x')", "io.output: not available to scenes"),
        ("io.open('x', 'w')", "io.open: scenes read files and write none (mode 'w')"),
        ("io.open('scene.lua', 'r+')", "io.open: scenes read files and write none (mode 'r+')"),
        ("io.open('scene.lua', 'a')", "io.open: scenes read files and write none (mode 'a')"),
        ("package.loadlib('libc.so.6', '*')", "package.loadlib: not available to scenes"),
        ("string.dump(function() end)", "string.dump: not available to scenes"),
        ("debug.sethook()", "debug.sethook: not available to scenes"),
        ("debug.getregistry()", "debug.getregistry: not available to scenes"),
        ("error((select(2, load('\\27Lua'))), 0)", "attempt to load a binary chunk (mode is 't')"),
        ("error((select(2, load('\\27Lua', 'x', 'b'))), 0)", "attempt to load a binary chunk (mode is 't')"),
    ] {
        assert_eq!(message(script), format!("scene.lua:1: {expected}"), "{script}");
    }
}

#[test]
fn bytecode_files_are_refused() {
    let sandbox = Sandbox::new();
    sandbox.write("code.lua", b"\x1bLuaT\x00");
    for script in ["dofile('code.lua')", "require('code')", "assert(loadfile('code.lua'))"] {
        let (message, _) = sandbox.failure(script);
        assert!(message.contains("attempt to load a binary chunk"), "{script}: {message}");
    }
}

#[test]
fn files_outside_the_scenes_folders_are_refused() {
    let sandbox = Sandbox::new();
    let secret = sandbox.root.path().join("secret.txt");
    std::fs::write(&secret, "secret").unwrap();
    std::fs::write(sandbox.root.path().join("secret.lua"), "leaked = true").unwrap();
    for name in ["../../../../secret.txt", secret.to_str().unwrap(), "/etc/passwd", "/etc/../etc/passwd"] {
        let (message, _) = sandbox.failure(&format!("error(select(2, io.open('{name}')), 0)"));
        assert!(message.contains("outside the scene's folders"), "{name}: {message}");
        let (message, _) = sandbox.failure(&format!("for line in io.lines('{name}') do end"));
        assert!(message.starts_with("scene.lua:1: io.lines: '"), "{name}: {message}");
    }
    let (message, _) = sandbox.failure("dofile('../../../../secret.lua')");
    assert!(
        message.starts_with("scene.lua:1: dofile: '../../../../secret.lua' is outside the scene's folders"),
        "{message}"
    );
    let (message, _) = sandbox.failure("package.path = '../../../../?.lua'\nrequire('secret')");
    assert!(
        message.starts_with("scene.lua:2: require: no module 'secret': '../../../../secret.lua' is outside"),
        "{message}"
    );
    // Two folders up is still the scene's own.
    std::fs::write(sandbox.folder().join("../../near.txt"), "near").unwrap();
    assert!(sandbox.run("assert(io.open('../../near.txt'):read('a') == 'near')").is_ok());
}

#[cfg(unix)]
#[test]
fn links_out_of_the_folders_are_refused() {
    let sandbox = Sandbox::new();
    std::os::unix::fs::symlink("/etc/passwd", sandbox.folder().join("link")).unwrap();
    let (message, _) = sandbox.failure("error(select(2, io.open('link')), 0)");
    assert!(message.contains("outside the scene's folders"), "{message}");
}

#[test]
fn files_inside_are_read() {
    let sandbox = Sandbox::new();
    sandbox.write("data.txt", "1\n2\n3\n");
    sandbox.write("Assets/more.txt", "deep");
    let script = "local sum = 0
        for line in io.lines('data.txt') do sum = sum + line end
        assert(sum == 6)
        local file = io.open('data.txt', 'rb')
        assert(file:read('n') == 1 and io.type(file) == 'file')
        assert(not file:write('x'))
        io.close(file)
        assert(io.open('more.txt'):read('a') == 'deep')
        assert(io.open('nowhere.txt') == nil)";
    sandbox.run(script).unwrap();
    assert_eq!(std::fs::read_to_string(sandbox.folder().join("data.txt")).unwrap(), "1\n2\n3\n");
}

#[test]
fn modules_are_run_once_and_files_each_time() {
    let sandbox = Sandbox::new();
    sandbox.write("parts/wheel.lua", "#!lua\nruns = (runs or 0) + 1\nreturn { spokes = 8 }");
    sandbox.write("kit/init.lua", "return 'kit'");
    sandbox.write("again.lua", "times = (times or 0) + 1 return times");
    sandbox
        .run(
            "assert(require('parts.wheel').spokes == 8 and require('parts.wheel').spokes == 8 and runs == 1)
             assert(require('kit') == 'kit')
             assert(dofile('again.lua') == 1 and dofile('again.lua') == 2)
             package.path = 'parts/?.lua;' .. package.path
             assert(require('wheel').spokes == 8 and runs == 2)
             package.preload.made = function() return 'made' end
             assert(require('made') == 'made' and require('math') == math)
             assert(loadfile('missing.lua') == nil)",
        )
        .unwrap();
    sandbox.write("broken.lua", "\nlocal = 1");
    assert_eq!(sandbox.failure("require('broken')").0, "broken.lua:2: <name> expected near '='");
    sandbox.write("failing.lua", "local function inner()\n  gr.node()\nend\ninner()");
    let (message, calls) = sandbox.failure("require('failing')");
    assert_eq!(message, "failing.lua:2: gr.node: argument 1: expected a name, got nil");
    assert_eq!(
        calls,
        ["in upvalue 'inner' (failing.lua:2)", "in the main chunk (failing.lua:4)", "in the main chunk (scene.lua:1)"]
            .map(|call| call.replace("upvalue", "function"))
    );
}

#[test]
fn older_luas_are_understood() {
    let script = "#!/usr/bin/gpu-trace
        assert(table.getn({1, 2, 3}) == 3 and unpack({4, 5}) == 4 and math.pow(2, 3) == 8 and math.mod(7, 4) == 3)
        for word in string.gfind('one two', '%a+') do last = word end
        assert(last == 'two' and loadstring('return 5')() == 5 and math.log10(1000) > 2.999)
        local r = math.random(1.5, 3.5) assert(r >= 1 and r <= 3)
        table.foreach({a = 1}, function(k, v) assert(k == 'a' and v == 1) end)
        assert(os.time() > 0 and os.clock() >= 0 and os.getenv('HOME') == nil)
        assert(debug.traceback('m') == 'm' and debug.getinfo(1).source:match('scene%.lua$'))
        print('to', 'stderr') io.write('and ', 1, '\\n') io.stdout:write('this\\n')";
    assert_eq!(Sandbox::new().run(script).unwrap().pictures, 0);
}

#[test]
fn random_numbers_depend_on_the_seed_alone() {
    let numbers = |seed, again: &str| {
        let mut sandbox = Sandbox::new();
        sandbox.options = ScriptOptions { seed, ..ScriptOptions::default() };
        let script =
            format!("{again} root = gr.node(tostring(math.random()) .. tostring(math.random(1000000))) {RENDER}");
        sandbox.load(&script).unwrap()[0].graph.nodes[0].name.clone()
    };
    assert_eq!(numbers(1, ""), numbers(1, ""));
    assert_eq!(numbers(1, ""), numbers(1, "math.random() math.randomseed()"));
    assert_ne!(numbers(1, ""), numbers(2, ""));
}

#[test]
fn coroutines_work_across_pcall() {
    let scene = only_scene(&format!(
        "local make = coroutine.wrap(function()
           pcall(function() for i = 1, 3 do coroutine.yield(gr.node('n' .. i)) end end)
         end)
         root = make() root:add_child(make()) root:add_child(make()) {RENDER}"
    ));
    assert_eq!(scene.graph.node(scene.root).children.len(), 2);
}
