//! Shared helpers of the system tests; the tests themselves are in `tests/tests`.
