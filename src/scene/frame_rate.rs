use std::fmt;
use std::str::FromStr;

/// Pictures a second, as a fraction in its lowest terms; neither part is 0 or above 65535.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FrameRate {
    numerator: u16,
    denominator: u16,
}

impl FrameRate {
    /// `None` where the rate is not above 0, or needs larger numbers than 65535.
    pub fn new(numerator: u64, denominator: u64) -> Option<Self> {
        let (mut a, mut b) = (numerator, denominator);
        while b != 0 {
            (a, b) = (b, a % b);
        }
        let part = |value: u64| u16::try_from(value.checked_div(a)?).ok().filter(|part| *part > 0);
        Some(FrameRate { numerator: part(numerator)?, denominator: part(denominator)? })
    }

    pub fn numerator(self) -> u16 {
        self.numerator
    }

    pub fn denominator(self) -> u16 {
        self.denominator
    }

    /// When a frame is shown, seconds after frame 0.
    pub fn seconds_at(self, frame: u32) -> f64 {
        f64::from(frame) * f64::from(self.denominator) / f64::from(self.numerator)
    }
}

impl Default for FrameRate {
    /// 25 a second.
    fn default() -> Self {
        FrameRate { numerator: 25, denominator: 1 }
    }
}

impl fmt::Display for FrameRate {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self.denominator {
            1 => write!(f, "{}", self.numerator),
            denominator => write!(f, "{}/{denominator}", self.numerator),
        }
    }
}

impl FromStr for FrameRate {
    type Err = String;

    /// Reads "25", "29.97" or "30000/1001".
    fn from_str(text: &str) -> Result<Self, String> {
        let digits = |text: &str| text.bytes().all(|byte| byte.is_ascii_digit()).then(|| text.parse::<u64>().ok())?;
        let parts = || match text.split_once('/') {
            Some((numerator, denominator)) => Some((digits(numerator)?, digits(denominator)?)),
            None => {
                let (whole, decimals) = text.split_once('.').unwrap_or((text, ""));
                let scale = 10u64.checked_pow(u32::try_from(decimals.len()).ok()?)?;
                Some((digits(&format!("{whole}{decimals}"))?, scale))
            }
        };
        parts().and_then(|(numerator, denominator)| FrameRate::new(numerator, denominator)).ok_or_else(|| {
            "expected frames a second above 0, such as 25, 29.97 or 30000/1001, in numbers of up to 65535".to_owned()
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rates_are_whole_decimal_or_fractions() {
        for (text, numerator, denominator) in
            [("25", 25, 1), ("12.5", 25, 2), ("29.97", 2997, 100), ("30000/1001", 30000, 1001), ("50/2", 25, 1)]
        {
            let rate = FrameRate { numerator, denominator };
            assert_eq!(text.parse(), Ok(rate), "{text}");
            assert_eq!(rate.to_string().parse(), Ok(rate), "{text}");
        }
        for text in ["", "0", "-25", "+25", "1/0", "0/1", "1e3", "70000", "1/2/3", ".", "2.5.1", "nan"] {
            assert!(text.parse::<FrameRate>().is_err(), "{text}");
        }
        assert_eq!("12.5".parse::<FrameRate>().map(|rate| rate.seconds_at(25)), Ok(2.0));
    }
}
