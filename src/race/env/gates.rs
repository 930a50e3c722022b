//! Gates as the vehicle meets them: the target gate's frame, and what counts as passing it (paper section 4.3).

use crate::base::lane::{Lane, Mask, Real, build, each, set_lanes};
use crate::model::attitude::dot;
use crate::model::track::{GateKind, Track};

/// The target gate of a vehicle: frame in the world and the way to the next two gates.
#[derive(Clone, Copy, Debug)]
pub struct GateFrame<R> {
    /// Centre, world, m.
    pub center: [R; 3],
    /// The gate's x (direction of crossing), y (left) and z (up) axes in the world.
    pub axes: [[R; 3]; 3],
    /// Radius of the aperture disk, m.
    pub radius: R,
    /// Centres of the next two gates seen from this one, in this gate's frame, m.
    pub next: [[R; 3]; 2],
}

/// A move across the plane of a gate, seen in the gate's frame.
#[derive(Clone, Copy, Debug)]
pub struct PlaneCrossing<R: Real> {
    /// Crossed in the gate's direction through the aperture.
    pub passed: R::Mask,
    /// Crossed in the gate's direction outside the aperture.
    pub missed: R::Mask,
    /// Share of the move done at the plane, 0..1; meaningful where it was crossed.
    pub fraction: R,
}

impl<R: Copy> GateFrame<R> {
    #[inline(always)]
    pub fn map<S>(&self, mut f: impl FnMut(R) -> S) -> GateFrame<S> {
        GateFrame {
            center: self.center.map(&mut f),
            axes: self.axes.map(|a| a.map(&mut f)),
            radius: f(self.radius),
            next: self.next.map(|a| a.map(&mut f)),
        }
    }
}

impl<R: Real> GateFrame<R> {
    /// A world vector in the gate's frame.
    #[inline(always)]
    pub fn rotate(&self, v: [R; 3]) -> [R; 3] {
        each!(self.axes, |axis| dot(axis, v))
    }

    /// A world point in the gate's frame.
    #[inline(always)]
    pub fn locate(&self, point: [R; 3]) -> [R; 3] {
        self.rotate(build!(|i| point[i] - self.center[i]))
    }
}

impl<L: Lane> GateFrame<L> {
    /// Makes `gate` the target of one lane.
    pub fn set_lane(&mut self, lane: usize, gate: &GateFrame<L::Elem>) {
        let GateFrame { center, axes, radius, next } = self;
        set_lanes(center, lane, &gate.center);
        set_lanes(axes.as_flattened_mut(), lane, gate.axes.as_flattened());
        set_lanes(next.as_flattened_mut(), lane, gate.next.as_flattened());
        radius.set(lane, gate.radius);
    }
}

/// Compares two positions in the gate's frame, one step apart, by the straight line between them.
#[inline(always)]
pub fn crossing<R: Real>(before: [R; 3], after: [R; 3], radius: R) -> PlaneCrossing<R> {
    let crossed = before[0].lt(R::zero()) & R::zero().le(after[0]);
    if !crossed.any() {
        return PlaneCrossing { passed: crossed, missed: crossed, fraction: R::zero() };
    }
    let fraction = before[0] / R::select(crossed, before[0] - after[0], R::one());
    let y = fraction.mul_add(after[1] - before[1], before[1]);
    let z = fraction.mul_add(after[2] - before[2], before[2]);
    let inside = y.mul_add(y, z * z).le(radius * radius);
    PlaneCrossing { passed: crossed & inside, missed: crossed & !inside, fraction }
}

/// The frames of all gates of `track`; physical gates with the aperture `physical_radius` where it is given.
pub fn frames(track: &Track, physical_radius: Option<f64>) -> Vec<GateFrame<f32>> {
    let n = track.gates.len();
    let at = |i: usize| track.gates[i % n].position();
    (0..n)
        .map(|i| {
            let gate = &track.gates[i];
            let rotation = gate.rotation();
            let radius = match physical_radius {
                Some(radius) if gate.kind == GateKind::Physical => radius.min(gate.radius_m),
                _ => gate.radius_m,
            };
            let offset = |k: usize| rotation.transpose() * (at(i + k) - at(i));
            GateFrame {
                center: at(i).into(),
                axes: build!(|k| rotation.column(k).into_owned().into()),
                radius,
                next: [offset(1).into(), offset(2).into()],
            }
            .map(|x: f64| x as f32)
        })
        .collect()
}
