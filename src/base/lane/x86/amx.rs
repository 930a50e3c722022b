//! The product of pairs of bf16 on AMX tiles of 16 rows of 64 bytes: four hold sums, one 16 rows of A, three B.
//!
//! In assembler, because the compiler's functions for it are not stable. Linux hands out the tiles on request.

use crate::base::lane::{COLUMNS, LANES};
use std::arch::asm;
use std::arch::x86_64::{__cpuid, __cpuid_count};
use std::cell::Cell;

/// Whether the CPU has the tiles and the operating system lets this process use them.
pub fn permitted() -> bool {
    // Leaf 7: EDX bit 22 AMX-BF16, bit 24 AMX-TILE.
    __cpuid(0).eax >= 7 && __cpuid_count(7, 0).edx & (1 << 22 | 1 << 24) == 1 << 22 | 1 << 24 && request()
}

/// Asks Linux for the tiles' state, of this process and all of its threads.
fn request() -> bool {
    const ARCH_PRCTL: u64 = 158;
    const ARCH_REQ_XCOMP_PERM: u64 = 0x1023;
    const TILE_DATA: u64 = 18;
    let result: i64;
    // SAFETY: this system call touches no memory; it overwrites rcx and r11.
    unsafe {
        asm!("syscall", inlateout("rax") ARCH_PRCTL => result, in("rdi") ARCH_REQ_XCOMP_PERM, in("rsi") TILE_DATA,
             lateout("rcx") _, lateout("r11") _, options(nostack));
    }
    result == 0
}

/// Shapes of the eight tiles, once a thread.
fn configure() {
    thread_local!(static DONE: Cell<bool> = const { Cell::new(false) });
    if DONE.replace(true) {
        return;
    }
    // Palette 1; bytes of a row from byte 16 on, two bytes each; rows from byte 48 on.
    let mut shapes = [0u8; 64];
    shapes[0] = 1;
    (0..8).for_each(|tile| (shapes[16 + 2 * tile], shapes[48 + tile]) = (64, LANES as u8));
    // SAFETY: the 64 bytes are a valid configuration.
    unsafe { asm!("ldtilecfg [{}]", in(reg) shapes.as_ptr(), options(nostack, readonly)) }
}

/// C = A B, as [`crate::base::lane::bf16::product`].
///
/// # Safety
/// The tiles are [`permitted`]; the matrices are as large as `rows` and `words` say.
pub unsafe fn product(rows: usize, words: usize, a: *const u32, b: *const u32, c: *mut f32) {
    configure();
    for row in (0..rows).step_by(LANES) {
        // SAFETY: promised by the caller; strides are in bytes.
        unsafe {
            asm!(
                "tilezero tmm0",
                "tilezero tmm1",
                "tilezero tmm2",
                "tilezero tmm3",
                "2:",
                "tileloadd tmm4, [{a} + {along}*1]",
                "tileloadd tmm5, [{b} + {wide}*1]",
                "tdpbf16ps tmm0, tmm4, tmm5",
                "tileloadd tmm6, [{b} + {wide}*1 + 64]",
                "tdpbf16ps tmm1, tmm4, tmm6",
                "tileloadd tmm7, [{b} + {wide}*1 + 128]",
                "tdpbf16ps tmm2, tmm4, tmm7",
                "tileloadd tmm5, [{b} + {wide}*1 + 192]",
                "tdpbf16ps tmm3, tmm4, tmm5",
                "add {a}, 64",
                "add {b}, 4096",
                "dec {n}",
                "jnz 2b",
                "tilestored [{c} + {wide}*1], tmm0",
                "tilestored [{c} + {wide}*1 + 64], tmm1",
                "tilestored [{c} + {wide}*1 + 128], tmm2",
                "tilestored [{c} + {wide}*1 + 192], tmm3",
                c = in(reg) c.add(row * COLUMNS),
                wide = in(reg) 4 * COLUMNS,
                along = in(reg) 4 * words,
                a = inout(reg) a.add(row * words) => _,
                b = inout(reg) b => _,
                n = inout(reg) words / LANES => _,
                out("tmm0") _, out("tmm1") _, out("tmm2") _, out("tmm3") _,
                out("tmm4") _, out("tmm5") _, out("tmm6") _, out("tmm7") _,
                options(nostack),
            );
        }
    }
}
