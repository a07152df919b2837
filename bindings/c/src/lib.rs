//! The C ABI of airlight: `include/airlight.h`, which is made from this crate, and `include/airlight.hpp` around it.
//!
//! | file | what it is |
//! |---|---|
//! | `entries` | the functions of the ABI |
//! | `abi` | its types |
//! | `environment` | the floating-point environment that they run in |
//! | `inside` | what runs there |
//! | `calls`, `one` | a call for a batch, and for one ray |
//! | `arguments`, `batch` | the structs that they take |
//! | `columns`, `span` | columns as they lie in memory, and as slices |
//! | `status` | what they return |
//!
//! # Safety
//!
//! Every pointer that a function takes, directly or in a struct, is NULL or one to what it is said to be, of any alignment,
//! and stays so until the function returns. No other thread writes there in the meantime, or reads what is written.

mod abi;
mod arguments;
mod batch;
mod calls;
mod columns;
mod entries;
mod environment;
mod inside;
mod one;
mod span;
mod status;

pub use abi::*;
pub use entries::*;
