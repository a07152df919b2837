//! The structs that a call takes, read from wherever they lie.

use crate::abi::*;
use crate::status::{Failure, Result};
use airlight::{Backend, Counts, Integral, Nodes, Precision, Sampler, Strategy, Threads};
use core::ffi::CStr;

/// A struct whose first field is its size.
///
/// # Safety
/// It starts with a `usize` and any bits are a value of it.
pub(crate) unsafe trait Argument: Copy {
    const TYPE: &'static str;
}

macro_rules! arguments {
    ($($name:ident)*) => {$(
        // SAFETY: the first field is `struct_size`; all are numbers, pointers and arrays of both.
        unsafe impl Argument for $name {
            const TYPE: &'static str = stringify!($name);
        }

        impl Default for $name {
            /// Zeros, but for the size.
            fn default() -> Self {
                // SAFETY: any bits are a value of it.
                Self { struct_size: size_of::<Self>(), ..unsafe { core::mem::zeroed() } }
            }
        }
    )*};
}

arguments!(airlight_options airlight_emitters airlight_media airlight_batch airlight_samples airlight_values);
arguments!(airlight_choices airlight_counts airlight_scene airlight_one_sample);

/// `Ok` if the size that stands in a struct is its size.
///
/// # Safety
/// `pointer` is NULL or one to a `T`.
unsafe fn check_size<T: Argument>(field: &str, pointer: *const T) -> Result<()> {
    if pointer.is_null() {
        return Err(Failure::null(field));
    }
    // SAFETY: a `T` starts with its size.
    let size = unsafe { pointer.cast::<usize>().read_unaligned() };
    if size == size_of::<T>() {
        return Ok(());
    }
    let message = format!("{field}.struct_size is {size}, expected sizeof({}) = {}", T::TYPE, size_of::<T>());
    Err(Failure::new(airlight_status::StructSize, message))
}

/// A copy of a struct; `field` is what it is called.
///
/// # Safety
/// `pointer` is NULL or one to a `T`.
pub(crate) unsafe fn read<T: Argument>(field: &str, pointer: *const T) -> Result<T> {
    // SAFETY: as promised, and it is no smaller than a `T`.
    unsafe {
        check_size(field, pointer)?;
        Ok(pointer.read_unaligned())
    }
}

/// Where a result is written.
#[derive(Debug)]
pub(crate) struct Place<T>(*mut T);

impl<T: Argument> Place<T> {
    /// That of a result.
    ///
    /// # Safety
    /// `pointer` is NULL or one to a `T`, as long as the place is used.
    pub(crate) unsafe fn new(field: &str, pointer: *mut T) -> Result<Self> {
        // SAFETY: as promised.
        unsafe { check_size(field, pointer)? };
        Ok(Self(pointer))
    }

    /// Writes the result.
    pub(crate) fn write(self, result: T) {
        // SAFETY: it is one to a `T`, and there is no reference to that.
        unsafe { self.0.write_unaligned(result) };
    }
}

/// Where the counts of a call are written, if they are wanted.
#[derive(Debug)]
pub(crate) struct CountsPlace(Option<Place<airlight_counts>>);

impl CountsPlace {
    /// That of `counts`; NULL: they are not wanted.
    ///
    /// # Safety
    /// As [`Place::new`].
    pub(crate) unsafe fn new(counts: *mut airlight_counts) -> Result<Self> {
        // SAFETY: as promised.
        let place = (!counts.is_null()).then(|| unsafe { Place::new("counts", counts) });
        place.transpose().map(Self)
    }

    pub(crate) fn write(self, counts: Counts) {
        let Counts { sampled, empty, invalid, bisected, .. } = counts;
        let struct_size = size_of::<airlight_counts>();
        if let Some(place) = self.0 {
            place.write(airlight_counts { struct_size, sampled, empty, invalid, bisected });
        }
    }
}

/// The names of strategies, in the order of their numbers in [`airlight_strategy`] from 1 on.
pub(crate) const STRATEGIES: &[&CStr] = &[
    c"transmittance",
    c"equi-angular",
    c"point-normal",
    c"taylor-transmittance",
    c"taylor-phase",
    c"product-3",
    c"product-5",
    c"product-9",
    c"product-17",
];

/// The names of backends, in the order of their numbers in [`airlight_backend`] from 1 on.
pub(crate) const BACKENDS: &[&CStr] = &[c"portable", c"avx2", c"avx512"];

/// The strategy of a number of [`airlight_strategy`].
pub(crate) fn strategy(number: u32) -> Option<Strategy> {
    match number {
        0 => Some(Strategy::default()),
        number => STRATEGIES.get(number as usize - 1)?.to_str().ok()?.parse().ok(),
    }
}

/// The backend of a number of [`airlight_backend`], if this CPU has it.
pub(crate) fn backend(number: u32) -> Option<Backend> {
    match number {
        0 => Some(Backend::detect()),
        number => {
            let name = BACKENDS.get(number as usize - 1)?.to_bytes();
            Backend::available().find(|backend| backend.name().as_bytes() == name)
        }
    }
}

/// How a call is done.
pub(crate) struct Options {
    strategy: Strategy,
    precision: Precision,
    nodes: Nodes,
    backend: Backend,
    threads: Threads,
}

impl Options {
    /// Those of a struct, the default ones for NULL.
    ///
    /// # Safety
    /// As [`read`].
    pub(crate) unsafe fn read(options: *const airlight_options) -> Result<Self> {
        // SAFETY: as promised.
        let given = (!options.is_null()).then(|| unsafe { read("options", options) });
        let options = given.transpose()?.unwrap_or_default();
        let number = |field, number, expected| Failure::value(field, number, expected);
        Ok(Self {
            strategy: strategy(options.strategy)
                .ok_or_else(|| number("options.strategy", options.strategy, "an airlight_strategy"))?,
            precision: match options.precision {
                0 => Precision::Exact,
                1 => Precision::Fast,
                other => return Err(number("options.precision", other, "an airlight_precision")),
            },
            nodes: match options.nodes {
                0 => Nodes::default(),
                count => Nodes::ALL
                    .iter()
                    .copied()
                    .find(|nodes| nodes.count() == count as usize)
                    .ok_or_else(|| number("options.nodes", count, "0, 4, 6, 8 or 12"))?,
            },
            backend: match (options.backend, backend(options.backend)) {
                (_, Some(backend)) => backend,
                (known @ 1..=3, None) => {
                    let message = format!("options.backend is {known}, which this CPU does not have");
                    return Err(Failure::new(airlight_status::Unavailable, message));
                }
                (other, None) => return Err(number("options.backend", other, "an airlight_backend")),
            },
            threads: match options.threads {
                0 => Threads::Pool,
                threads => Threads::at_most(threads as usize),
            },
        })
    }

    pub(crate) fn threads(&self) -> Threads {
        self.threads
    }

    /// What samples so, on the calling thread.
    pub(crate) fn sampler(&self) -> Result<Sampler> {
        let sampler = Sampler::new(self.strategy).with_backend(self.backend).with_threads(Threads::Caller);
        Ok(sampler.with_precision(self.precision)?)
    }

    /// What integrates so, on the calling thread.
    pub(crate) fn integral(&self) -> Integral {
        let integral = Integral::new(self.nodes).with_precision(self.precision);
        integral.with_backend(self.backend).with_threads(Threads::Caller)
    }
}
