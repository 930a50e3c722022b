use racer::diagnose::{
    model::{self, Model},
    predict,
    problem::Problem,
    record::{self, Record},
    select,
};
use racer::flight::quality::check;
use racer::identify::data::Data;
use racer::vehicle::Vehicle;
use std::time::Instant;
fn main() {
    let args: Vec<String> = std::env::args().collect();
    let vehicle = Vehicle::load(&args[2]).unwrap();
    let t = Instant::now();
    let log = racer::flight::open(std::path::Path::new(&args[1]), None).unwrap();
    let q = check(&log);
    let data = Data::new(vec![q]);
    let records: Vec<Record> =
        data.flights.iter().map(|f| Record::new(f, record::full_rate(&vehicle, &f.quality))).collect();
    let begin: Vec<f64> = records.iter().map(|r| r.volts.first().map_or(vehicle.battery.full_v, |v| v.1)).collect();
    let p = Problem::new(Model::new(&vehicle, &begin), records);
    eprintln!("read {:?}; rows {:?}", t.elapsed(), p.rows.iter().map(|r| r.len()).collect::<Vec<_>>());
    let t = Instant::now();
    let s = p.predict(&p.model.base);
    eprintln!("predict {:?}", t.elapsed());
    let r = p.residuals(&s);
    for c in 0..predict::CHANNELS {
        eprint!("{:.4} ", (r[c].iter().map(|x| x * x).sum::<f64>() / r[c].len().max(1) as f64).sqrt());
    }
    eprintln!();
    let t = Instant::now();
    let sel = select::select(&p, &mut |_, _| ());
    eprintln!("select {:?}", t.elapsed());
    for c in 0..predict::CHANNELS {
        eprint!("{:.4} ", (sel.point.residual[c].iter().map(|x| x * x).sum::<f64>() / r[c].len().max(1) as f64).sqrt());
    }
    eprintln!();
    for &k in &sel.point.free {
        eprintln!("{} {:.5} base {:.5}", p.model.numbers[k].name, sel.point.x[k], p.model.base[k]);
    }
    for a in &sel.added {
        eprintln!(
            "ADDED {} ties {:?} {:?}",
            a.card.id,
            a.ties.iter().map(|c| c.id).collect::<Vec<_>>(),
            model::span(a.card).map(|k| sel.point.x[k]).collect::<Vec<_>>()
        );
    }
    for r in &sel.reach {
        eprintln!("reach {} 5s={:.5} kept {:.3} {:?}", r.card.id, 5.0 / r.information.sqrt(), r.kept, r.nearest);
    }
}
