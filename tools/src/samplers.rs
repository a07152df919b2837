//! All that there is to be measured.

use airlight::{Precision, Sampler, Strategy};

/// Every strategy in every precision that it has, on the widest backend of this machine.
pub fn all() -> impl Iterator<Item = Sampler> {
    let of = |&strategy| {
        let precise = move |&precision| Sampler::new(strategy).with_precision(precision).ok();
        Precision::ALL.iter().filter_map(precise)
    };
    Strategy::ALL.iter().flat_map(of)
}
