//! Backgrounds.

use super::Function;
use crate::scene::Background;
use crate::script::arguments::{Call, Outcome, TextureHandle};
use crate::script::fields::Fields;
use crate::script::given::{Given, Place};
use mlua::Value;

pub(super) const FUNCTIONS: &[Function] = &[("gr.background", 1, set_background)];

const KEYS: &[&str] = &["colour", "bottom", "top", "image", "transparent"];

/// `gr.background(…)`: what the pictures that follow show where there is nothing.
fn set_background(call: &Call) -> Outcome<Value> {
    let background = background(&call.given(0))?;
    call.state_mut().background = background;
    Ok(Value::Nil)
}

/// A table of `colour`, `bottom` and `top`, or `image`, each with or without `transparent`; a colour; a texture; or
/// the word "transparent". What is not said is as in a scene that says nothing.
pub(super) fn background(given: &Given) -> Outcome<Background> {
    let expected = "a table such as {colour={r, g, b}}, a colour, a texture or \"transparent\"";
    match &given.value {
        Value::String(word) if word.as_bytes() == b"transparent".as_slice() => {
            Ok(Background { transparent: true, ..Background::default() })
        }
        Value::UserData(data) if data.is::<TextureHandle>() => {
            Ok(Background { image: Some(given.image()?), ..Background::default() })
        }
        Value::Table(table) if table.raw_len() > 0 => {
            let colour = given.colour()?;
            Ok(Background { bottom: colour, top: colour, ..Background::default() })
        }
        Value::Table(table) => {
            let prefix = match &given.place {
                Place::Argument(_) => String::new(),
                Place::Key(key) => format!("{key}."),
            };
            from_fields(&Fields::of_table(given.call, table, &prefix, KEYS)?)
        }
        _ => Err(given.unexpected(expected)),
    }
}

fn from_fields(fields: &Fields) -> Outcome<Background> {
    fields.exclude(&[&["colour"], &["bottom", "top"], &["image"]])?;
    let plain = Background::default();
    let colour = fields.get("colour").optional(Given::colour)?;
    Ok(Background {
        bottom: fields.get("bottom").or(colour.unwrap_or(plain.bottom), Given::colour)?,
        top: fields.get("top").or(colour.unwrap_or(plain.top), Given::colour)?,
        image: fields.get("image").optional(Given::image)?,
        transparent: fields.get("transparent").or(false, Given::flag)?,
    })
}
