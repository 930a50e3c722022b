//! A PX4 log as its logger writes it.

fn message(kind: u8, payload: &[u8]) -> Vec<u8> {
    [&(payload.len() as u16).to_le_bytes()[..], &[kind], payload].concat()
}

/// A ULog file of one second: rates at 100 Hz, attitude at 50 Hz, local position at 10 Hz.
pub fn ulog() -> Vec<u8> {
    let mut bytes = b"ULog\x01\x12\x35\x01\0\0\0\0\0\0\0\0".to_vec();
    bytes.extend(message(b'B', &[0; 40]));
    for format in [
        "vehicle_rates_setpoint:uint64_t timestamp;float roll;float pitch;float yaw;float[3] thrust_body;\
         uint8_t[4] _padding0;",
        "vehicle_attitude:uint64_t timestamp;float[4] q;",
        "vehicle_local_position:uint64_t timestamp;float x;float y;float z;float vx;float vy;float vz;",
    ] {
        bytes.extend(message(b'F', format.as_bytes()));
    }
    for (id, topic) in ["vehicle_rates_setpoint", "vehicle_attitude", "vehicle_local_position"].iter().enumerate() {
        bytes.extend(message(b'A', &[&[0, id as u8, 0], topic.as_bytes()].concat()));
    }
    let mut record = |id: u8, time_ms: u64, values: &[f32]| {
        let mut data = vec![id, 0];
        data.extend((1000 * time_ms).to_le_bytes());
        data.extend(values.iter().flat_map(|value| value.to_le_bytes()));
        bytes.extend(message(b'D', &data));
    };
    for step in 0..100 {
        let time_ms = 5000 + 10 * step;
        record(0, time_ms, &[0.1, 0.2, 0.3, 0.0, 0.0, -0.4]);
        if step % 2 == 0 {
            // Heading north.
            record(1, time_ms + 3, &[1.0, 0.0, 0.0, 0.0]);
        }
        if step % 10 == 0 {
            record(2, time_ms, &[1.0, 2.0, -3.0, 4.0, 5.0, -6.0]);
        }
    }
    bytes
}
