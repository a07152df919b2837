//! What a call returns, and the message that goes with it.

use crate::abi::airlight_status;
use airlight::Error;
use core::ffi::{CStr, c_char};
use std::any::Any;
use std::cell::RefCell;
use std::ffi::CString;
use std::fmt::Display;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// Why a call was refused.
#[derive(Debug)]
pub(crate) struct Failure {
    status: airlight_status,
    message: String,
}

pub(crate) type Result<T> = core::result::Result<T, Failure>;

impl Failure {
    pub(crate) fn new(status: airlight_status, message: impl Into<String>) -> Self {
        Self { status, message: message.into() }
    }

    /// A number that is out of its range.
    pub(crate) fn value(field: impl Display, value: impl Display, expected: &str) -> Self {
        Self::new(airlight_status::Value, format!("{field} is {value}, expected {expected}"))
    }

    /// A pointer that must not be NULL.
    pub(crate) fn null(field: impl Display) -> Self {
        Self::new(airlight_status::Null, format!("{field} is NULL"))
    }

    /// The same of a field that is part of `owner`.
    pub(crate) fn of(self, owner: impl Display) -> Self {
        Self { message: format!("{owner}.{}", self.message), ..self }
    }
}

impl From<Error> for Failure {
    fn from(error: Error) -> Self {
        let status = match error {
            Error::Channels { .. } => airlight_status::Channels,
            Error::Empty { .. } => airlight_status::Empty,
            Error::Length { .. } => airlight_status::Length,
            Error::Unavailable { .. } => airlight_status::Unavailable,
            // Later kinds of errors have a message too.
            _ => airlight_status::Value,
        };
        Self::new(status, error.to_string())
    }
}

thread_local! {
    /// Why the last call of this thread that failed did so.
    static LAST: RefCell<CString> = RefCell::default();
}

/// Makes a call: nothing unwinds out of it, and why it fails is kept.
///
/// What a panic may leave half done is memory of the caller, who is told.
pub(crate) fn report(call: impl FnOnce() -> Result<()>) -> airlight_status {
    let failure = match catch_unwind(AssertUnwindSafe(call)) {
        Ok(Ok(())) => return airlight_status::Ok,
        Ok(Err(failure)) => failure,
        Err(payload) => Failure::new(airlight_status::Panic, text(&*payload)),
    };
    let message = CString::new(failure.message).unwrap_or_default();
    // A thread that is about to end keeps no message.
    let _ = LAST.try_with(|last| last.replace(message));
    failure.status
}

/// What a panic says.
fn text(payload: &(dyn Any + Send)) -> String {
    let text = payload.downcast_ref::<String>().map(String::as_str);
    text.or_else(|| payload.downcast_ref::<&str>().copied()).unwrap_or("a panic").to_owned()
}

/// The message, valid until the next one of this thread.
pub(crate) fn last_message() -> *const c_char {
    LAST.try_with(|last| last.borrow().as_ptr()).unwrap_or(c"".as_ptr())
}

/// A status in words.
pub(crate) fn describe(status: u32) -> &'static CStr {
    const TEXTS: [(airlight_status, &CStr); 11] = [
        (airlight_status::Ok, c"done"),
        (airlight_status::Null, c"a pointer is NULL that must not be"),
        (airlight_status::StructSize, c"the first field of a struct is not its size"),
        (airlight_status::Length, c"a column does not fit into memory"),
        (airlight_status::Stride, c"a stride is smaller than what it is to step over"),
        (airlight_status::Overlap, c"an output shares memory with another column"),
        (airlight_status::Empty, c"a table has no entry"),
        (airlight_status::Value, c"a number is out of its range"),
        (airlight_status::Unavailable, c"there is no such thing"),
        (airlight_status::Channels, c"media have other numbers of channels than each other, or than there are columns"),
        (airlight_status::Panic, c"a defect of airlight"),
    ];
    let found = TEXTS.iter().find(|(known, _)| *known as u32 == status);
    found.map_or(c"an unknown status", |(_, text)| text)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_is_a_status_with_its_message() {
        let panics: [fn() -> Result<()>; 2] = [|| panic!("of a kind"), || panic!("number {}", 2)];
        for (panics, message) in panics.into_iter().zip(["of a kind", "number 2"]) {
            assert_eq!(report(panics), airlight_status::Panic);
            // SAFETY: `last_message` returns a C string that lives until the next one.
            assert_eq!(unsafe { CStr::from_ptr(last_message()) }.to_str(), Ok(message));
        }
    }
}
