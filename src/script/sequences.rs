//! Long tables of numbers, such as the vertices of a mesh: in one pass, without metamethods.

use super::arguments::{BadElement, Outcome, finite, tuple};
use super::given::Given;
use mlua::{Table, Value};

/// Calls `each` with the position, counted from 1, and the value of everything in the sequence part of a table. A hole
/// is a nil.
pub(super) fn for_each(table: &Table, mut each: impl FnMut(usize, Value) -> Outcome<()>) -> Outcome<()> {
    let mut position = 0;
    for value in table.sequence_values::<Value>() {
        position += 1;
        each(position, value?)?;
    }
    // The values end at the first nil.
    if position < table.raw_len() { each(position + 1, Value::Nil) } else { Ok(()) }
}

/// Whether the elements of a table are tables themselves, by its first.
pub(super) fn is_nested(table: &Table) -> Outcome<bool> {
    Ok(table.raw_get::<Value>(1)?.is_table())
}

/// Vectors of `N` finite numbers: `{{x, y, …}, …}`, or all numbers in a row. `what` is the name of one in messages.
pub(super) fn vectors<const N: usize>(given: &Given, what: &str) -> Outcome<Vec<[f32; N]>> {
    let lua = given.call.lua;
    let table = given.table(&format!("a table of tables of {N} numbers, or of numbers, {N} for each {what}"))?;
    let mut vectors = Vec::new();
    if is_nested(table)? || given.is_argument() {
        for_each(table, |position, value| {
            let read = match &value {
                Value::Table(numbers) => tuple(lua, numbers),
                _ => Err(BadElement::Value(position, value)),
            };
            let vector: [f64; N] = read.map_err(|got| {
                let got = given.call.describe_element(got);
                given.fail(format!("{what} [{position}]: expected a table of {N} numbers, got {got}"))
            })?;
            vectors.push(vector.map(|number| number as f32));
            Ok(())
        })?;
        return Ok(vectors);
    }
    let mut vector = [0.0; N];
    let mut count = 0;
    for_each(table, |position, value| {
        let Some(number) = finite(lua, &value) else {
            return Err(given.fail(format!("expected a number at [{position}], got {}", given.call.describe(&value))));
        };
        vector[count % N] = number as f32;
        count += 1;
        if count.is_multiple_of(N) {
            vectors.push(vector);
        }
        Ok(())
    })?;
    if !count.is_multiple_of(N) {
        return Err(given.fail(format!("expected {N} numbers for each {what}, got {count} in all")));
    }
    Ok(vectors)
}
