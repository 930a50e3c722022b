//! Fixes of a GPS, as metres from the first one, and metres a second.

use super::definition::FrameDefinition;
use super::header::Header;
use crate::flight::table::Table;

/// Columns that [`Fixes::add_to`] adds to a table.
pub const DERIVED: [&str; 5] = ["east", "north", "velocity_east", "velocity_north", "velocity_up"];

/// Altitudes of so long tell the vertical speed where the GPS does not, s.
const SLOPE_S: f64 = 1.0;
/// Fixes to either side that are looked at.
const NEIGHBOURS: usize = 64;

/// One row a fix, in degrees, m and m/s.
#[derive(Default)]
pub struct Fixes {
    pub time_s: Vec<f64>,
    pub latitude: Vec<f64>,
    pub longitude: Vec<f64>,
    pub altitude_m: Vec<f64>,
    /// Over the ground.
    pub speed_m_s: Vec<f64>,
    /// Clockwise from north.
    pub course: Vec<f64>,
    /// North, east, down, where the GPS gives them.
    pub velocity_m_s: Vec<[f64; 3]>,
}

/// Where the numbers of a fix are in GPS frames.
pub struct Places {
    coordinates: [Option<usize>; 2],
    altitude: Option<usize>,
    motion: [Option<usize>; 2],
    velocity: [Option<usize>; 3],
    altitude_scale_m: f64,
}

impl Places {
    pub fn new(definition: &FrameDefinition, header: &Header) -> Self {
        let place = |name: &str| definition.names.iter().position(|known| known == name);
        Self {
            coordinates: ["GPS_coord[0]", "GPS_coord[1]"].map(place),
            altitude: place("GPS_altitude"),
            motion: ["GPS_speed", "GPS_ground_course"].map(place),
            velocity: ["GPS_velned[0]", "GPS_velned[1]", "GPS_velned[2]"].map(place),
            altitude_scale_m: header.altitude_scale_m(),
        }
    }
}

impl Fixes {
    pub fn push(&mut self, time_us: i64, places: &Places, definition: &FrameDefinition, frame: &[i64]) {
        let value = |place: Option<usize>, scale: f64| {
            place.map_or(f64::NAN, |index| scale * definition.number(index, frame[index]) as f64)
        };
        self.time_s.push(time_us as f64 * 1e-6);
        let [latitude, longitude] = places.coordinates.map(|place| value(place, 1e-7));
        self.latitude.push(latitude);
        self.longitude.push(longitude);
        self.altitude_m.push(value(places.altitude, places.altitude_scale_m));
        self.speed_m_s.push(value(places.motion[0], 1e-2));
        self.course.push(value(places.motion[1], 0.1));
        self.velocity_m_s.push(places.velocity.map(|place| value(place, 1e-2)));
    }

    /// Adds where each fix is and how fast, east, north and up.
    pub fn add_to(&self, table: &mut Table) {
        let (latitude_0, longitude_0) =
            (self.latitude.first().copied().unwrap_or(0.0), self.longitude.first().copied().unwrap_or(0.0));
        /// Metres a degree of latitude, on a sphere.
        const METRES: f64 = 6_371_008.8 * std::f64::consts::PI / 180.0;
        let across = METRES * latitude_0.to_radians().cos();
        let rows = 0..self.time_s.len();
        let column = |value: &dyn Fn(usize) -> f64| rows.clone().map(value).collect::<Vec<f64>>();
        let known = |given: f64, else_: f64| if given.is_finite() { given } else { else_ };
        let over_ground = |i: usize| self.course[i].to_radians().sin_cos();
        let columns = [
            column(&|i| across * (self.longitude[i] - longitude_0)),
            column(&|i| METRES * (self.latitude[i] - latitude_0)),
            column(&|i| known(self.velocity_m_s[i][1], self.speed_m_s[i] * over_ground(i).0)),
            column(&|i| known(self.velocity_m_s[i][0], self.speed_m_s[i] * over_ground(i).1)),
            column(&|i| known(-self.velocity_m_s[i][2], self.climb(i))),
        ];
        table.columns.extend(DERIVED.map(String::from).into_iter().zip(columns));
    }

    /// Slope of the altitudes around a fix, m/s.
    fn climb(&self, i: usize) -> f64 {
        let middle = self.time_s[i];
        let near = |k: &usize| (self.time_s[*k] - middle).abs() <= 0.5 * SLOPE_S;
        let from = (i.saturating_sub(NEIGHBOURS)..i).rev().take_while(near).last().unwrap_or(i);
        let to = (i..self.time_s.len().min(i + NEIGHBOURS)).take_while(near).last().map_or(i + 1, |last| last + 1);
        let n = (to - from) as f64;
        let mean = |x: &[f64]| x[from..to].iter().sum::<f64>() / n;
        let (t_0, z_0) = (mean(&self.time_s), mean(&self.altitude_m));
        let sum = |f: &dyn Fn(usize) -> f64| (from..to).map(f).sum::<f64>();
        let moved = sum(&|k| (self.time_s[k] - t_0) * (self.altitude_m[k] - z_0));
        moved / sum(&|k| (self.time_s[k] - t_0).powi(2))
    }
}
