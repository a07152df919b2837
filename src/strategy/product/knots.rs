//! Product densities by their number of knots, each in a module: the compiler makes one unit of machine code of a module,
//! and these are the largest.

pub(crate) mod three {
    use super::super::Product;
    use crate::density;
    use crate::simd::Isa;

    pub(crate) struct Kind;

    impl density::Kind for Kind {
        type On<I: Isa> = Product<I, 3>;
    }
}

pub(crate) mod five {
    use super::super::Product;
    use crate::density;
    use crate::simd::Isa;

    pub(crate) struct Kind;

    impl density::Kind for Kind {
        type On<I: Isa> = Product<I, 5>;
    }
}

pub(crate) mod nine {
    use super::super::Product;
    use crate::density;
    use crate::simd::Isa;

    pub(crate) struct Kind;

    impl density::Kind for Kind {
        type On<I: Isa> = Product<I, 9>;
    }
}

pub(crate) mod seventeen {
    use super::super::Product;
    use crate::density;
    use crate::simd::Isa;

    pub(crate) struct Kind;

    impl density::Kind for Kind {
        type On<I: Isa> = Product<I, 17>;
    }
}
