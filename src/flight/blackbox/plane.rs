//! Latitude and longitude of GPS frames, as metres east and north of the first fix.

use super::definition::Definition;

pub struct Plane {
    index: Option<[usize; 2]>,
    first: Option<[f64; 2]>,
    pub east: Vec<f64>,
    pub north: Vec<f64>,
}

impl Plane {
    pub fn new(definition: &Definition) -> Self {
        let place = |name| definition.names.iter().position(|known| known == name);
        let index = place("GPS_coord[0]").zip(place("GPS_coord[1]")).map(|(latitude, longitude)| [latitude, longitude]);
        Self { index, first: None, east: Vec::new(), north: Vec::new() }
    }

    pub fn push(&mut self, definition: &Definition, frame: &[i64]) {
        let degrees = |index: usize| 1e-7 * definition.number(index, frame[index]) as f64;
        let [latitude, longitude] = self.index.map_or([f64::NAN; 2], |index| index.map(degrees));
        let [latitude_0, longitude_0] = *self.first.get_or_insert([latitude, longitude]);
        /// Metres a degree of latitude, on a sphere.
        const METRES: f64 = 6_371_008.8 * std::f64::consts::PI / 180.0;
        self.east.push(METRES * (longitude - longitude_0) * latitude_0.to_radians().cos());
        self.north.push(METRES * (latitude - latitude_0));
    }
}
