//! The named values that describe an object: the keys of a table, or arguments under the names of those keys. What is
//! built from them need not know which.

use super::arguments::{Call, Failure, Outcome};
use super::diagnostics::nearest;
use super::given::{Given, Place};
use mlua::{Table, Value};

/// Other spellings of keys.
const SPELLINGS: &[(&str, &str)] = &[("color", "colour")];

pub(super) struct Fields<'a> {
    call: &'a Call<'a>,
    /// Before the names of keys in messages: `camera.` in `gr.render{camera={…}}`.
    prefix: String,
    given: Vec<(&'static str, Given<'a>)>,
}

impl<'a> Fields<'a> {
    /// The arguments under these names, of which the first `required` have no defaults.
    pub fn of_arguments(call: &'a Call<'a>, names: &[&'static str], required: usize) -> Self {
        let given = names.iter().enumerate().map(|(index, name)| {
            let place = Place::Argument(index);
            (*name, Given { call, value: call.value(index).clone(), place, required: index < required })
        });
        Fields { call, prefix: String::new(), given: given.collect() }
    }

    /// The values of a table, all of whose keys are `known`, without metamethods.
    pub fn of_table(call: &'a Call<'a>, table: &Table, prefix: &str, known: &[&'static str]) -> Outcome<Self> {
        let mut fields = Fields { call, prefix: prefix.to_owned(), given: Vec::new() };
        let mut unknown = Vec::new();
        for pair in table.pairs::<Value, Value>() {
            let (key, value) = pair?;
            match fields.known_key(&key, known) {
                Ok(key) if fields.given.iter().any(|(name, _)| *name == key) => {
                    return Err(Failure::Call(format!("key '{prefix}{key}' is given in two spellings")));
                }
                Ok(key) => {
                    let place = Place::Key(format!("{prefix}{key}"));
                    fields.given.push((key, Given { call, value, place, required: false }));
                }
                Err(message) => unknown.push(message),
            }
        }
        // Lua gives the keys in an order of its own, which changes.
        match unknown.into_iter().min() {
            Some(message) => Err(Failure::Call(message)),
            None => Ok(fields),
        }
    }

    /// The only argument, where it is a table of named values.
    pub fn of_only_argument(call: &'a Call<'a>, known: &[&'static str]) -> Option<Outcome<Self>> {
        let table = only_table(call)?;
        Some(Self::of_table(call, table, "", known))
    }

    /// The named values of the table under a key; all left out where the key is.
    pub fn inner(&self, key: &'static str, known: &[&'static str]) -> Outcome<Fields<'a>> {
        let given = self.get(key);
        let prefix = format!("{}{key}.", self.prefix);
        if given.absent() {
            return Ok(Fields { call: self.call, prefix, given: Vec::new() });
        }
        let table = given.table(&format!("a table with any of {}", known.join(", ")))?;
        Self::of_table(self.call, table, &prefix, known)
    }

    fn known_key(&self, key: &Value, known: &[&'static str]) -> Result<&'static str, String> {
        let list = || known.iter().map(|name| format!("'{name}'")).collect::<Vec<_>>().join(", ");
        let Value::String(text) = key else {
            return Err(format!("values in the table need names; known are {}", list()));
        };
        let text = text.to_string_lossy();
        let prefix = &self.prefix;
        let name = SPELLINGS.iter().find(|(other, _)| *other == text).map_or(text.as_str(), |(_, ours)| *ours);
        if let Some(known) = known.iter().find(|known| **known == name) {
            return Ok(*known);
        }
        Err(match nearest(name, known.iter().copied()) {
            Some(near) => format!("unknown key '{prefix}{text}'; did you mean '{prefix}{near}'?"),
            None => format!("unknown key '{prefix}{text}'; known are {}", list()),
        })
    }

    pub fn get(&self, key: &'static str) -> Given<'a> {
        let given = self.given.iter().find(|(name, _)| *name == key).map(|(_, given)| given.clone());
        given.unwrap_or_else(|| {
            let place = Place::Key(format!("{}{key}", self.prefix));
            Given { call: self.call, value: Value::Nil, place, required: false }
        })
    }

    pub fn has(&self, key: &'static str) -> bool {
        !self.get(key).absent()
    }

    /// Fails where more than one of these groups of keys is there, for they say the same thing.
    pub fn exclude(&self, groups: &[&[&'static str]]) -> Outcome<()> {
        let mut present = groups.iter().filter_map(|group| group.iter().find(|key| self.has(key)));
        match (present.next(), present.next()) {
            (Some(first), Some(second)) => {
                let message = format!("cannot stand together with '{}{first}'", self.prefix);
                Err(self.get(second).fail(message))
            }
            _ => Ok(()),
        }
    }
}

/// The only argument, if it is a table that has names in it, or nothing at all.
fn only_table<'a>(call: &'a Call<'a>) -> Option<&'a Table> {
    let Value::Table(table) = call.value(0) else { return None };
    let named = table.is_empty() || table.pairs::<Value, Value>().flatten().any(|(key, _)| key.is_string());
    (call.count() == 1 && named).then_some(table)
}
