use std::str::FromStr;

/// Eleven hours at 25 frames a second.
pub const MAX_FRAMES: u32 = 1_000_000;

/// Frame numbers from `first` to `last`, both included, every `step`th.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FrameRange {
    first: u32,
    last: u32,
    step: u32,
}

impl FrameRange {
    pub fn frames(self) -> impl Iterator<Item = u32> + Clone {
        (self.first..=self.last).step_by(self.step as usize)
    }

    /// At most [`MAX_FRAMES`].
    pub fn count(self) -> u32 {
        (self.last - self.first) / self.step + 1
    }
}

impl FromStr for FrameRange {
    type Err = String;

    /// Reads "A..B" or "A..B:STEP".
    fn from_str(text: &str) -> Result<Self, String> {
        let number = |text: &str| text.bytes().all(|byte| byte.is_ascii_digit()).then(|| text.parse::<u32>().ok())?;
        let (range, step) = text.split_once(':').unwrap_or((text, "1"));
        let parts = || {
            let (first, last) = range.split_once("..")?;
            Some((number(first)?, number(last)?, number(step)?))
        };
        let Some((first, last, step)) = parts() else {
            return Err(
                "expected FIRST..LAST or FIRST..LAST:STEP, such as 1..100 or 0..100:5, both ends included".into()
            );
        };
        if step == 0 {
            return Err("the step must be at least 1".into());
        }
        if last < first {
            return Err(format!("the last frame, {last}, comes before the first, {first}"));
        }
        let intervals = (last - first) / step;
        if intervals >= MAX_FRAMES {
            return Err(format!("these are more frames than the {MAX_FRAMES} that a batch may have"));
        }
        Ok(FrameRange { first, last, step })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_ends_are_included() {
        for (text, expected) in [
            ("1..4", vec![1, 2, 3, 4]),
            ("7..7", vec![7]),
            ("0..10:5", vec![0, 5, 10]),
            ("0..9:5", vec![0, 5]),
            ("4294967294..4294967295", vec![u32::MAX - 1, u32::MAX]),
        ] {
            let range: FrameRange = text.parse().unwrap_or_else(|error| panic!("{text}: {error}"));
            assert_eq!(range.frames().collect::<Vec<_>>(), expected, "{text}");
            assert_eq!(range.count() as usize, expected.len(), "{text}");
        }
    }

    #[test]
    fn others_are_refused() {
        for (text, message) in [
            ("", "expected"),
            ("5", "expected"),
            ("1...4", "expected"),
            ("1..", "expected"),
            ("-1..4", "expected"),
            ("1..4:", "expected"),
            ("1..4:-1", "expected"),
            ("1..4294967296", "expected"),
            ("1..4:0", "at least 1"),
            ("4..1", "before the first"),
            ("1..1000001", "more frames"),
        ] {
            let error = text.parse::<FrameRange>().expect_err(text);
            assert!(error.contains(message), "{text}: {error}");
        }
    }
}
