//! The functions of `gr`, one file a theme.

mod background;
mod camera;
pub(super) mod images;
mod lights;
mod materials;
mod mesh;
mod nodes;
mod render;
mod settings;
mod shapes;
mod transforms;

use super::arguments::{Call, Context, LightHandle, MaterialHandle, NodeHandle, Outcome, TextureHandle, call};
use super::diagnostics;
use mlua::{AnyUserData, Lua, MetaMethod, MultiValue, Table, UserData, UserDataMethods, Value};

pub(super) use render::{MOST_ARGUMENTS as MOST_RENDER_ARGUMENTS, render};

/// A function of ours: the name that users know it by, how many arguments it takes at most, and what it does.
pub(super) type Function = (&'static str, usize, fn(&Call) -> Outcome<Value>);

/// Where userdata find the table `gr`, whatever the script does to the global.
const GR: &str = "gr";

/// Makes the table `gr` with everything but `render`.
pub(super) fn register(lua: &Lua, context: &Context) -> mlua::Result<Table> {
    let gr = lua.create_table()?;
    let themes = [
        nodes::FUNCTIONS,
        shapes::FUNCTIONS,
        mesh::FUNCTIONS,
        transforms::FUNCTIONS,
        materials::FUNCTIONS,
        images::FUNCTIONS,
        lights::FUNCTIONS,
        background::FUNCTIONS,
        settings::FUNCTIONS,
    ];
    for &(name, most, body) in themes.into_iter().flatten() {
        gr.raw_set(name.trim_start_matches("gr."), function(lua, context, (name, most, body))?)?;
    }
    // `gr` is the metatable of nodes, for scripts that look it up there.
    gr.raw_set("__index", &gr)?;
    remember_missing_names(lua, context, &gr)?;
    lua.set_named_registry_value(GR, &gr)?;
    lua.globals().raw_set("gr", &gr)?;
    Ok(gr)
}

pub(super) fn function(lua: &Lua, context: &Context, (name, most, body): Function) -> mlua::Result<mlua::Function> {
    let context = context.clone();
    lua.create_function(move |lua, arguments: MultiValue| call(lua, &context, name, most, arguments, body))
}

/// A name that `gr` lacks is nil, so that a script can ask whether a function is there; calling it is an error that
/// needs the name for its message.
fn remember_missing_names(lua: &Lua, context: &Context, gr: &Table) -> mlua::Result<()> {
    let context = context.clone();
    let missed = lua.create_function(move |_, (_, key): (Value, Value)| {
        if let Value::String(name) = key {
            context.state.borrow_mut().missed = Some(name.to_string_lossy());
        }
        Ok(Value::Nil)
    })?;
    let meta = lua.create_table()?;
    meta.raw_set("__index", missed)?;
    gr.set_metatable(Some(meta))
}

/// The message of an error as the user should read it: full file names, and a name that `gr` lacks in plain words.
pub(super) fn explain(lua: &Lua, context: &Context, message: &str) -> String {
    let state = context.state.borrow();
    let message = diagnostics::restore_names(message, state.chunks.iter());
    let Some((start, name)) = diagnostics::called_nil(&message) else { return message };
    if state.missed.as_deref() != Some(name) {
        return message;
    }
    let names = function_names(lua);
    format!("{start}{}", diagnostics::no_such_function(name, names.iter().map(String::as_str)))
}

/// The names of the functions in `gr`, those that the script added included.
fn function_names(lua: &Lua) -> Vec<String> {
    let Ok(gr) = lua.named_registry_value::<Table>(GR) else { return Vec::new() };
    let names = gr.pairs::<Value, Value>().filter_map(|pair| match pair {
        Ok((Value::String(name), Value::Function(_))) => Some(name.to_string_lossy()),
        _ => None,
    });
    names.collect()
}

/// Methods of the objects are looked up in `gr`.
fn look_up_in_gr<T, M: UserDataMethods<T>>(methods: &mut M) {
    methods.add_meta_function(MetaMethod::Index, |lua, (_, key): (AnyUserData, Value)| {
        lua.named_registry_value::<Table>(GR)?.get::<Value>(key)
    });
}

macro_rules! scene_object {
    ($handle:ty, $name:literal) => {
        impl UserData for $handle {
            fn add_fields<F: mlua::UserDataFields<Self>>(fields: &mut F) {
                fields.add_meta_field(MetaMethod::Type, $name);
            }

            fn add_methods<M: UserDataMethods<Self>>(methods: &mut M) {
                look_up_in_gr(methods);
            }
        }
    };
}
scene_object!(NodeHandle, "node");
scene_object!(MaterialHandle, "material");
scene_object!(LightHandle, "light");
scene_object!(TextureHandle, "texture");
