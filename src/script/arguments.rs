//! Reads and checks the arguments of a `gr.*` call.
//!
//! Arguments are counted as they stand between the parentheses: in `gr.scale(node, 2, 2, 0)` the bad one is argument
//! 4, in `node:scale(2, 2, 0)` argument 3, as Lua itself counts for methods.

use super::diagnostics::{self, Raised};
use super::given::{Given, Place};
use super::guard::{CALL_COST, Guard};
use super::state::State;
use crate::scene::{Image, Light, MaterialId, NodeId};
use mlua::{AnyUserData, Lua, MultiValue, Table, Value};
use std::cell::{Ref, RefCell, RefMut};
use std::rc::Rc;
use std::sync::Arc;

/// What every function of ours works on.
#[derive(Clone)]
pub(super) struct Context {
    pub state: Rc<RefCell<State>>,
    pub guard: Rc<Guard>,
}

/// What `gr.node` and the shapes return.
pub(super) struct NodeHandle(pub NodeId);
/// What `gr.material` and its kin return.
pub(super) struct MaterialHandle(pub MaterialId);
/// What `gr.light` and its kin return.
pub(super) struct LightHandle(pub Light);
/// What `gr.texture` returns.
pub(super) struct TextureHandle(pub Arc<Image>);

/// Why a call failed.
pub(super) enum Failure {
    /// An argument, counted from 0, is not what it should be.
    Argument { index: usize, message: String },
    /// The value under a key of a table is not what it should be.
    Key { key: String, message: String },
    /// Anything else that the message alone explains.
    Call(String),
    /// To be passed on as it is.
    Lua(mlua::Error),
}

impl From<mlua::Error> for Failure {
    fn from(error: mlua::Error) -> Self {
        Failure::Lua(error)
    }
}

pub(super) type Outcome<T> = Result<T, Failure>;

/// One call of one of our functions.
pub(super) struct Call<'a> {
    pub lua: &'a Lua,
    pub context: &'a Context,
    arguments: Vec<Value>,
}

/// Runs `body` on a call of the function that users know as `name`, which takes at most `most` arguments, and turns a
/// failure into a Lua error that names the place.
pub(super) fn call(
    lua: &Lua,
    context: &Context,
    name: &'static str,
    most: usize,
    arguments: MultiValue,
    body: impl FnOnce(&Call) -> Outcome<Value>,
) -> mlua::Result<Value> {
    context.guard.check()?;
    context.guard.charge_instructions(lua, CALL_COST)?;
    let call = Call { lua, context, arguments: arguments.into_iter().collect() };
    call.warn_of_surplus(name, most);
    body(&call).map_err(|failure| call.raise(name, failure))
}

impl Call<'_> {
    pub fn state(&self) -> Ref<'_, State> {
        self.context.state.borrow()
    }

    pub fn state_mut(&self) -> RefMut<'_, State> {
        self.context.state.borrow_mut()
    }

    fn warn_of_surplus(&self, name: &'static str, most: usize) {
        if self.arguments.iter().skip(most).any(|value| !value.is_nil()) && self.state_mut().surplus.insert(name) {
            self.state_mut().warn(
                self.lua,
                &format!(
                    "{name} takes at most {most} argument{}; the others are ignored (said once for each function)",
                    if most == 1 { "" } else { "s" }
                ),
            );
        }
    }

    fn raise(&self, name: &str, failure: Failure) -> mlua::Error {
        let place = diagnostics::place(self.lua).map_or_else(String::new, |place| format!("{place}: "));
        let message = match failure {
            Failure::Lua(error) => return error,
            Failure::Call(message) => format!("{place}{name}: {message}"),
            Failure::Key { key, message } => format!("{place}{name}: key '{key}': {message}"),
            Failure::Argument { index, message } => {
                let method = self.lua.inspect_stack(0, |debug| debug.names().name_what == Some("method"));
                match (method == Some(true), index) {
                    (false, index) => format!("{place}{name}: argument {}: {message}", index + 1),
                    (true, 0) => {
                        let short = name.strip_prefix("gr.").unwrap_or(name);
                        format!("{place}{name}: called with ':' on something else: {message}; write gr.{short}(…)")
                    }
                    (true, index) => format!("{place}{name}: argument {index}: {message}"),
                }
            }
        };
        mlua::Error::external(Raised { message })
    }

    pub fn value(&self, index: usize) -> &Value {
        self.arguments.get(index).unwrap_or(&Value::Nil)
    }

    /// How many arguments there are, trailing nils included.
    pub fn count(&self) -> usize {
        self.arguments.len()
    }

    /// Whether the argument was left out or is nil.
    pub fn absent(&self, index: usize) -> bool {
        self.value(index).is_nil()
    }

    /// An argument that has no default.
    pub fn given(&self, index: usize) -> Given<'_> {
        Given { call: self, value: self.value(index).clone(), place: Place::Argument(index), required: true }
    }

    /// The failure of an argument that is not what was `expected`.
    pub fn unexpected(&self, index: usize, expected: &str) -> Failure {
        self.given(index).unexpected(expected)
    }

    pub fn text(&self, index: usize, expected: &str) -> Outcome<String> {
        self.given(index).text(expected)
    }

    pub fn name(&self, index: usize) -> Outcome<String> {
        self.text(index, "a name")
    }

    /// A finite number that single precision can hold.
    pub fn number(&self, index: usize) -> Outcome<f64> {
        self.number_where(index, "a number", |_| true)
    }

    /// A number for which `check` holds; `expected` says so in words.
    pub fn number_where(&self, index: usize, expected: &str, check: impl Fn(f64) -> bool) -> Outcome<f64> {
        self.given(index).number_where(expected, check)
    }

    pub fn table(&self, index: usize, expected: &str) -> Outcome<&Table> {
        match self.value(index) {
            Value::Table(table) => Ok(table),
            _ => Err(self.unexpected(index, expected)),
        }
    }

    /// A table of exactly `N` numbers.
    pub fn tuple<const N: usize>(&self, index: usize) -> Outcome<[f64; N]> {
        self.given(index).tuple()
    }

    pub fn node(&self, index: usize) -> Outcome<NodeId> {
        self.given(index).node()
    }

    /// A value in the words of a message.
    pub fn describe(&self, value: &Value) -> String {
        match value {
            Value::Nil => "nil".to_owned(),
            Value::Boolean(truth) => truth.to_string(),
            Value::Integer(number) => number.to_string(),
            Value::Number(number) => number.to_string(),
            Value::String(text) => {
                let text = text.to_string_lossy();
                let start: String = text.chars().take(40).collect();
                if start.len() < text.len() { format!("the text '{start}…'") } else { format!("the text '{text}'") }
            }
            Value::Table(table) => match table.raw_len() {
                0 if table.is_empty() => "an empty table".to_owned(),
                0 => "a table with names".to_owned(),
                1 => "a table of 1 value".to_owned(),
                count => format!("a table of {count} values"),
            },
            Value::UserData(data) => self.describe_handle(data),
            other => format!("a {}", other.type_name()),
        }
    }

    fn describe_handle(&self, data: &AnyUserData) -> String {
        if let Ok(handle) = data.borrow::<NodeHandle>() {
            format!("the node '{}'", self.state().graph().node(handle.0).name)
        } else if data.is::<MaterialHandle>() {
            "a material".to_owned()
        } else if data.is::<LightHandle>() {
            "a light".to_owned()
        } else if data.is::<TextureHandle>() {
            "a texture".to_owned()
        } else {
            "a foreign object".to_owned()
        }
    }

    pub fn describe_element(&self, got: BadElement) -> String {
        match got {
            BadElement::Count(1) => "1 value".to_owned(),
            BadElement::Count(count) => format!("{count} values"),
            BadElement::Value(position, value) => format!("{} at [{position}]", self.describe(&value)),
        }
    }
}

/// What is wrong with a tuple.
pub(super) enum BadElement {
    Count(usize),
    /// At this position, counted from 1 as in Lua.
    Value(usize, Value),
}

/// Exactly `N` finite numbers from the sequence part of a table, without metamethods.
pub(super) fn tuple<const N: usize>(lua: &Lua, table: &Table) -> Result<[f64; N], BadElement> {
    let count = table.raw_len();
    if count != N {
        return Err(BadElement::Count(count));
    }
    let mut numbers = [0.0; N];
    for (position, number) in (1..).zip(&mut numbers) {
        let value = table.raw_get::<Value>(position).unwrap_or(Value::Nil);
        *number = finite(lua, &value).ok_or(BadElement::Value(position, value))?;
    }
    Ok(numbers)
}

/// The number that a value is, or that a text spells, if single precision can hold it.
pub(super) fn finite(lua: &Lua, value: &Value) -> Option<f64> {
    let number = match value {
        Value::Integer(number) => *number as f64,
        Value::Number(number) => *number,
        Value::String(_) => lua.coerce_number(value.clone()).ok().flatten()?,
        _ => return None,
    };
    (number as f32).is_finite().then_some(number)
}
