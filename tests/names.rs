//! Strategies, precisions and numbers of nodes are read as they are written; what is none of them is answered with all of them.

use airlight::{Nodes, Precision, Strategy};
use std::fmt::{Debug, Display};
use std::str::FromStr;

fn read_as_written<T>(all: &[T], none: &str, answer: &str)
where
    T: Copy + Debug + Display + PartialEq + FromStr<Err: Debug + Display>,
{
    for value in all {
        assert_eq!(value.to_string().parse::<T>().unwrap(), *value);
    }
    assert_eq!(none.parse::<T>().unwrap_err().to_string(), answer);
}

#[test]
fn strategies() {
    const ANSWER: &str = "no strategy is called 'product'; there are transmittance, equi-angular, point-normal, \
                          taylor-transmittance, taylor-phase, product-3, product-5, product-9, product-17";
    read_as_written(Strategy::ALL, "product", ANSWER);
}

#[test]
fn precisions() {
    read_as_written(Precision::ALL, "", "no precision is called ''; there are exact, fast");
}

#[test]
fn numbers_of_nodes() {
    read_as_written(Nodes::ALL, "five", "no integral has 'five' nodes; there are 4, 6, 8, 12");
}
