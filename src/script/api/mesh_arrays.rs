//! The tables of a mesh: numbers in one row, or a table for each vertex or face.

use crate::scene::PolygonMesh;
use crate::script::arguments::{BadElement, Outcome, finite, tuple};
use crate::script::given::Given;
use glam::{DVec2, DVec3};
use mlua::{Table, Value};

/// Points or vectors: `{{x, y, z}, …}` or `{x, y, z, …}`. `item` is what messages call one of them.
pub fn vectors(given: &Given, item: &str) -> Outcome<Vec<DVec3>> {
    Ok(tuples::<3>(given, item)?.into_iter().map(DVec3::from_array).collect())
}

/// `{{u, v}, …}` or `{u, v, …}`.
pub fn texture_coordinates(given: &Given) -> Outcome<Vec<DVec2>> {
    Ok(tuples::<2>(given, "uv")?.into_iter().map(DVec2::from_array).collect())
}

fn tuples<const N: usize>(given: &Given, item: &str) -> Outcome<Vec<[f64; N]>> {
    let table = given.table(&format!("a table of tables of {N} numbers, or of numbers in one row"))?;
    if is_row_of_numbers(table)? { row(given, table) } else { nested(given, table, item) }
}

/// Whether the first element is no table.
fn is_row_of_numbers(table: &Table) -> Outcome<bool> {
    Ok(!matches!(table.raw_get::<Value>(1)?, Value::Table(_) | Value::Nil))
}

fn row<const N: usize>(given: &Given, table: &Table) -> Outcome<Vec<[f64; N]>> {
    let length = table.raw_len();
    if length % N != 0 {
        return Err(given.fail(format!("{length} numbers in one row are no multiple of {N}")));
    }
    let mut tuples = vec![[0.0; N]; length / N];
    for (position, number) in (1..).zip(tuples.as_flattened_mut()) {
        let value = table.raw_get::<Value>(position)?;
        *number = finite(given.call.lua, &value).ok_or_else(|| {
            given.fail(format!("[{position}]: expected a number, got {}", given.call.describe(&value)))
        })?;
    }
    Ok(tuples)
}

fn nested<const N: usize>(given: &Given, table: &Table, item: &str) -> Outcome<Vec<[f64; N]>> {
    let read = |number| {
        let value = table.raw_get::<Value>(number)?;
        let read = match &value {
            Value::Table(numbers) => tuple(given.call.lua, numbers),
            _ => Err(BadElement::Value(number, value)),
        };
        read.map_err(|got| {
            let got = given.call.describe_element(got);
            given.fail(format!("{item} [{number}]: expected a table of {N} numbers, got {got}"))
        })
    };
    (1..=table.raw_len()).map(read).collect()
}

/// Faces by vertex numbers from 0: polygons `{{i, j, k, …}, …}`, or triangles in one row `{i, j, k, …}`.
pub fn faces(given: &Given, polygons: &mut PolygonMesh) -> Outcome<()> {
    let table = given.table("a table of faces, each a table of vertex numbers counted from 0")?;
    let one_row = is_row_of_numbers(table)?;
    let length = table.raw_len();
    if one_row && length % 3 != 0 {
        return Err(given.fail(format!("{length} vertex numbers in one row are no multiple of 3")));
    }
    let mut corners = Vec::new();
    for number in 1..=if one_row { length / 3 } else { length } {
        corners.clear();
        if one_row {
            read_corners(given, number, table, 3 * number - 2..=3 * number, &mut corners)?;
        } else {
            let value = table.raw_get::<Value>(number)?;
            let Value::Table(face) = &value else {
                return Err(bad_face(given, number, &given.call.describe(&value)));
            };
            read_corners(given, number, face, 1..=face.raw_len(), &mut corners)?;
        }
        polygons.add_face(&corners).map_err(|message| given.fail(format!("face [{number}]: {message}")))?;
    }
    Ok(())
}

fn read_corners(
    given: &Given,
    face: usize,
    table: &Table,
    positions: std::ops::RangeInclusive<usize>,
    corners: &mut Vec<u32>,
) -> Outcome<()> {
    for position in positions {
        let value = table.raw_get::<Value>(position)?;
        let index = finite(given.call.lua, &value).filter(|index| index.fract() == 0.0 && (0.0..=4e9).contains(index));
        let Some(index) = index else {
            return Err(bad_face(given, face, &format!("{} at [{position}]", given.call.describe(&value))));
        };
        corners.push(index as u32);
    }
    Ok(())
}

fn bad_face(given: &Given, face: usize, got: &str) -> crate::script::arguments::Failure {
    given.fail(format!("face [{face}]: expected a table of vertex numbers counted from 0, got {got}"))
}
