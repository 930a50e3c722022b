//! Colours of figures.

use plotters::style::RGBColor;

/// Dark to bright, in order also for readers who see no hue (viridis).
pub fn viridis(share: f64) -> RGBColor {
    const STOPS: [[f64; 3]; 9] = [
        [68.0, 1.0, 84.0],
        [71.0, 44.0, 122.0],
        [59.0, 81.0, 139.0],
        [44.0, 113.0, 142.0],
        [33.0, 144.0, 141.0],
        [39.0, 173.0, 129.0],
        [92.0, 200.0, 99.0],
        [170.0, 220.0, 50.0],
        [253.0, 231.0, 37.0],
    ];
    let at = share.clamp(0.0, 1.0) * (STOPS.len() - 1) as f64;
    let (low, high) = (STOPS[at.floor() as usize], STOPS[at.ceil() as usize]);
    let [r, g, b] = std::array::from_fn(|i| (low[i] + (high[i] - low[i]) * at.fract()).round() as u8);
    RGBColor(r, g, b)
}
