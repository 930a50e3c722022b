//! C sources: fixed ones that say how, and generated ones with the policy's numbers.

mod numbers;

use super::Exported;
use numbers::{data, header, self_test};

const README: &str = include_str!("c/README.md");

/// What is the same for every policy.
const FIXED: [(&str, &str); 6] = [
    ("racer_policy.h", include_str!("c/racer_policy.h")),
    ("racer_policy.c", include_str!("c/racer_policy.c")),
    ("racer_self_test.c", include_str!("c/racer_self_test.c")),
    ("examples/bare_loop.c", include_str!("c/bare_loop.c")),
    ("examples/betaflight_task.c", include_str!("c/betaflight_task.c")),
    ("examples/crazyflie_controller.c", include_str!("c/crazyflie_controller.c")),
];

/// Names and contents.
pub fn files(exported: &Exported) -> Vec<(String, Vec<u8>)> {
    let about = &exported.snapshot.about;
    let test = &exported.metadata["flying"]["self_test"];
    let readme = [
        ("SHA256", exported.sha256.clone()),
        ("TRACK", about.track.name.clone()),
        ("VEHICLE", about.vehicle.name.clone()),
        ("RACER", exported.metadata["racer"].as_str().unwrap_or_default().to_string()),
        ("STEPS", test["steps"].to_string()),
        ("SWITCHES", test["switches"].to_string()),
    ];
    let readme =
        readme.into_iter().fold(README.to_string(), |text, (key, value)| text.replace(&format!("@{key}@"), &value));
    let generated = [
        ("README.md", readme),
        ("racer_policy_data.h", header(exported)),
        ("racer_policy_data.c", data(exported)),
        ("racer_self_test_data.c", self_test(&exported.content.rows)),
    ];
    let fixed = FIXED.map(|(name, text)| (name.to_string(), text.as_bytes().to_vec()));
    fixed.into_iter().chain(generated.map(|(name, text)| (name.to_string(), text.into_bytes()))).collect()
}
