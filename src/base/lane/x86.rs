//! The block in x86-64 registers: one of 512 bits, two of 256, or four of 128.

#[cfg(target_os = "linux")]
pub mod amx;
mod avx2;
mod avx512;
mod sse2;

pub use avx2::Avx2;
pub use avx512::Avx512;
pub use sse2::Sse2;

pub fn has_avx2() -> bool {
    is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma")
}

pub fn has_avx512() -> bool {
    has_avx2() && is_x86_feature_detected!("avx512f") && is_x86_feature_detected!("avx512dq")
}

/// `VDPBF16PS`, and the permutation of 16-bit words that its factors need.
pub fn has_avx512_bf16() -> bool {
    has_avx512() && is_x86_feature_detected!("avx512bf16") && is_x86_feature_detected!("avx512bw")
}
