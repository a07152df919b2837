//! The floating-point environment that Rust assumes: rounding to nearest, nothing flushed to zero, nothing trapped.
//!
//! Rust code may not run in another one, not even to change it. So an entry of the ABI is a naked function, which keeps the
//! host's control register on the stack, sets the default one, calls, and restores. Entries take at most four arguments, all
//! of which every ABI of x86-64 and AArch64 passes in registers; so are their results, and neither is touched.

/// The body of an entry of the ABI: calls a function in the default environment.
///
/// MXCSR 0x1f80: all exceptions masked, rounding to nearest, neither FTZ nor DAZ. Below it on the stack is the room that
/// Windows' ABI asks for; with the return address the frame is a multiple of 16 bytes.
#[cfg(target_arch = "x86_64")]
macro_rules! in_default_environment {
    ($function:ident($($argument:ident),*)) => {
        core::arch::naked_asm!(
            "sub rsp, 56",
            "stmxcsr [rsp + 48]",
            "mov dword ptr [rsp + 52], 0x1f80",
            "ldmxcsr [rsp + 52]",
            "call {function}",
            "ldmxcsr [rsp + 48]",
            "add rsp, 56",
            "ret",
            function = sym $function,
        )
    };
}

/// The body of an entry of the ABI: calls a function in the default environment.
///
/// FPCR 0: rounding to nearest, neither FZ nor DN nor traps.
#[cfg(target_arch = "aarch64")]
macro_rules! in_default_environment {
    ($function:ident($($argument:ident),*)) => {
        core::arch::naked_asm!(
            "stp x29, x30, [sp, #-32]!",
            "mov x29, sp",
            "mrs x9, fpcr",
            "str x9, [sp, #16]",
            "msr fpcr, xzr",
            "bl {function}",
            "ldr x9, [sp, #16]",
            "msr fpcr, x9",
            "ldp x29, x30, [sp], #32",
            "ret",
            function = sym $function,
        )
    };
}

/// The body of an entry of the ABI: calls a function. Hosts have to be in the default environment themselves.
#[cfg(not(any(target_arch = "x86_64", target_arch = "aarch64")))]
macro_rules! in_default_environment {
    ($function:ident($($argument:ident),*)) => {
        // SAFETY: what the caller of the ABI promises.
        unsafe { $function($($argument),*) }
    };
}

pub(crate) use in_default_environment;
