//! A value that a script gave, and where: the same checks serve arguments and the keys of tables.

use super::api::images;
use super::arguments::{BadElement, Call, Failure, MaterialHandle, NodeHandle, Outcome, TextureHandle, finite, tuple};
use crate::scene::{Image, MaterialId, NodeId};
use glam::{DVec3, Vec3};
use mlua::{Table, Value};
use std::sync::Arc;

/// Where a value stood, for messages.
#[derive(Clone, Debug)]
pub(super) enum Place {
    /// Counted from 0.
    Argument(usize),
    /// With the keys of the tables around it: `camera.eye`.
    Key(String),
}

#[derive(Clone)]
pub(super) struct Given<'a> {
    pub call: &'a Call<'a>,
    pub value: Value,
    pub place: Place,
    /// It has no default: nil is a value like any other, and usually a wrong one.
    pub required: bool,
}

impl Given<'_> {
    /// Whether it was left out and may be.
    pub fn absent(&self) -> bool {
        self.value.is_nil() && !self.required
    }

    /// What `read` makes of it, or `default` where it was left out.
    pub fn or<T>(&self, default: T, read: impl FnOnce(&Self) -> Outcome<T>) -> Outcome<T> {
        if self.absent() { Ok(default) } else { read(self) }
    }

    /// What `read` makes of it, if it is there.
    pub fn optional<T>(&self, read: impl FnOnce(&Self) -> Outcome<T>) -> Outcome<Option<T>> {
        self.or(None, |given| read(given).map(Some))
    }

    pub fn is_argument(&self) -> bool {
        matches!(self.place, Place::Argument(_))
    }

    pub fn fail(&self, message: String) -> Failure {
        match &self.place {
            Place::Argument(index) => Failure::Argument { index: *index, message },
            Place::Key(key) => Failure::Key { key: key.clone(), message },
        }
    }

    /// The failure of a value that is not what was `expected`.
    pub fn unexpected(&self, expected: &str) -> Failure {
        self.fail(format!("expected {expected}, got {}", self.call.describe(&self.value)))
    }

    pub fn text(&self, expected: &str) -> Outcome<String> {
        match &self.value {
            Value::String(text) => Ok(text.to_string_lossy()),
            Value::Integer(number) => Ok(number.to_string()),
            Value::Number(number) => Ok(number.to_string()),
            _ => Err(self.unexpected(expected)),
        }
    }

    /// A number for which `check` holds; `expected` says so in words.
    pub fn number_where(&self, expected: &str, check: impl Fn(f64) -> bool) -> Outcome<f64> {
        match finite(self.call.lua, &self.value) {
            Some(number) if check(number) => Ok(number),
            _ => Err(self.unexpected(expected)),
        }
    }

    pub fn whole_number(&self, expected: &str, least: u32, most: u32) -> Outcome<u32> {
        let range = f64::from(least)..=f64::from(most);
        self.number_where(expected, |number| number.fract() == 0.0 && range.contains(&number))
            .map(|number| number as u32)
    }

    pub fn flag(&self) -> Outcome<bool> {
        match self.value {
            Value::Boolean(flag) => Ok(flag),
            _ => Err(self.unexpected("true or false")),
        }
    }

    pub fn table(&self, expected: &str) -> Outcome<&Table> {
        match &self.value {
            Value::Table(table) => Ok(table),
            _ => Err(self.unexpected(expected)),
        }
    }

    /// A table of exactly `N` numbers.
    pub fn tuple<const N: usize>(&self) -> Outcome<[f64; N]> {
        let expected = format!("a table of {N} numbers");
        let table = self.table(&expected)?;
        tuple(self.call.lua, table).map_err(|got: BadElement| {
            self.fail(format!("expected {expected}, got {}", self.call.describe_element(got)))
        })
    }

    pub fn vector(&self) -> Outcome<DVec3> {
        Ok(DVec3::from_array(self.tuple()?))
    }

    pub fn colour(&self) -> Outcome<Vec3> {
        Ok(self.vector()?.as_vec3())
    }

    pub fn node(&self) -> Outcome<NodeId> {
        match &self.value {
            Value::UserData(data) => data.borrow::<NodeHandle>().map(|handle| handle.0).ok(),
            _ => None,
        }
        .ok_or_else(|| self.unexpected("a node"))
    }

    pub fn material(&self) -> Outcome<MaterialId> {
        match &self.value {
            Value::UserData(data) => data.borrow::<MaterialHandle>().map(|handle| handle.0).ok(),
            _ => None,
        }
        .ok_or_else(|| self.unexpected("a material"))
    }

    /// What `gr.texture` returned, or the image of that file name.
    pub fn image(&self) -> Outcome<Arc<Image>> {
        let texture = match &self.value {
            Value::String(name) => return images::load(self, &name.to_string_lossy()),
            Value::UserData(data) => data.borrow::<TextureHandle>().map(|handle| Arc::clone(&handle.0)).ok(),
            _ => None,
        };
        texture.ok_or_else(|| self.unexpected("a texture or the name of an image"))
    }
}
