//! Units of the quantities of a log. Each has a factor to SI.

use serde::Deserialize;

/// A unit of one kind of quantity; the default is SI.
pub trait Unit: Copy + Default {
    /// What one of it is in SI.
    fn factor(self) -> f64;
}

macro_rules! units {
    ($(#[$doc:meta])* $name:ident: $($(#[$default:ident])? $unit:ident = $text:literal = $factor:expr),+) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
        pub enum $name {
            $($(#[$default])? #[serde(rename = $text)] $unit),+
        }

        impl Unit for $name {
            fn factor(self) -> f64 {
                match self {
                    $(Self::$unit => $factor),+
                }
            }
        }
    };
}

units!(
    AngularRate: #[default] RadS = "rad/s" = 1.0,
    DegS = "deg/s" = 1f64.to_radians(),
    Rpm = "rpm" = std::f64::consts::TAU / 60.0
);
units!(Acceleration: #[default] MS2 = "m/s2" = 1.0, G = "g" = 9.80665);
units!(Length: #[default] M = "m" = 1.0, Cm = "cm" = 1e-2, Mm = "mm" = 1e-3);
units!(Speed: #[default] MS = "m/s" = 1.0, CmS = "cm/s" = 1e-2, MmS = "mm/s" = 1e-3, KmH = "km/h" = 1.0 / 3.6);
units!(Voltage: #[default] V = "V" = 1.0, MilliV = "mV" = 1e-3);
units!(Current: #[default] A = "A" = 1.0, MilliA = "mA" = 1e-3);
units!(Duration: #[default] S = "s" = 1.0, Ms = "ms" = 1e-3, Us = "us" = 1e-6, Ns = "ns" = 1e-9);
units!(
    /// No unit.
    One: #[default] One = "1" = 1.0
);
