//! A layout for Foxglove: the scene beside plots of what [`super::mcap`] writes.

use serde_json::{Value, json};

/// The content of a layout file, which Foxglove imports.
pub fn layout() -> Value {
    let shown = ["/track", "/path", "/vehicles"].map(|topic| (topic.to_string(), json!({ "visible": true })));
    let topics: serde_json::Map<String, Value> = shown.into_iter().collect();
    let plot = |title: &str, paths: &[(&str, &str)]| {
        let paths: Vec<_> = paths
            .iter()
            .map(|(path, label)| {
                json!({ "value": path, "label": label, "enabled": true, "timestampMethod": "receiveTime" })
            })
            .collect();
        json!({ "title": title, "paths": paths, "showLegend": true, "showXAxisLabels": true, "showYAxisLabels": true,
                "legendDisplay": "floating", "isSynced": true, "xAxisVal": "timestamp" })
    };
    let commands = [
        ("/commands.roll", "roll"),
        ("/commands.pitch", "pitch"),
        ("/commands.yaw", "yaw"),
        ("/commands.thrust", "thrust"),
    ];
    let seen = [
        ("/observation.position.x", "to the gate, x"),
        ("/observation.position.y", "y"),
        ("/observation.position.z", "z"),
    ];
    json!({
        "configById": {
            "3D!scene": {
                "followTf": "world",
                "followMode": "follow-none",
                "scene": {},
                "topics": topics,
                "transforms": {},
                "layers": { "grid": { "layerId": "foxglove.Grid", "instanceId": "grid", "visible": true,
                                      "frameId": "world", "size": 60, "divisions": 60 } },
                "cameraState": { "distance": 45, "phi": 50, "thetaOffset": 30, "targetOffset": [11, 16, 0],
                                 "target": [0, 0, 0], "targetOrientation": [0, 0, 0, 1], "perspective": true,
                                 "fovy": 45, "near": 0.5, "far": 5000 },
            },
            "Plot!commands": plot("commands", &commands),
            "Plot!state": plot("speed, m/s", &[("/state.speed_m_s", "speed")]),
            "Plot!observation": plot("observation", &seen),
            "RosOut!log": { "searchTerms": [], "minLogLevel": 1 },
        },
        "globalVariables": {},
        "userNodes": {},
        "playbackConfig": { "speed": 0.5 },
        "layout": {
            "direction": "row",
            "first": "3D!scene",
            "second": {
                "direction": "column",
                "first": { "direction": "column", "first": "Plot!commands", "second": "Plot!state" },
                "second": { "direction": "column", "first": "Plot!observation", "second": "RosOut!log" },
            },
            "splitPercentage": 62,
        },
    })
}
