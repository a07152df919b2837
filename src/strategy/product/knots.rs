//! The product densities by number of knots, each in a module of its own: the compiler makes a unit of machine code of each
//! module, and these are the largest.

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
