//! What the fuzz targets start from: a file or more for each reader, which takes it. With RACER_FUZZ_CORPUS they are
//! written there.

use crate::support::feed::{READERS, feed};
use crate::{blackbox, mcap};
use racer::base::rng::{Philox, RngStream};
use racer::flight::write;
use racer::learn::nn::Network;
use racer::race::config::Setup;
use racer::race::env::observe::OBSERVATIONS;
use racer::race::snapshot::{About, Snapshot};
use std::path::{Path, PathBuf};

#[test]
fn every_reader_takes_its_corpus() {
    let folder = std::env::var_os("RACER_FUZZ_CORPUS").map(PathBuf::from);
    for reader in READERS {
        let files = corpus(reader);
        assert!(!files.is_empty(), "{reader}");
        for (i, bytes) in files.iter().enumerate() {
            assert!(feed(reader, bytes), "file {i} of {reader}");
            if let Some(folder) = &folder {
                std::fs::create_dir_all(folder.join(reader)).unwrap();
                std::fs::write(folder.join(reader).join(format!("{i:02}")), bytes).unwrap();
            }
        }
    }
}

/// Whole files of a kind.
fn corpus(reader: &str) -> Vec<Vec<u8>> {
    let text = |text: &str| vec![text.as_bytes().to_vec()];
    match reader {
        "mcap" => [
            vec![write::mcap(&mcap::log(60)).unwrap()],
            vec![mcap::foreign::json(), mcap::foreign::idl(), mcap::foreign::protobuf()],
        ]
        .concat(),
        "ulog" => vec![crate::support::ulog::ulog()],
        "blackbox" => vec![blackbox::flight()],
        "csv" => vec![csv()],
        "policy" => vec![policy()],
        "settings" => {
            ["configs", "configs/mappings", "configs/vehicles", "configs/sensors", "configs/studies", "tracks"]
                .iter()
                .flat_map(|folder| settings(Path::new(folder)))
                .collect()
        }
        "results" => text("[]"),
        "links" => super::live::spoken(),
        other => panic!("{other}"),
    }
}

/// A flight as NanoBench writes it.
fn csv() -> Vec<u8> {
    let columns = "t,px,py,pz,qw,qx,qy,qz,vx,vy,vz,imu_gyro_x,imu_gyro_y,imu_gyro_z,imu_acc_x,imu_acc_y,imu_acc_z,\
                   motor_motor_m1,motor_motor_m2,motor_motor_m3,motor_motor_m4,pwr_pm_vbat\n";
    let row = |i: i32| {
        let (t, x) = (0.01 * f64::from(i), (0.1 * f64::from(i)).sin());
        format!("{t},{x},0,1,1,0,0,0,{x},0,0,{x},0,0,0,0,1,30000,30000,30000,30000,4.1\n")
    };
    (columns.to_string() + &(0..40).map(row).collect::<String>()).into_bytes()
}

/// Whole settings: not what only lists differences from the default.
fn settings(folder: &Path) -> Vec<Vec<u8>> {
    let files = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    files
        .filter(|path| path.extension().is_some_and(|end| end == "toml") && !path.ends_with("a2rl_many_cores.toml"))
        .map(|path| std::fs::read(path).unwrap())
        .collect()
}

/// A policy that was never trained.
fn policy() -> Vec<u8> {
    let Setup { config, track, vehicle } = Setup::load("a2rl", &[]).unwrap();
    let network = Network::initialised(OBSERVATIONS, -0.5, &mut Philox::new(3).sequence(RngStream::Weights, 0, 0));
    let about = About { track, vehicle, env: config.env, eval: config.eval, seed: 3, steps: 7, seconds: 0.1 };
    Snapshot { network, about }.to_bytes().unwrap()
}
