//! What the public `gr` programs disagree about, and how a scene says which it means.
//!
//! The command line wins over `gr.conventions{…}`, that over what the script gives away about itself, that over the
//! defaults.

use super::diagnostics::nearest;
use crate::scene::{Conventions, PixelOrigin, Specular};
use std::str::FromStr;

/// What the `view` argument of `gr.render` is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ViewConvention {
    /// The point looked at, in world space; it is in focus.
    #[default]
    Point,
    /// The direction of view; what lies its length away is in focus.
    Direction,
}

/// How `translate`, `scale` and `rotate` change the transform M of a node.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum TransformOrder {
    /// M ← T·M: the calls apply to the shape in the order in which they are written.
    #[default]
    Pre,
    /// M ← M·T: in the opposite order.
    Post,
}

/// The conventions that somebody stated; `None` leaves the choice to who comes next.
///
/// Parses from `view=direction,transforms=post,specular=blinn,sample=corner`, any of them in any order.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ConventionOverrides {
    pub view: Option<ViewConvention>,
    pub transforms: Option<TransformOrder>,
    pub specular: Option<Specular>,
    pub sample: Option<PixelOrigin>,
}

const KEYS: [(&str, [&str; 2]); 4] = [
    ("view", ["point", "direction"]),
    ("transforms", ["pre", "post"]),
    ("specular", ["phong", "blinn"]),
    ("sample", ["centre", "corner"]),
];

impl ConventionOverrides {
    /// States one convention by its name and value.
    ///
    /// # Errors
    /// A message that lists the known names, or the values of this one.
    pub fn set(&mut self, key: &str, value: &str) -> Result<(), String> {
        let Some((_, values)) = KEYS.iter().find(|(name, _)| *name == key) else {
            let known: Vec<String> = KEYS.iter().map(|(name, values)| format!("{name}={}", values.join("|"))).collect();
            let hint = nearest(key, KEYS.iter().map(|(name, _)| *name))
                .map_or_else(String::new, |name| format!("; did you mean '{name}'?"));
            return Err(format!("unknown convention '{key}'{hint} (known: {})", known.join(", ")));
        };
        // "center" is how half of the world spells it.
        let value = if value == "center" { "centre" } else { value };
        let second = match values.iter().position(|known| *known == value) {
            Some(position) => position == 1,
            None => return Err(format!("{key}: expected '{}' or '{}', got '{value}'", values[0], values[1])),
        };
        match key {
            "view" => self.view = Some(if second { ViewConvention::Direction } else { ViewConvention::Point }),
            "transforms" => self.transforms = Some(if second { TransformOrder::Post } else { TransformOrder::Pre }),
            "specular" => self.specular = Some(if second { Specular::Blinn } else { Specular::Phong }),
            _ => self.sample = Some(if second { PixelOrigin::Corner } else { PixelOrigin::Centre }),
        }
        Ok(())
    }
}

impl FromStr for ConventionOverrides {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let mut overrides = ConventionOverrides::default();
        for item in text.split(',').map(str::trim).filter(|item| !item.is_empty()) {
            let Some((key, value)) = item.split_once('=') else {
                return Err(format!("expected 'name=value' pairs with commas between, got '{item}'"));
            };
            overrides.set(key.trim(), value.trim())?;
        }
        Ok(overrides)
    }
}

/// Who said what so far.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct ConventionSources {
    pub command_line: ConventionOverrides,
    pub script: ConventionOverrides,
    /// The script was recognised as one for the skeleton from before 2015, whose transforms post-multiply.
    pub old_skeleton: bool,
}

impl ConventionSources {
    pub fn view(&self) -> ViewConvention {
        self.command_line.view.or(self.script.view).unwrap_or_default()
    }

    /// Whether the command line or the script said how transforms multiply.
    pub fn transforms_stated(&self) -> bool {
        self.command_line.transforms.or(self.script.transforms).is_some()
    }

    pub fn transforms(&self) -> TransformOrder {
        let by_itself = if self.old_skeleton { TransformOrder::Post } else { TransformOrder::Pre };
        self.command_line.transforms.or(self.script.transforms).unwrap_or(by_itself)
    }

    pub fn rendering(&self) -> Conventions {
        Conventions {
            specular: self.command_line.specular.or(self.script.specular).unwrap_or_default(),
            sample: self.command_line.sample.or(self.script.sample).unwrap_or_default(),
        }
    }
}
